// `needlework view`: still pictures of the needles of a file.
#pragma once

#include <string>
#include <vector>

#include "src/picture/needle_picture.h"

namespace needlework::cli {

struct ViewArguments {
  std::string from, to;
  std::string frame = "last";  ///< "first", "last", "all" or a number
  picture::NeedlePicture picture;
  std::string projection = "perspective";  ///< or "orthographic"
  std::string background = "dark";         ///< or "light"
  bool force = false;
};

/// Returns the exit code.
int run(const ViewArguments& arguments);

}  // namespace needlework::cli
