// Where a sweep keeps its results: one H5MD file a member, and the summary.
#pragma once

#include <optional>
#include <string>

#include "needlework/h5md.h"
#include "src/runs/sweep_grid.h"

namespace needlework::runs {

/// NAME.h5 is a member that is finished, NAME.failed.h5 one that cannot be, up to where it failed.
/// Both come by renaming NAME.h5.part, so that they are whole, and count only if they were made of
/// the same scene by the same version. NAME.lock is there while a member is being run. grid.toml
/// says of which grid the folder is. Safe for use by several threads and several processes.
class SweepFolder {
 public:
  /// Makes the folder if there is none. `place` is where it was named. Throws IoError if it cannot
  /// be written, and InputError if it is of another grid; with `force` it becomes that of this one,
  /// in which those members count that are in both.
  SweepFolder(std::string path, const sweep::Grid& grid, bool force, const std::string& place);

  enum class State { missing, finished, failed };
  /// Throws InputError, but not with `force`, for a file of that name that is something else.
  State state(const sweep::Member& member) const;

  /// A member that is finished.
  std::optional<io::RecordedRun> finished_run(const sweep::Member& member) const;

  /// That other processes which run the same members cannot be noticed; empty if they can.
  std::string warning() const;

  std::string unfinished_file(const sweep::Member& member) const;
  std::string failed_file(const sweep::Member& member) const;
  std::string lock_file(const sweep::Member& member) const;
  std::string summary_file() const { return path_ + "/summary.h5"; }

  /// Gives the unfinished file its final name.
  void keep(const sweep::Member& member, State as) const;
  void remove_unfinished(const sweep::Member& member) const;

 private:
  std::optional<io::RecordedRun> matching_run(const std::string& file, const sweep::Member& member,
                                              bool with_series) const;

  std::string path_;
  bool force_;
};

/// The right to run a member, which one thread of one process can have at a time.
class Claim {
 public:
  Claim(const SweepFolder& folder, const sweep::Member& member);
  ~Claim();
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

  bool granted() const { return descriptor_ >= 0; }

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace needlework::runs
