// Fuzz target: any lines are requests, and each is answered by a line of JSON.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "src/json/shallow_json.h"
#include "src/serve/server.h"
#include "tests/fuzz/target.h"

using namespace needlework;
using Json = nlohmann::json;

namespace {

// Whether a scene names no file and is small. Large ones differ in the time that they take alone.
bool is_tame_scene(const std::string& text) {
  static const std::regex not_tame("[0-9_]{4}|[0-9.][eE]|0[xob]|file|threads");
  return !std::regex_search(text, not_tame);
}

// The same for all values of a request.
bool is_tame(const Json& value) {
  if (value.is_number()) return value.get<double>() <= 1000;
  if (value.is_string()) {
    const auto& text = value.get_ref<const std::string&>();
    return text.find('/') == text.npos && (text.find('=') == text.npos || is_tame_scene(text));
  }
  // Others than arrays and objects are their own only element.
  return !value.is_structured() || std::all_of(value.begin(), value.end(), is_tame);
}

// The same for a line. One that cannot be read, or is too deep, is the server's to refuse.
bool is_tame_line(const std::string& line) {
  if (line.size() > 3000) return false;
  // A pair that turns for long may take a second.
  if (line.size() > 500 && line.find("predict") != line.npos) return false;
  try {
    return is_tame(json::parse_shallow<Json>(line));
  } catch (const std::runtime_error&) {
    return true;
  } catch (const Json::exception&) {
    return true;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bool entered = (std::filesystem::current_path(fuzz::folder()), true);
  static_cast<void>(entered);
  std::istringstream given{std::string(fuzz::text_of(data, size))};
  std::string requests;
  std::size_t lines = 0;
  for (std::string line; std::getline(given, line) && lines < 20;) {
    if (!is_tame_line(line)) continue;
    requests += line + "\n";
    ++lines;
  }
  std::istringstream in(requests);
  std::ostringstream out;
  serve::serve(in, out);
  std::istringstream answers(out.str());
  for (std::string line; std::getline(answers, line);) {
    const Json answer = Json::parse(line);
    fuzz::require(answer.is_object() && (answer.contains("ok") || answer.contains("progress")));
  }
  return 0;
}
