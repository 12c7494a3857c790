// The files of profiles/paper, which the build copies into the program.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace needlework::reproduce {

struct EmbeddedFile {
  std::string_view name;  ///< such as "profiles/paper/claims.toml"
  std::string_view text;
};

std::span<const EmbeddedFile> embedded_files();

/// The text of a file by its path, which may have parts "..". Throws IoError if there is none.
std::string embedded_text(const std::string& path);

}  // namespace needlework::reproduce
