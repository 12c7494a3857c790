#include "src/cli/json.h"

#include <cmath>
#include <istream>
#include <nlohmann/json.hpp>

#include "src/json/shallow_json.h"

namespace needlework::cli {

using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json parse_json(std::istream& text) { return json::parse_shallow<Json>(text); }

}  // namespace needlework::cli
