#include "src/cli/json.h"

#include <cmath>
#include <istream>
#include <nlohmann/json.hpp>

namespace needlework::cli {

using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json parse_json(std::istream& text) { return Json::parse(text); }

}  // namespace needlework::cli
