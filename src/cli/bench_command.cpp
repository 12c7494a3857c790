#include "src/cli/bench_command.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "bench/strategies/cases.h"
#include "bench/strategies/compare.h"
#include "bench/strategies/results.h"
#include "needlework/error.h"
#include "src/cli/json.h"
#include "src/cli/messages.h"
#include "src/cli/standard_streams.h"
#include "src/cli/version.h"
#include "src/runs/exit_codes.h"
#include "src/runs/output_path.h"
#include "src/runs/resources.h"

namespace needlework::cli {

using enum runs::ExitCode;
namespace {

using Json = nlohmann::ordered_json;

/// Which case is being measured: one line on a terminal, drawn again and again; elsewhere a line
/// every 10 s.
class CaseProgress {
 public:
  explicit CaseProgress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO)) {}
  ~CaseProgress() { clear(); }

  void show(int repetition, int repetitions, const std::string& name) {
    if (quiet_ || (!terminal_ && runs::seconds_since_launch() < next_)) return;
    next_ = runs::seconds_since_launch() + 10;
    clear();
    const std::string line = fmt::format("repetition {} of {}: {}", repetition, repetitions, name);
    write_stderr(line + (terminal_ ? "" : "\n"));
    drawn_ = terminal_ ? line.size() : 0;
  }

 private:
  void clear() {
    if (drawn_) write_stderr(fmt::format("\r{:{}}\r", "", drawn_));
    drawn_ = 0;
  }

  bool quiet_, terminal_;
  double next_ = 10;
  std::size_t drawn_ = 0;
};

Json about(const BenchArguments& arguments) {
  return {{"subset", arguments.own.file.empty() ? arguments.subset : arguments.own.file},
          {"machine", runs::processor_name()},
          {"cores", sysconf(_SC_NPROCESSORS_ONLN)},
          {"compiler", compiler_name()},
          {"flags", NEEDLEWORK_FLAGS},
          {"version", NEEDLEWORK_VERSION},
          {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
          {"repetitions", arguments.repetitions},
          {"min_time_s", arguments.min_time},
          {"warm_up_collisions_per_needle", bench::warm_up}};
}

// Strategies differ, trajectories do not: else what is fast may be wrong. Those of levels of
// accuracy may, and those of other settings do.
void require_same_trajectories(const bench::Results& results) {
  using Scene = std::array<std::string, 3>;
  std::map<Scene, const bench::CaseResult*> firsts;
  for (const bench::CaseResult& result : results.cases) {
    const bench::NameParts parts = bench::parts_of(result.name);
    const bench::CaseResult& first =
        *firsts.try_emplace({parts.scene, parts.accuracy, parts.setting}, &result).first->second;
    if (result.warm_up_hash != first.warm_up_hash) {
      throw InvalidStateError(
          fmt::format("{}: trajectory {}: expected {}, that of {}; this is a defect of the program",
                      result.name, result.warm_up_hash, first.warm_up_hash, first.name));
    }
  }
}

std::vector<bench::Case> cases_of(const BenchArguments& arguments) {
  if (arguments.own.file.empty()) return bench::subset_of(arguments.subset).cases();
  bench::OwnCases own = bench::cases_of(arguments.own);
  for (const std::string& name : own.left_out) {
    print_warning(name + ": left out, as its search or calendar is for one thread");
  }
  return std::move(own.cases);
}

bench::Results nothing_measured(const BenchArguments& arguments,
                                const std::vector<bench::Case>& cases) {
  bench::Results out;
  out.about = about(arguments);
  const bool several = std::any_of(cases.begin(), cases.end(), [](const bench::Case& one) {
    return one.scene.engine.threads.value_or(1) > 1;
  });
  // What several threads are for; the CPU time of all of them together never gets less.
  if (several) out.about["clock"] = "wall";
  for (const bench::Case& one : cases) out.cases.push_back(bench::empty_result(one));
  return out;
}

void measure(const BenchArguments& arguments, const std::vector<bench::Case>& cases,
             bench::Results& out) {
  CaseProgress progress(arguments.quiet);
  for (int repetition = 1; repetition <= arguments.repetitions; ++repetition) {
    for (std::size_t n = 0; n < cases.size(); ++n) {
      progress.show(repetition, arguments.repetitions, out.cases[n].name);
      add_sample(out.cases[n], bench::measure(cases[n], arguments.min_time),
                 bench::by_wall_clock(out));
    }
    require_same_trajectories(out);
  }
}

// The file that an option names, in which results are to be put.
void require_file(const BenchArguments& arguments, const std::string& option,
                  const std::string& file, const std::string& ending) {
  if (file.empty()) return;
  const std::string place = option + " " + file;
  if (!file.ends_with(ending)) {
    throw InputError(place + ": expected a name that ends in " + ending);
  }
  runs::require_writable(file, arguments.force, place);
  for (const std::string& read : {arguments.compare, arguments.results, arguments.own.file}) {
    if (!read.empty()) runs::require_other_file(file, read, place);
  }
}

void write_file(const std::string& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw IoError(file + ": cannot be written");
}

int list_subsets() {
  for (const bench::Subset& subset : bench::subsets()) {
    fmt::print("{:10} {}\n", subset.name, subset.what);
    for (const bench::Case& one : subset.cases()) {
      fmt::print("{:10}   {}{}\n", "", one.name(), one.is_baseline ? "  (baseline)" : "");
    }
  }
  return ok;
}

}  // namespace

int run(const BenchArguments& arguments) {
  if (arguments.list) return list_subsets();
  const bool measures = arguments.results.empty();
  const std::vector<bench::Case> cases =
      measures ? cases_of(arguments) : std::vector<bench::Case>();
  bench::Results results =
      measures ? nothing_measured(arguments, cases) : bench::read_results(arguments.results);
  require_file(arguments, "--json", arguments.json_file, ".json");
  require_file(arguments, "--csv", arguments.csv_file, ".csv");
  std::optional<bench::Results> before;
  if (!arguments.compare.empty()) {
    before = bench::read_results(arguments.compare);
    // Before what may take an hour.
    bench::require_common_case(*before, results);
    for (const std::string& what : bench::unlike(*before, results)) print_warning(what);
  }
  if (measures) measure(arguments, cases, results);
  std::optional<bench::Comparison> comparison;
  if (before) comparison = bench::compare(*before, results);
  if (!arguments.json_file.empty()) write_file(arguments.json_file, compact_text(results));
  if (!arguments.csv_file.empty()) write_file(arguments.csv_file, csv_of(results));
  if (arguments.json && arguments.json_file.empty()) {
    Json json = json_of(results);
    if (comparison) json["comparison"] = comparison->json;
    fmt::print("{}\n", json_text(json, 1));
  } else {
    fmt::print("{}", table_of(results));
    if (comparison) fmt::print("\n{}", comparison->text);
  }
  return comparison && comparison->differs ? differences_found : ok;
}

std::string names_of_subsets() {
  std::string out;
  for (const bench::Subset& subset : bench::subsets()) {
    out += (out.empty() ? "" : "|") + subset.name;
  }
  return out;
}

std::string help_on_verdicts() {
  return std::string("Verdicts of --compare. ") + bench::rule_of_verdicts +
         " Exit code 1: a case became faster or slower.";
}

}  // namespace needlework::cli
