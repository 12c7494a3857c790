#include "bench/strategies/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "needlework/error.h"
#include "src/cli/json.h"

namespace needlework::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr int format_version = 1;

double least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

Json json_of_case(const Results& results, const CaseResult& result) {
  return {{"name", result.name},
          {"scene", result.scene},
          {"baseline", result.is_baseline},
          {"needles", result.needles},
          {"density", result.density},
          {"search", result.search},
          {"queue", result.queue},
          {"isa", result.isa},
          {"effects", result.effects},
          {"best_us_per_collision", result.best()},
          {"median_us_per_collision", result.median()},
          {"times_baseline", results.baseline_of(result).best() / result.best()},
          {"collisions_per_cpu_s", 1e6 / result.best()},
          {"us_per_collision", result.us_per_collision},
          {"setup_s", result.setup_s},
          {"collisions", result.collisions},
          {"bytes_per_needle", result.bytes_per_needle},
          {"per_collision", result.per_collision},
          {"warm_up_hash", result.warm_up_hash}};
}

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

CaseResult case_from(const Json& json) {
  CaseResult out;
  json.at("name").get_to(out.name);
  json.at("scene").get_to(out.scene);
  json.at("baseline").get_to(out.is_baseline);
  json.at("needles").get_to(out.needles);
  json.at("density").get_to(out.density);
  json.at("search").get_to(out.search);
  json.at("queue").get_to(out.queue);
  json.at("isa").get_to(out.isa);
  json.at("effects").get_to(out.effects);
  json.at("us_per_collision").get_to(out.us_per_collision);
  json.at("setup_s").get_to(out.setup_s);
  json.at("collisions").get_to(out.collisions);
  json.at("bytes_per_needle").get_to(out.bytes_per_needle);
  out.per_collision = json.at("per_collision");
  json.at("warm_up_hash").get_to(out.warm_up_hash);
  const std::size_t repetitions = out.us_per_collision.size();
  require(repetitions > 0, "us_per_collision: expected at least one repetition");
  for (const double us : out.us_per_collision) {
    require(us > 0, "us_per_collision: expected numbers above 0");
  }
  require(out.setup_s.size() == repetitions && out.collisions.size() == repetitions &&
              out.bytes_per_needle.size() == repetitions,
          "setup_s, collisions, bytes_per_needle: expected as many as of us_per_collision");
  return out;
}

Results results_from(Json json) {
  Results out;
  require(json.at("format") == format_version, "format: expected 1");
  for (const Json& one : json.at("cases")) out.cases.push_back(case_from(one));
  json.erase("cases");
  out.about = std::move(json);
  for (const CaseResult& result : out.cases) {
    const std::size_t repetitions = result.us_per_collision.size();
    require(out.baseline_of(result).us_per_collision.size() == repetitions,
            "us_per_collision: expected as many repetitions of all cases of a scene");
  }
  return out;
}

double per_collision(const CaseResult& result, const char* name) {
  return result.per_collision.value(name, std::nan(""));
}

}  // namespace

std::string about_text(const Json& about, const char* key) {
  const auto value = about.find(key);
  if (value == about.end()) return "?";
  return value->is_string() ? value->get<std::string>() : cli::json_text(*value);
}

double CaseResult::best() const { return least(us_per_collision); }
double CaseResult::median() const { return bench::median(us_per_collision); }

double median(std::vector<double> values) {
  const std::size_t half = values.size() / 2;
  std::sort(values.begin(), values.end());
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

const CaseResult& Results::baseline_of(const CaseResult& result) const {
  for (const CaseResult& other : cases) {
    if (other.is_baseline && other.scene == result.scene) return other;
  }
  throw std::invalid_argument("scene " + result.scene + ": expected a baseline");
}

std::vector<double> relative_costs(const Results& results, const CaseResult& result) {
  const CaseResult& baseline = results.baseline_of(result);
  std::vector<double> out = result.us_per_collision;
  for (std::size_t n = 0; n < out.size(); ++n) out[n] /= baseline.us_per_collision[n];
  return out;
}

void add_sample(CaseResult& result, const Sample& sample) {
  if (result.us_per_collision.empty()) result.warm_up_hash = sample.warm_up_hash;
  if (sample.warm_up_hash != result.warm_up_hash) {
    throw InvalidStateError(
        fmt::format("{}: trajectory {}: expected {}, that of the repetition "
                    "before; this is a defect of the program",
                    result.name, sample.warm_up_hash, result.warm_up_hash));
  }
  const double collisions = static_cast<double>(sample.collisions);
  result.search = sample.search;
  result.queue = sample.queue;
  result.effects = sample.effects;
  result.us_per_collision.push_back(1e6 * sample.cpu_s / collisions);
  result.setup_s.push_back(sample.setup_s);
  result.collisions.push_back(sample.collisions);
  result.bytes_per_needle.push_back(static_cast<double>(sample.bytes) /
                                    static_cast<double>(result.needles));
  for (const CounterName& counter : counter_names) {
    result.per_collision[counter.name] =
        static_cast<double>(sample.counters.*counter.member) / collisions;
  }
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

Results read_results(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw IoError(file + ": cannot be read");
  try {
    return results_from(cli::parse_json(in));
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}: expected a file that needlework bench --json has written",
                                 file, error.what()));
  }
}

std::string table_of(const Results& results) {
  const Json& about = results.about;
  std::string out = fmt::format("{}: {}, {}, {}, {}; {} repetitions\n", about_text(about, "subset"),
                                about_text(about, "machine"), about_text(about, "compiler"),
                                about_text(about, "version"), about_text(about, "date"),
                                about_text(about, "repetitions"));
  std::size_t width = 0;
  for (const CaseResult& result : results.cases) width = std::max(width, result.name.size());
  out += fmt::format("{:{}} {:>31} {:>29} {:>41}\n", "", width, "us per collision", "collisions",
                     "per collision");
  out += fmt::format("{:{}} {:>9} {:>9} {:>11} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n",
                     "case", width, "best", "median", "x baseline", "per s", "events", "searches",
                     "candidat.", "evaluat.", "rebuilds", "B/needle", "setup s");
  for (const CaseResult& result : results.cases) {
    out += fmt::format(
        "{:{}} {:9.2f} {:9.2f} {:>11.2f} {:9.0f} {:9.2f} {:9.2f} {:9.1f} {:9.2f} {:9.2f} {:9.0f} "
        "{:9.3f}\n",
        result.name, width, result.best(), result.median(),
        results.baseline_of(result).best() / result.best(), 1e6 / result.best(),
        per_collision(result, "events"), per_collision(result, "searches"),
        per_collision(result, "candidates"), per_collision(result, "evaluated"),
        per_collision(result, "rebuilds"), median(result.bytes_per_needle), least(result.setup_s));
  }
  return out;
}

}  // namespace needlework::bench
