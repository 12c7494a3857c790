#include "src/cli/sweep_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/cli/file_kind.h"
#include "src/cli/json.h"
#include "src/cli/log_file.h"
#include "src/cli/messages.h"
#include "src/cli/progress.h"
#include "src/cli/ranks.h"
#include "src/cli/scene_arguments.h"
#include "src/cli/signals.h"
#include "src/cli/sweep_report.h"
#include "src/runs/engine_choice.h"
#include "src/runs/exit_codes.h"
#include "src/runs/resources.h"
#include "src/runs/sweep_folder.h"
#include "src/runs/sweep_grid.h"
#include "src/runs/sweep_run.h"
#include "src/runs/sweep_summary.h"
#include "src/scene/adopt_state.h"
#include "src/scene/check.h"
#include "src/scene/needed_memory.h"

namespace needlework::cli {
namespace {

using Json = nlohmann::ordered_json;
using State = runs::SweepFolder::State;
namespace sweep = runs::sweep;
using enum runs::ExitCode;

/// Part `k` of `m`, from 0.
struct Share {
  std::size_t k = 0, m = 1;
};

// Codes of members that this process has not run; less than all exit codes.
constexpr int unknown = -1;

std::optional<Share> parse_share(const std::string& text) {
  Share share;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, share.k);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != '/') return std::nullopt;
  const auto second = std::from_chars(first.ptr + 1, end, share.m);
  if (second.ec != std::errc() || second.ptr != end) return std::nullopt;
  if (share.k < 1 || share.k > share.m || share.m > sweep::most_members) return std::nullopt;
  --share.k;
  return share;
}

// Before any of them runs.
void choose_engines(sweep::Grid& grid, const std::optional<std::string>& isa) {
  for (sweep::Member& member : grid.members) {
    apply({.threads = {}, .isa = isa}, member.scene);
    runs::choose_engine(member.scene);
  }
}

// What initial.file says of its bodies. A file that cannot be read is a matter of its members.
Bodies bodies_of(const std::string& file) {
  try {
    return io::FrameFile(file).bodies();
  } catch (const IoError&) {
  } catch (const InputError&) {
  }
  return {};
}

// Each once, in the order of the members.
std::vector<std::string> all_warnings(const sweep::Grid& grid) {
  std::vector<std::string> all;
  const auto add = [&](std::string warning) {
    if (std::ranges::find(all, warning) == all.end()) all.push_back(std::move(warning));
  };
  std::map<std::string, Bodies> bodies;
  for (const sweep::Member& member : grid.members) {
    Scene scene = member.scene;
    scene.output.file = member.name;  // output does go somewhere
    for (std::string& warning : warnings(scene)) add(std::move(warning));
    const std::string& file = scene.initial.file;
    if (file.empty()) continue;
    if (!bodies.contains(file)) bodies[file] = bodies_of(file);
    if (std::string warning = warning_of_unknown_bodies(scene, bodies[file]); !warning.empty())
      add(std::move(warning));
  }
  return all;
}

void require_memory(const runs::MemberRuns& runs) {
  const double needed = runs::estimated_memory(runs);
  const double available = runs::available_memory();
  if (needed <= available) return;
  throw InputError(fmt::format(
      "--threads {}: expected fewer: so many members at a time need about {} of memory, and {} are "
      "available here",
      runs.threads, bytes_text(needed), bytes_text(available)));
}

/// One sweep, step by step; all steps are done on all ranks.
class Sweep {
 public:
  Sweep(const SweepArguments& arguments, Share share) : arguments_(arguments), share_(share) {}

  int run();

 private:
  void prepare();
  void begin_log();
  void warn(const std::string& message);
  void find_out_what_is_there();
  void run_what_is_missing();
  void look_at_those_of_others();
  void sum_up();
  void print(std::span<const sweep::PointSummary> summary);
  Json costs_of_members() const;
  std::vector<std::string> names_of(int code) const;

