#include "src/cli/reproduce_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "src/cli/messages.h"
#include "src/cli/progress.h"
#include "src/cli/signals.h"
#include "src/cli/standard_streams.h"
#include "src/reproduce/claims.h"
#include "src/reproduce/embedded_files.h"
#include "src/reproduce/reproduction.h"
#include "src/runs/engine_choice.h"
#include "src/runs/exit_codes.h"

namespace needlework::cli {
namespace {

using enum runs::ExitCode;
using reproduce::Figure;
using reproduce::PaperRuns;
using reproduce::Row;
using reproduce::Size;

bool has_all_sets(const Figure& figure, const PaperRuns& runs) {
  return std::all_of(figure.sets.begin(), figure.sets.end(),
                     [&](const std::string& set) { return runs.has(set); });
}

// Those asked for. Without the sets of a figure in this size, `all` leaves it out.
std::vector<const Figure*> chosen_figures(const ReproduceArguments& arguments,
                                          const PaperRuns& runs) {
  std::vector<const Figure*> chosen;
  for (const Figure& figure : reproduce::figures()) {
    if (arguments.figure != "all" && arguments.figure != figure.name) continue;
    if (has_all_sets(figure, runs)) {
      chosen.push_back(&figure);
    } else if (arguments.figure == "all") {
      if (!arguments.quiet) {
        print_warning(
            fmt::format("{}: is left out, as its runs belong to the full set only", figure.name));
      }
    } else {
      print_error(fmt::format(
          "{} --quick: expected no --quick: its runs belong to the full set only", figure.name));
    }
  }
  return chosen;
}

std::string command_of(const ReproduceArguments& arguments, const std::string& folder) {
  return fmt::format("needlework reproduce {}{} --out {}", arguments.figure,
                     arguments.quick ? " --quick" : "", folder);
}

// Runs what is missing of all sets, one after the other. Returns the greatest exit code.
int run_sets(const ReproduceArguments& arguments, std::span<const Figure* const> chosen,
             PaperRuns& runs) {
  std::vector<std::string> sets;
  for (const Figure* figure : chosen) {
    for (const std::string& set : figure->sets) {
      if (std::find(sets.begin(), sets.end(), set) == sets.end()) sets.push_back(set);
    }
  }
  const SignalGuard guard;
  int code = ok;
  for (const std::string& set : sets) {
    SweepProgress progress(arguments.quiet);
    if (!arguments.quiet) write_stderr(fmt::format("runs of {}\n", set));
    const auto outcome = runs.run(set, arguments.threads.value_or(runs::threads_on_offer()),
                                  progress, arguments.force);
    code = std::max(code, outcome.exit_code);
    if (SignalGuard::received()) return stopped;
  }
  return code;
}

std::string number_text(const std::optional<double>& number) {
  return number ? fmt::format("{:.6g}", *number) : "-";
}

void print_rows(std::span<const Row> rows) {
  std::size_t width = 5;
  for (const Row& row : rows) width = std::max(width, row.id().size());
  fmt::print("{:8}  {:>10}  {:>12}  {:>9}  {:>5}  {}\n", "verdict", "paper", "measured", "error",
             "seeds", "claim");
  for (const Row& row : rows) {
    fmt::print("{:8}  {:>10}  {:>12.6g}  {:>9.1e}  {:>5}  {}\n", reproduce::name_of(row.verdict),
               number_text(row.claim.paper.number), row.measured.value, row.measured.error,
               row.measured.seeds ? fmt::to_string(*row.measured.seeds) : "-", row.id());
  }
}

}  // namespace

std::vector<std::string> names_of_figures() {
  std::vector<std::string> names{"all"};
  for (const Figure& figure : reproduce::figures()) names.push_back(figure.name);
  return names;
}

int run(const ReproduceArguments& arguments) {
  const Size size = arguments.quick ? Size::quick : Size::full;
  const std::string folder =
      arguments.out.value_or(arguments.quick ? "reproduction-quick" : "reproduction");
  PaperRuns runs(folder, size, reproduce::embedded_text);
  const auto chosen = chosen_figures(arguments, runs);
  if (chosen.empty()) return bad_usage;
  const auto claims = reproduce::read_claims(reproduce::embedded_text("profiles/paper/claims.toml"),
                                             "profiles/paper/claims.toml");
  runs.claim_folder(arguments.force);

  const int code = run_sets(arguments, chosen, runs);
  if (code == stopped) {
    print_error(fmt::format("stopped; what is finished is kept, and {} continues",
                            command_of(arguments, folder)));
  }
  if (code != ok) return code;

  std::vector<Row> rows;
  for (const Figure* figure : chosen) {
    const auto more = reproduce::reproduce(*figure, runs, claims);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  const std::string json = reproduce::json_of(rows, size);
  reproduce::write_text(fmt::format("{}/claims-{}.json", folder, arguments.figure), json);
  if (arguments.json) {
    fmt::print("{}", json);
  } else if (!arguments.quiet) {
    print_rows(rows);
    fmt::print("pictures, data and claims-{}.json are in {}\n", arguments.figure, folder);
  }
  return ok;
}

}  // namespace needlework::cli
