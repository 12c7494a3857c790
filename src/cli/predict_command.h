// `needlework predict`: the first contact of each pair in a file.
#pragma once

#include <string>

#include "needlework/scene.h"

namespace needlework::cli {

struct PredictArguments {
  std::string path;
  Scene::Engine engine;  ///< of which only what sets the accuracy is used
  bool json = false;
};

/// Answers go to stdout. Returns the exit code. Throws InputError for a line, level or pair that
/// cannot be used, IoError for a file that cannot be read; then nothing is printed.
int run(const PredictArguments& arguments);

}  // namespace needlework::cli