  const SweepArguments& arguments_;
  const Share share_;
  const Ranks ranks_;
  std::unique_ptr<LogFile> log_;  ///< if there is one
  sweep::Grid grid_;
  std::optional<runs::SweepFolder> folder_;
  std::vector<double> costs_;  ///< as estimated
  std::map<std::string, runs::MemberCost> member_costs_;
  std::vector<std::size_t> members_;  ///< of the share
  std::vector<int> codes_;            ///< of all members of the grid
  std::size_t computed_ = 0, missing_ = 0;
  int threads_ = 1;
};

int Sweep::run() {
  if (const int code = ranks_.do_everywhere([&] { prepare(); })) return code;
  if (const int code = ranks_.do_everywhere([&] { find_out_what_is_there(); })) return code;
  codes_ = ranks_.greatest(codes_);
  if (!arguments_.summary) {
    if (const int code = ranks_.do_everywhere([&] { run_what_is_missing(); })) return code;
    codes_ = ranks_.greatest(codes_);
    if (const int code = ranks_.do_everywhere([&] { look_at_those_of_others(); })) return code;
  }
  const int code = ranks_.do_everywhere([&] {
    if (ranks_.rank() == 0) sum_up();
  });
  int result = code;
  for (const std::size_t member : members_) result = std::max(result, codes_[member]);
  if (log_ && ranks_.rank() == 0) {
    log_->write("end", {{"exit_code", result}, {"computed", computed_}, {"missing", missing_}});
  }
  return result;
}

void Sweep::begin_log() {
  if (!arguments_.log) return;
  log_ = std::make_unique<LogFile>(*arguments_.log, "--log " + *arguments_.log);
  if (ranks_.rank() > 0) return;
  log_->write("start", {{"command", "sweep"},
                        {"version", NEEDLEWORK_VERSION},
                        {"grid", arguments_.grid},
                        {"pid", getpid()},
                        {"members", members_.size()},
                        {"threads", threads_},
                        {"ranks", ranks_.count()}});
}

void Sweep::warn(const std::string& message) {
  if (ranks_.rank() > 0) return;
  print_warning(message);
  if (log_) log_->write("warning", {{"message", message}});
}

