#include "bench/strategies/results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string_view>

#include "needlework/error.h"
#include "src/cli/csv.h"
#include "src/cli/json.h"

namespace needlework::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr int format_version = 2;
constexpr const char* expected_file =
    "expected a file that needlework bench --json FILE has written";

void require(bool holds, const std::string& what) {
  if (!holds) throw InputError(what);
}

// Five digits are more precise than repetitions are, and short in a file.
double five_digits(double x) { return std::stod(fmt::format("{:.5g}", x)); }

// Three digits, in at most four characters up to 9999.
std::string three_digits(double x) {
  const int decimals = x < 9.995 ? 2 : x < 99.95 ? 1 : 0;
  return fmt::format("{:.{}f}", x, decimals);
}

// The parts of a case's name, those that are numbers as numbers.
Json json_of_parts(const std::string& name) {
  const NameParts parts = parts_of(name);
  Json out = Json::object();
  for (const NameParts::Named& each : NameParts::all) {
    const std::string& text = parts.*each.part;
    const bool may_be_number =
        each.part != &NameParts::scene && text.find_first_not_of("0123456789.e+-") == text.npos;
    const Json number = may_be_number ? Json::parse(text, nullptr, false) : Json();
    out[each.name] = text.empty() ? Json(nullptr) : number.is_number() ? number : Json(text);
  }
  return out;
}

Json json_of_case(const Results& results, const CaseResult& result) {
  const Speedup factor = speedup(results, result);
  Json out = {{"name", result.name}};
  out.update(json_of_parts(result.name));
  out.update({{"baseline", result.is_baseline},
              {"us_per_collision", result.us_per_collision},
              {"best_us_per_collision", result.least()},
              {"median_us_per_collision", result.median()},
              {"speedup", factor.median},
              {"speedup_low", cli::number(factor.low)},
              {"speedup_high", cli::number(factor.high)}});
  out.update(result.details);
  return out;
}

CaseResult case_from(const Json& json) {
  CaseResult out;
  json.at("name").get_to(out.name);
  json.at("baseline").get_to(out.is_baseline);
  json.at("us_per_collision").get_to(out.us_per_collision);
  for (const char* key : {"search", "queue"}) {
    if (json.contains(key)) out.details[key] = json.at(key).get<std::string>();
  }
  const std::string place = out.name + ": us_per_collision";
  require(!out.us_per_collision.empty(), place + " is empty: expected at least one repetition");
  for (const double us : out.us_per_collision) {
    require(us > 0, fmt::format("{} {}: expected a number above 0", place, us));
  }
  return out;
}

Results results_from(Json json) {
  Results out;
  const Json& format = json.at("format");
  require(format == format_version,
          fmt::format("format {}: expected {}; measure again by needlework bench --json FILE",
                      format.dump(), format_version));
  for (const Json& one : json.at("cases")) out.cases.push_back(case_from(one));
  require(!out.cases.empty(), "cases is empty: expected at least one");
  for (const char* key : {"format", "cases", "comparison"}) json.erase(key);
  out.about = std::move(json);
  for (const CaseResult& result : out.cases) {
    const std::size_t count = result.us_per_collision.size();
    const std::size_t expected = out.baseline_of(result).us_per_collision.size();
    require(count == expected, fmt::format("{}: us_per_collision has {} repetitions: expected {}, "
                                           "as many as the baseline of its scene",
                                           result.name, count, expected));
  }
  return out;
}

}  // namespace

std::string about_text(const Json& about, const char* key) {
  const auto value = about.find(key);
  if (value == about.end()) return "?";
  return value->is_string() ? value->get<std::string>() : cli::json_text(*value);
}

std::string CaseResult::scene() const { return name.substr(0, name.find('/')); }
double CaseResult::least() const { return *std::ranges::min_element(us_per_collision); }
double CaseResult::most() const { return *std::ranges::max_element(us_per_collision); }
double CaseResult::median() const { return bench::median(us_per_collision); }

