#include "src/reproduce/paper_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/atomic_file.h"
#include "src/runs/engine_choice.h"
#include "src/runs/exit_codes.h"

namespace needlework::reproduce {
namespace {

namespace fs = std::filesystem;
namespace sweep = runs::sweep;

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

std::string_view name_of(Size size) { return size == Size::full ? "full" : "quick"; }

PaperRuns::PaperRuns(std::string folder, Size size, sweep::ReadText read_text)
    : folder_(std::move(folder)), size_(size), read_text_(std::move(read_text)) {}

void PaperRuns::claim_folder(bool force) {
  const fs::path marker = fs::path(folder_) / "reproduction.toml";
  const std::string record =
      fmt::format("# Made by needlework reproduce.\nsize = \"{}\"\n", name_of(size_));
  std::error_code error;
  if (fs::exists(marker, error)) {
    if (contents(marker) == record) return;
    if (!force) {
      throw InputError(fmt::format(
          "--out {}: holds another reproduction than the {} one ({}): expected another folder, or "
          "--force",
          folder_, name_of(size_), marker.string()));
    }
  } else if (fs::is_directory(folder_, error) && !fs::is_empty(folder_, error) && !force) {
    throw InputError(fmt::format(
        "--out {}: expected a new folder, one of needlework reproduce, or --force: it has other "
        "files in it",
        folder_));
  }
  fs::create_directories(folder_, error);
  if (!fs::is_directory(folder_)) {
    throw IoError(fmt::format("--out {}: cannot be made: {}", folder_,
                              error ? error.message() : std::string("expected a folder")));
  }
  io::AtomicFile file(marker.string(), true);
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream << record;
  stream.close();
  if (!stream) throw IoError(marker.string() + ": cannot be written");
  file.publish();
}

bool PaperRuns::has(const std::string& set) const {
  try {
    grid(set);
    return true;
  } catch (const IoError&) {
    return false;
  }
}

const sweep::Grid& PaperRuns::grid(const std::string& set) const {
  auto& known = grids_[set];
  if (!known) {
    known = std::make_unique<sweep::Grid>(sweep::read_grid(
        fmt::format("profiles/paper/{}/{}.toml", name_of(size_), set), read_text_));
    for (sweep::Member& member : known->members) runs::choose_engine(member.scene);
  }
  return *known;
}

PaperRuns::Outcome PaperRuns::run(const std::string& set, int threads, runs::SweepMonitor& monitor,
                                  bool force) {
  const sweep::Grid& grid = this->grid(set);
  const runs::SweepFolder folder(folder_of(set), grid, force, "--out " + folder_);
  std::vector<int> codes(grid.members.size(), runs::ok);
  std::vector<std::size_t> all, missing;
  for (std::size_t n = 0; n < grid.members.size(); ++n) {
    all.push_back(n);
    if (folder.state(grid.members[n]) != runs::SweepFolder::State::finished) missing.push_back(n);
  }
  const std::vector<double> costs = runs::estimated_costs(grid);
  runs::run_members({.grid = grid,
                     .folder = folder,
                     .members = runs::share_of(missing, costs, 0, 1),
                     .costs = costs,
                     .threads = threads},
                    monitor, codes);
  return {grid.members.size(), missing.size(), *std::max_element(codes.begin(), codes.end())};
}

std::vector<Point> PaperRuns::points(const std::string& set) const {
  const sweep::Grid& grid = this->grid(set);
  std::vector<Point> points(grid.points());
  for (const sweep::Member& member : grid.members) {
    Point& point = points[member.point];
    if (!point.scene) point.scene = &member.scene;
    const std::string file = folder_of(set) + "/" + member.name + ".h5";
    if (!fs::exists(file)) continue;
    point.runs.push_back({.scene = &member.scene,
                          .seed = member.seed,
                          .file = file,
                          .series = io::read_run(file).series});
  }
  return points;
}

}  // namespace needlework::reproduce