void Sweep::prepare() {
  grid_ =
      read_file(arguments_.grid, FileKind::grid, [&] { return sweep::read_grid(arguments_.grid); });
  choose_engines(grid_, arguments_.isa);
  const std::string out = arguments_.out.value_or(grid_.out);
  if (out.empty()) {
    throw InputError(arguments_.grid + ": out is missing: expected a folder, or --out DIR");
  }
  const std::string place = arguments_.out ? "--out " + out : arguments_.grid + ": out = " + out;
  if (arguments_.summary && !std::filesystem::is_directory(out)) {
    throw InputError(place + ": expected the folder of a sweep, to sum up: it does not exist");
  }
  folder_.emplace(out, grid_, arguments_.force, place);
  costs_ = runs::estimated_costs(grid_);
  std::vector<std::size_t> all(grid_.members.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  members_ = runs::share_of(all, costs_, share_.k, share_.m);
  threads_ = arguments_.threads.value_or(runs::threads_on_offer());
  begin_log();
  for (const std::string& warning : all_warnings(grid_)) warn(warning);
  if (const std::string warning = folder_->warning(); !warning.empty()) warn(warning);
  if (arguments_.threads && threads_ > runs::cores()) {
    warn(fmt::format("--threads {}: expected at most {}, the number of cores here", threads_,
                     runs::cores()));
  }
}

void Sweep::find_out_what_is_there() {
  codes_.assign(grid_.members.size(), unknown);
  for (const std::size_t member : members_) {
    const State state = folder_->state(grid_.members[member]);
    if (state == State::finished) codes_[member] = ok;
    if (state == State::failed) codes_[member] = invalid_state;
  }
}

void Sweep::run_what_is_missing() {
  std::vector<std::size_t> missing;
  for (const std::size_t member : members_) {
    if (codes_[member] == unknown) missing.push_back(member);
    if (codes_[member] == invalid_state && ranks_.rank() == 0) {
      print_error(fmt::format("member {}: failed before (remove {} to try again)",
                              grid_.members[member].name,
                              folder_->failed_file(grid_.members[member])));
    }
  }
  computed_ = missing.size();
  const auto mine = runs::share_of(missing, costs_, ranks_.rank(), ranks_.count());
  const runs::MemberRuns runs{
      .grid = grid_, .folder = *folder_, .members = mine, .costs = costs_, .threads = threads_};
  require_memory(runs);
  SweepProgress progress(arguments_.quiet || ranks_.rank() > 0, arguments_.progress_every);
  constexpr double never = std::numeric_limits<double>::infinity();
  if (log_) {
    const double every = arguments_.progress_every.value_or(log_interval);
    progress.log_to(*log_, ranks_.rank() == 0 ? every : never);
  }
  const SignalGuard guard;
  runs::run_members(runs, progress, codes_);
  member_costs_ = progress.costs();
}

// Members that another process was running may be complete by now.
void Sweep::look_at_those_of_others() {
  for (const std::size_t member : members_) {
    if (codes_[member] != stopped) continue;
    const State state = folder_->state(grid_.members[member]);
    if (state == State::finished) codes_[member] = ok;
    if (state == State::failed) codes_[member] = invalid_state;
  }
}

// The files alone count, as other processes may have made some of them.
void Sweep::sum_up() {
  for (const sweep::Member& member : grid_.members) {
    missing_ += folder_->state(member) == State::missing;
  }
  if (arguments_.summary && missing_ == grid_.members.size()) {
    throw InputError(arguments_.grid + ": expected members to sum up: none is finished");
  }
  std::vector<sweep::PointSummary> summary;
  if (missing_ == 0 || arguments_.summary) {
    summary = sweep::summarise(
        grid_, [&](const sweep::Member& member) { return folder_->finished_run(member); });
    sweep::write_summary(folder_->summary_file(), grid_, summary);
  }
  print(summary);
}

void Sweep::print(std::span<const sweep::PointSummary> summary) {
  const std::size_t stops = names_of(stopped).size();
  if (stops > 0) {
    print_error(
        fmt::format("{} of {} members are not finished, stopped by a signal or in the hands of "
                    "another process: the same command continues with them",
                    stops, members_.size()));
  } else if (arguments_.summary && missing_ > 0) {
    print_warning(fmt::format("{} of {} members are missing", missing_, grid_.members.size()));
  }
  if (arguments_.json) {
    Json json{{"grid", arguments_.grid},
              {"members", grid_.members.size()},
              {"share", members_.size()},
              {"computed", computed_},
              {"missing", missing_},
              {"failed", names_of(invalid_state)},
              {"threads", threads_},
              {"ranks", ranks_.count()},
              {"total_s", runs::seconds_since_launch()},
              {"version", NEEDLEWORK_VERSION},
              {"file", summary.empty() ? Json(nullptr) : Json(folder_->summary_file())},
              {"costs", costs_of_members()},
              {"points", json_of(grid_, summary)}};
    fmt::print("{}\n", json_text(json, 2));
  } else if (arguments_.csv) {
    if (!summary.empty()) fmt::print("{}", csv_of(grid_, summary));
  } else if (!arguments_.quiet && !summary.empty()) {
    fmt::print("{}", table_of(grid_, summary));
  }
}

// Of those that were run here, in the order of the grid.
Json Sweep::costs_of_members() const {
  Json out = Json::array();
  for (const sweep::Member& member : grid_.members) {
    const auto cost = member_costs_.find(member.name);
    if (cost == member_costs_.end()) continue;
    Json one{{"member", member.name}};
    one.update(json_of(cost->second));
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<std::string> Sweep::names_of(int code) const {
  std::vector<std::string> names;
  for (std::size_t member = 0; member < codes_.size(); ++member) {
    if (codes_[member] == code) names.push_back(grid_.members[member].name);
  }
  return names;
}

}  // namespace

int run(const SweepArguments& arguments) {
  const auto share = arguments.member ? parse_share(*arguments.member) : Share();
  if (!share) {
    print_error(
        fmt::format("--member {}: expected K/M, part K of M, such as 1/16 (see needlework "
                    "--help)",
                    *arguments.member));
    return bad_usage;
  }
  return Sweep(arguments, *share).run();
}

}  // namespace needlework::cli
