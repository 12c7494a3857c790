#include "src/cli/bench_command.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <ctime>
#include <fstream>
#include <memory>
#include <optional>

#include "bench/strategies/cases.h"
#include "bench/strategies/compare.h"
#include "bench/strategies/results.h"
#include "needlework/error.h"
#include "src/cli/messages.h"
#include "src/cli/number_in.h"
#include "src/cli/version.h"
#include "src/runs/exit_codes.h"
#include "src/runs/output_path.h"
#include "src/runs/resources.h"

namespace needlework::cli {
namespace {

using Json = nlohmann::ordered_json;

struct BenchArguments {
  std::string subset = bench::subsets().front().name;
  bool list = false, json = false, quiet = false, force = false;
  std::string json_file, compare, results;
  int repetitions = 5;
  double min_time = 0.25;
};

/// Which case is being measured: one line on a terminal, drawn again and again; elsewhere a line
/// every 10 s.
class CaseProgress {
 public:
  explicit CaseProgress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO)) {}
  ~CaseProgress() { clear(); }

  void show(int repetition, int repetitions, const std::string& name) {
    if (quiet_ || (!terminal_ && seconds_since_launch() < next_)) return;
    next_ = seconds_since_launch() + 10;
    clear();
    const std::string line = fmt::format("repetition {} of {}: {}", repetition, repetitions, name);
    fmt::print(stderr, "{}{}", line, terminal_ ? "" : "\n");
    drawn_ = terminal_ ? line.size() : 0;
  }

 private:
  void clear() {
    if (drawn_) fmt::print(stderr, "\r{:{}}\r", "", drawn_);
    drawn_ = 0;
  }

  bool quiet_, terminal_;
  double next_ = 10;
  std::size_t drawn_ = 0;
};

Json about(const BenchArguments& arguments) {
  return {{"subset", arguments.subset},
          {"machine", processor_name()},
          {"cores", sysconf(_SC_NPROCESSORS_ONLN)},
          {"compiler", compiler_name()},
          {"flags", NEEDLEWORK_FLAGS},
          {"version", NEEDLEWORK_VERSION},
          {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
          {"repetitions", arguments.repetitions},
          {"min_time_s", arguments.min_time},
          {"warm_up_collisions_per_needle", bench::warm_up}};
}

// Strategies differ, trajectories do not: else what is fast may be wrong.
void require_same_trajectories(const bench::Results& results) {
  for (const bench::CaseResult& result : results.cases) {
    const std::string& expected = results.baseline_of(result).warm_up_hash;
    if (result.warm_up_hash != expected) {
      throw InvalidStateError(
          fmt::format("{}: trajectory {}: expected {}, that of the baseline; this is a defect of "
                      "the program",
                      result.name, result.warm_up_hash, expected));
    }
  }
}

bench::Results nothing_measured(const BenchArguments& arguments) {
  bench::Results out;
  out.about = about(arguments);
  for (const bench::Case& one : bench::subset_of(arguments.subset).cases()) {
    out.cases.push_back(bench::empty_result(one));
  }
  return out;
}

void measure(const BenchArguments& arguments, bench::Results& out) {
  const std::vector<bench::Case> cases = bench::subset_of(arguments.subset).cases();
  CaseProgress progress(arguments.quiet);
  for (int repetition = 1; repetition <= arguments.repetitions; ++repetition) {
    for (std::size_t n = 0; n < cases.size(); ++n) {
      progress.show(repetition, arguments.repetitions, out.cases[n].name);
      add_sample(out.cases[n], bench::measure(cases[n], arguments.min_time));
    }
    require_same_trajectories(out);
  }
}

void require_json_file(const BenchArguments& arguments) {
  if (arguments.json_file.empty()) return;
  const std::string place = "--json " + arguments.json_file;
  if (!arguments.json_file.ends_with(".json")) {
    throw InputError(place + ": expected a name that ends in .json");
  }
  require_writable(arguments.json_file, arguments.force, place);
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

int run(const BenchArguments& arguments) {
  if (arguments.list) return list_subsets();
  const bool measures = arguments.results.empty();
  bench::Results results =
      measures ? nothing_measured(arguments) : bench::read_results(arguments.results);
  require_json_file(arguments);
  std::optional<bench::Results> before;
  if (!arguments.compare.empty()) {
    before = bench::read_results(arguments.compare);
    // Before what may take an hour.
    bench::require_common_case(*before, results);
    for (const std::string& what : bench::unlike(*before, results)) print_warning(what);
  }
  if (measures) measure(arguments, results);
  std::optional<bench::Comparison> comparison;
  if (before) comparison = bench::compare(*before, results);
  if (!arguments.json_file.empty()) write_file(arguments.json_file, compact_text(results));
  if (arguments.json && arguments.json_file.empty()) {
    Json json = json_of(results);
    if (comparison) json["comparison"] = comparison->json;
    fmt::print("{}\n", json.dump(1, ' '));
  } else {
    fmt::print("{}", table_of(results));
    if (comparison) fmt::print("\n{}", comparison->text);
  }
  return comparison && comparison->differs ? differences_found : ok;
}

std::string subset_help() {
  std::string out = "what to measure: ";
  for (const bench::Subset& subset : bench::subsets()) {
    out += fmt::format("{}{} ({})", &subset == &bench::subsets().front() ? "" : "; ", subset.name,
                       subset.what);
  }
  return out;
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* command = app.add_subcommand(
      "bench",
      "measure scenes by several searches, queues and instruction sets, against the "
      "classical method as baseline");
  command->add_option("SUBSET", arguments->subset, subset_help())->option_text("[quick]");
  command->add_flag("--list", arguments->list, "list all subsets and their cases, measure nothing");
  command->add_option("--repetitions", arguments->repetitions, "of all cases in turn")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--min-time", arguments->min_time,
                   "least CPU time of a case in each repetition [s]")
      ->check(number_in(0, 3600))
      ->capture_default_str();
  command
      ->add_option(
          "--json", arguments->json_file,
          "print all that was measured as one JSON object; or print the table, and write to "
          "a file what --compare and --results need")
      ->expected(0, 1)
      ->option_text("[FILE.json]");
  command
      ->add_option("--compare", arguments->compare,
                   "older results that --json has written to a file, to be compared with")
      ->option_text("OLD.json");
  command
      ->add_option("--results", arguments->results,
                   "take the results from a file that --json has written instead of measuring")
      ->option_text("FILE.json");
  command->add_flag("--quiet", arguments->quiet, "no progress");
  command->add_flag("--force", arguments->force, "replace an existing file");
  command->footer(std::string("Verdicts of --compare. ") + bench::rule_of_verdicts +
                  " Exit code 1: a case became faster or slower.");
  command->callback([arguments, command, &exit_code] {
    arguments->json = command->count("--json") > 0;
    exit_code = run(*arguments);
  });
}

}  // namespace needlework::cli
