// JSON as the program prints and reads it. Writing and parsing are compiled once, in json.cpp.
#pragma once

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace needlework::cli {

/// JSON has no NaN and no infinity; both become null.
nlohmann::ordered_json number(double x);

/// `indent`: spaces for each level, or -1 for one line. Bytes that are not UTF-8 are replaced.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

/// Throws nlohmann::json::exception for what is not JSON.
nlohmann::ordered_json parse_json(std::istream& text);

}  // namespace needlework::cli
