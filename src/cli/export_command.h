// `needlework export`: frames in the formats of other programs.
#pragma once

#include <string>
#include <vector>

namespace needlework::cli {

struct ExportArguments {
  std::string from, to;
  std::string format;  ///< name of a format; empty: by the ending of `to`
  std::string frame;   ///< "first", "last", "all" or a number; empty: as much as the format holds
  bool force = false;
};

/// The words for `format`.
std::vector<std::string> names_of_export_formats();

/// Returns the exit code.
int run(const ExportArguments& arguments);

}  // namespace needlework::cli
