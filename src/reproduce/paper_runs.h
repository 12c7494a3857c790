// The runs that the figures of the paper are made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "needlework/scene.h"
#include "needlework/totals.h"
#include "src/io/recorded_field.h"
#include "src/runs/sweep_folder.h"
#include "src/runs/sweep_grid.h"
#include "src/runs/sweep_run.h"

namespace needlework::reproduce {

/// How much to compute: all, or what takes some minutes.
enum class Size { full, quick };

/// "full" or "quick", the folder of profiles/paper with the grids of this size.
std::string_view name_of(Size size);

/// A run that is complete. Refers to the PaperRuns that gave it.
struct FinishedRun {
  const Scene* scene = nullptr;
  std::uint64_t seed = 0;
  std::string file;
  std::vector<Totals> series;

  /// A field of an observable, see io::read_field.
  io::RecordedField field(const std::string& name) const { return io::read_field(file, name); }
};

/// Finished runs that differ in their seed only.
struct Point {
  const Scene* scene = nullptr;  ///< of the first seed
  std::vector<FinishedRun> runs;
};

/// Sets of runs by name, such as "dense". Each is the grid of a sweep,
/// profiles/paper/SIZE/NAME.toml, and has a folder FOLDER/runs/NAME, which is that of a sweep.
class PaperRuns {
 public:
  /// Where grids are read is a parameter for tests.
  PaperRuns(std::string folder, Size size, runs::sweep::ReadText read_text);

  /// Makes the folder, or checks that it is one of this size; with `force` another folder is used
  /// all the same. Throws InputError for a folder with something else in it, and IoError.
  void claim_folder(bool force);

  Size size() const { return size_; }
  const std::string& folder() const { return folder_; }

  /// Whether there is such a set in this size.
  bool has(const std::string& set) const;

  /// What run() has done with a set.
  struct Outcome {
    std::size_t members = 0;   ///< of the set
    std::size_t computed = 0;  ///< by this call
    int exit_code = 0;         ///< the greatest of its members
  };
  /// Runs the members that are missing, `threads` at a time. With `force` also those whose file is
  /// of another version or scene.
  Outcome run(const std::string& set, int threads, runs::SweepMonitor& monitor, bool force);

  /// The points of a set in the order of its grid, with those of their runs that are finished.
  std::vector<Point> points(const std::string& set) const;

 private:
  const runs::sweep::Grid& grid(const std::string& set) const;
  std::string folder_of(const std::string& set) const { return folder_ + "/runs/" + set; }

  std::string folder_;
  Size size_;
  runs::sweep::ReadText read_text_;
  mutable std::map<std::string, std::unique_ptr<runs::sweep::Grid>> grids_;
};

}  // namespace needlework::reproduce