Speedup speedup(const Results& results, const CaseResult& result) {
  std::vector<double> costs = relative_costs(results, result);
  Speedup out{1 / median(costs), std::nan(""), std::nan("")};
  std::sort(costs.begin(), costs.end());
  // The greatest n such that not more than n values are below the median in 2.5 % of all cases.
  const std::size_t count = costs.size();
  const double of_all = std::pow(0.5, static_cast<double>(count));
  double binomial = 1, share = of_all;
  for (std::size_t n = 0; share <= 0.025 && 2 * n < count; ++n) {
    out.high = 1 / costs[n];
    out.low = 1 / costs[count - 1 - n];
    binomial *= static_cast<double>(count - n) / static_cast<double>(n + 1);
    share += of_all * binomial;
  }
  return out;
}

bool by_wall_clock(const Results& results) { return results.about.value("clock", "cpu") == "wall"; }

double median(std::vector<double> values) {
  const std::size_t half = values.size() / 2;
  std::sort(values.begin(), values.end());
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

const CaseResult& Results::baseline_of(const CaseResult& result) const {
  for (const CaseResult& other : cases) {
    if (other.is_baseline && other.scene() == result.scene()) return other;
  }
  throw InputError("scene " + result.scene() + ": expected a baseline among the cases");
}

std::vector<double> relative_costs(const Results& results, const CaseResult& result) {
  const CaseResult& baseline = results.baseline_of(result);
  std::vector<double> out = result.us_per_collision;
  for (std::size_t n = 0; n < out.size(); ++n) out[n] /= baseline.us_per_collision[n];
  return out;
}

CaseResult empty_result(const Case& one) {
  const Scene::Needles& needles = one.scene.needles;
  const double volume = needles.box[0] * needles.box[1] * needles.box[2];
  CaseResult out;
  out.name = one.name();
  out.is_baseline = one.is_baseline;
  out.details = {{"needles", needles.count},
                 {"density", static_cast<double>(needles.count) / volume},
                 {"setup_s", Json::array()},
                 {"collisions", Json::array()},
                 {"bytes_per_needle", Json::array()}};
  return out;
}

void add_sample(CaseResult& result, const Sample& sample, bool by_wall_clock) {
  if (result.us_per_collision.empty()) result.warm_up_hash = sample.warm_up_hash;
  if (sample.warm_up_hash != result.warm_up_hash) {
    throw InvalidStateError(
        fmt::format("{}: trajectory {}: expected {}, that of the repetition "
                    "before; this is a defect of the program",
                    result.name, sample.warm_up_hash, result.warm_up_hash));
  }
  const double collisions = static_cast<double>(sample.collisions);
  const double seconds = by_wall_clock ? sample.wall_s : sample.cpu_s;
  result.us_per_collision.push_back(five_digits(1e6 * seconds / collisions));
  Json& details = result.details;
  details["search"] = sample.search;
  details["queue"] = sample.calendar;
  details["effects"] = sample.effects;
  details["setup_s"].push_back(sample.setup_s);
  details["collisions"].push_back(sample.collisions);
  details["bytes_per_needle"].push_back(static_cast<double>(sample.bytes) /
                                        details["needles"].get<double>());
  for (const Counters::Named& counter : counters_shown) {
    details["per_collision"][counter.name] =
        static_cast<double>(sample.counters.*counter.value) / collisions;
  }
  details["warm_up_hash"] = sample.warm_up_hash;
}

Json json_of(const Results& results) {
  Json out = {{"format", format_version}};
  out.update(results.about);
  out["cases"] = Json::array();
  for (const CaseResult& result : results.cases) {
    out["cases"].push_back(json_of_case(results, result));
  }
  return out;
}

std::string csv_of(const Results& results) {
  // Names of scenes are those of files, and may hold anything.
  const auto text_of = [&](const Json& object, const char* key) {
    const auto value = object.find(key);
    if (value == object.end() || value->is_null()) return std::string();
    return value->is_string() ? cli::quoted(value->get<std::string>()) : value->dump();
  };
  std::vector<const char*> keys;
  for (const NameParts::Named& each : NameParts::all) keys.push_back(each.name);
  for (const char* key :
       {"search", "queue", "needles", "density", "baseline", "median_us_per_collision",
        "best_us_per_collision", "worst_us_per_collision", "speedup", "speedup_low", "speedup_high",
        "repetitions", "clock"}) {
    keys.push_back(key);
  }
  std::string out = fmt::format("{}\n", fmt::join(keys, ","));
  for (const CaseResult& result : results.cases) {
    Json row = json_of_case(results, result);
    row["worst_us_per_collision"] = result.most();
    row["repetitions"] = result.us_per_collision.size();
    row["clock"] = by_wall_clock(results) ? "wall" : "cpu";
    std::string line;
    for (const char* key : keys) line += (line.empty() ? "" : ",") + text_of(row, key);
    out += line + "\n";
  }
  return out;
}

std::string compact_text(const Results& results) {
  std::string out = fmt::format("{{\n \"format\": {},\n", format_version);
  for (const auto& [key, value] : results.about.items()) {
    out += fmt::format(" {}: {},\n", Json(key).dump(), value.dump());
  }
  out += " \"cases\": [";
  std::string_view separator = "\n";
  for (const CaseResult& result : results.cases) {
    Json line = {{"name", result.name}};
    line.update(json_of_parts(result.name));
    for (const char* key : {"search", "queue"}) {
      if (result.details.contains(key)) line[key] = result.details[key];
    }
    line["baseline"] = result.is_baseline;
    line["us_per_collision"] = result.us_per_collision;
    std::vector<std::string> fields;
    for (const auto& [key, value] : line.items()) {
      fields.push_back(fmt::format("\"{}\": {}", key, value.dump()));
    }
    out += fmt::format("{}  {{{}}}", separator, fmt::join(fields, ", "));
    separator = ",\n";
  }
  return out + "\n ]\n}\n";
}

Results read_results(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw IoError(file + ": cannot be read");
  try {
    return results_from(cli::parse_json(in));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}: {}", file, error.what(), expected_file));
  }
}

