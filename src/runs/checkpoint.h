// Checkpoints of runs: all that a run needs to continue after its process has ended.
#pragma once

#include <cstdint>
#include <string>

#include "needlework/h5md.h"
#include "needlework/scene.h"
#include "needlework/simulation.h"
#include "needlework/totals.h"

namespace needlework::runs {

/// A run at one instant.
struct RunCheckpoint {
  Scene scene;                  ///< complete: engine chosen, count and box filled in
  bool drawn = false;           ///< whether the initial state was drawn
  Totals initial;               ///< at the start of the run
  Checkpoint simulation;        ///< the state of the gas
  io::Writer::Position output;  ///< the rows that the output file had
  std::string observation;      ///< what observables and schedules remember

  /// The file that it was read from, and its checksum.
  struct Origin {
    std::string path;
    std::uint64_t checksum = 0;
  };
  Origin origin;
};

/// The checkpoints of one output file, in files beside it: the newest, "FILE.checkpoint", and the
/// one before, "FILE.checkpoint.old". If the output file is a symbolic link, they are beside the
/// file that it leads to, so that they are found by either name. Each has a version and a checksum.
/// Whenever the process or the machine stops, one of the two is whole, once there has been one.
class CheckpointFiles {
 public:
  explicit CheckpointFiles(const std::string& output_file);

  const std::string& newest() const { return newest_; }
  const std::string& older() const { return older_; }
  /// Whether there is one.
  bool exist() const;

  /// Makes this one the newest. It is on the disk when this returns. Throws IoError, and keeps
  /// those before.
  void write(const RunCheckpoint& checkpoint);

  struct Read {
    RunCheckpoint checkpoint;
    std::string warning;  ///< why it is not the newest, or empty
  };
  /// The newest one that is whole. Throws InputError if there is none, or if it is of another
  /// version of the program; IoError if it cannot be read.
  Read read() const;

  /// Throws IoError if another program has written a newer one since this one was read.
  static void require_unchanged(const RunCheckpoint::Origin& origin);

  /// Removes them, if there are any. Throws IoError if that is not possible.
  void remove();

 private:
  std::string newest_, older_;
};

}  // namespace needlework::runs
