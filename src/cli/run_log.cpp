#include "src/cli/run_log.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "needlework/error.h"
#include "src/cli/json.h"
#include "src/cli/report.h"
#include "src/runs/checksum.h"

namespace needlework::cli {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json or_null(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

bool are_same_file(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  // Absolute first: of a relative name that does not exist, weakly_canonical() makes no other.
  std::error_code error;
  const auto first = fs::weakly_canonical(fs::absolute(a), error);
  const auto second = fs::weakly_canonical(fs::absolute(b), error);
  return !error && first == second;
}

double energy_ratio(const Totals& now, const Totals& initial) {
  return now.energy / initial.energy;
}

}  // namespace

RunLog::RunLog(const std::string& path, const std::string& output_file) {
  const std::string place = "--log " + path;
  if (!output_file.empty() && are_same_file(path, output_file)) {
    throw IoError(place + ": is the output file: expected another one");
  }
  file_ = std::make_unique<LogFile>(path, place);
}

void RunLog::start(const std::optional<std::string>& scene, const runs::PreparedRun& run) {
  if (!file_) return;
  const Scene& its_scene = run.scene();
  const Simulation& simulation = run.simulation();
  const Scene::Until& until = its_scene.until;
  file_->write("start",
               {{"command", scene ? "run" : "resume"},
                {"version", NEEDLEWORK_VERSION},
                {"scene", or_null(scene.value_or(""))},
                {"scene_checksum", fmt::format("{:016x}", runs::checksum_of(its_scene.text))},
                {"file", or_null(its_scene.output.file)},
                {"host", host_name()},
                {"pid", getpid()},
                {"needles", simulation.needles()},
                {"threads", its_scene.engine.threads.value_or(1)},
                {"isa", simulation.isa()},
                {"search", simulation.search()},
                {"queue", simulation.queue()},
                {"until",
                 {{"time", or_null(until.time)},
                  {"collisions_per_needle", or_null(until.collisions_per_needle)},
                  {"energy_ratio", or_null(until.energy_ratio)},
                  {"wall_s", or_null(until.wall_s)}}},
                {"time", simulation.time()},
                {"collisions", simulation.collisions()}});
}

void RunLog::warning(const std::string& message) {
  if (file_) file_->write("warning", {{"message", message}});
}

void RunLog::progress(const runs::Progress& progress) {
  if (!file_) return;
  file_->write("progress", {{"elapsed_s", progress.elapsed},
                            {"fraction", number(progress.fraction)},
                            {"left_s", number(progress.left)},
                            {"time", progress.now.time},
                            {"collisions", progress.now.collisions},
                            {"collisions_per_s", number(progress.rate)},
                            {"energy", number(progress.now.energy)},
                            {"energy_ratio", number(energy_ratio(progress.now, progress.initial))},
                            {"energy_drift", number(progress.energy_drift)},
                            {"momentum_drift", number(progress.momentum_drift)},
                            {"checkpoint_age_s", or_null(progress.since_checkpoint)}});
}

void RunLog::checkpoint(double time, std::uint64_t collisions, double seconds) {
  if (!file_) return;
  file_->write("checkpoint", {{"time", time}, {"collisions", collisions}, {"took_s", seconds}});
}

void RunLog::end(const runs::PreparedRun& run, const runs::RunResult& result, int exit_code,
                 const std::string& message) {
  if (!file_) return;
  file_->write("end", {{"reason", stop_name(result)},
                       {"exit_code", exit_code},
                       {"message", or_null(message)},
                       {"bundle", or_null(result.bundle)},
                       {"time", result.last.time},
                       {"collisions", result.last.collisions},
                       {"energy", number(result.last.energy)},
                       {"energy_ratio", number(energy_ratio(result.last, result.initial))},
                       {"trajectory_hash", run.simulation().trajectory_hash()},
                       {"wall_s", result.loop.wall()}});
}

void RunLog::end(const runs::Failure& failure) {
  if (!file_) return;
  const int code = failure.exit_code;
  file_->write("end", {{"reason", "error"}, {"exit_code", code}, {"message", failure.message}});
}

void LoggedRun::show(const runs::Progress& progress) {
  if (shown_.is_due(progress.elapsed)) shown_.show(progress);
  if (progress.elapsed < next_) return;
  next_ = progress.elapsed + every_;
  log_.progress(progress);
}

void LoggedRun::saved(double time, std::uint64_t collisions, double seconds) {
  shown_.saved(time, collisions, seconds);
  log_.checkpoint(time, collisions, seconds);
}

}  // namespace needlework::cli
