#include "src/report/bench_section.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "needlework/error.h"
#include "src/io/formats/input_text.h"
#include "src/json/shallow_json.h"

namespace needlework::report {

using Json = nlohmann::ordered_json;

namespace {

// Results are some hundred kilobytes; a parsed number takes about ten times its text.
constexpr std::size_t most_bytes = std::size_t{1} << 26;

constexpr std::array units = {"us_per_collision", "ns_per_item"};

void require(bool holds, const std::string& what) {
  if (!holds) throw InputError(what);
}

const char* unit_of(const Json& one, const std::string& name) {
  for (const char* unit : units) {
    if (one.contains(unit)) return unit;
  }
  throw InputError(fmt::format("{}: expected {} or {}", name, units[0], units[1]));
}

Json case_of(const Json& one, const char* unit) {
  const std::string name = one.at("name").get<std::string>();
  const std::string place = fmt::format("{}: {}", name, unit);
  require(one.contains(unit), place + " is missing: expected it, as in the case before");
  const Json& values = one.at(unit);
  require(values.is_array() && !values.empty(), place + ": expected a number of each repetition");
  for (const Json& value : values) {
    require(value.is_number() && value.get<double>() > 0,
            fmt::format("{} {}: expected a number above 0", place, value.dump()));
  }
  return {{"name", name}, {"baseline", one.value("baseline", false)}, {"values", values}};
}

Json about_of(const Json& results) {
  Json about = Json::object();
  for (const auto& [key, value] : results.items()) {
    if (!value.is_structured()) about[key] = value;
  }
  return about;
}

Json families_of(const Json& results) {
  Json out = Json::array();
  for (const auto& [name, family] : results.at("families").items()) {
    Json one = {{"name", name}};
    for (const char* count :
         {"pairs", "contacts", "missed", "spurious", "near", "near_missed", "near_spurious"}) {
      one[count] = family.at(count).get<std::uint64_t>();
    }
    one["worst_time_error"] = family.at("worst_time_error").get<double>();
    out.push_back(std::move(one));
  }
  return out;
}

Json section_of(const Json& results) {
  require(results.is_object() && (results.contains("cases") || results.contains("families")),
          "expected results in JSON: `cases`, as needlework bench --json FILE writes them, or "
          "`families`");
  Json out = {{"kind", "bench"}, {"about", about_of(results)}};
  if (results.contains("families")) {
    out["families"] = families_of(results);
    return out;
  }
  const Json& cases = results.at("cases");
  require(cases.is_array() && !cases.empty(), "`cases` is empty: expected at least one");
  const char* unit = unit_of(cases.front(), cases.front().at("name").get<std::string>());
  out["unit"] = unit;
  out["cases"] = Json::array();
  for (const Json& one : cases) out["cases"].push_back(case_of(one, unit));
  return out;
}

}  // namespace

Json bench_section(const std::string& path) {
  try {
    Json out = section_of(json::parse_shallow<Json>(io::read_text_file(path, most_bytes)));
    out["file"] = path;
    return out;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  } catch (const Json::exception& error) {
    throw InputError(
        fmt::format("{}: {}: expected results in JSON that needlework bench --json "
                    "FILE has written",
                    path, error.what()));
  }
}

}  // namespace needlework::report
