#include <filesystem>

#include "needlework/error.h"
#include "src/reproduce/embedded_files.h"

namespace needlework::reproduce {

std::string embedded_text(const std::string& path) {
  const std::string name = std::filesystem::path(path).lexically_normal().generic_string();
  for (const EmbeddedFile& file : embedded_files()) {
    if (file.name == name) return std::string(file.text);
  }
  throw IoError(path + ": is not in the program");
}

}  // namespace needlework::reproduce