std::string table_of(const Results& results) {
  const Json& about = results.about;
  const std::size_t repetitions = results.cases.front().us_per_collision.size();
  std::string out = fmt::format("{}, version {}, {}\n{}; {}\n", about_text(about, "subset"),
                                about_text(about, "version"), about_text(about, "date"),
                                about_text(about, "machine"), about_text(about, "compiler"));
  out +=
      fmt::format("{} time of the event loop: {}\n", by_wall_clock(results) ? "Wall" : "CPU",
                  repetitions == 1
                      ? std::string("one repetition")
                      : fmt::format("median and range of {} interleaved repetitions", repetitions));
  std::size_t width = 0;
  for (const CaseResult& result : results.cases) width = std::max(width, result.name.size());
  // Where it fits, and there are enough repetitions.
  constexpr std::size_t columns = 100, of_numbers = 39;
  const bool with_interval =
      width + of_numbers <= columns && !std::isnan(speedup(results, results.cases.front()).low);
  out += fmt::format("\n{:{}} {:>17}\n{:{}} {:>6} {:>10} {:>8}{}\n", "", width, "us per collision",
                     "case", width, "median", "range", "speed-up",
                     with_interval ? fmt::format(" {:>11}", "95 %") : "");
  for (const CaseResult& result : results.cases) {
    const Speedup factor = speedup(results, result);
    const std::string range =
        fmt::format("{}-{}", three_digits(result.least()), three_digits(result.most()));
    out += fmt::format("{:{}} {:>6} {:>10} {:>8}", result.name, width,
                       three_digits(result.median()), range, three_digits(factor.median));
    if (with_interval) {
      out += fmt::format(" {:>11}",
                         fmt::format("{}-{}", three_digits(factor.low), three_digits(factor.high)));
    }
    out += '\n';
  }
  return out;
}

}  // namespace needlework::bench
