// Checkpoints of runs: all that a run needs to continue after its process has ended.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "needlework/scene.h"
#include "needlework/simulation.h"
#include "needlework/totals.h"
#include "needlework/user_data.h"

namespace needlework::runs {

/// How a run failed, so that a failure that comes again can be told from another one.
struct RunFailure {
  std::string message;
  InvalidStateError::Needles needles;  ///< those that it is about
  double time = 0;                     ///< of the last event before it
  std::uint64_t collisions = 0;        ///< since the start of the run
  std::string trajectory_hash;         ///< of these collisions
  std::string version;                 ///< of the program

  friend bool operator==(const RunFailure&, const RunFailure&) = default;
};

/// A run at one instant.
struct RunCheckpoint {
  Scene scene = {};                  ///< complete: engine chosen, count and box filled in
  bool drawn = false;                ///< whether the initial state was drawn
  Totals initial = {};               ///< at the start of the run
  Checkpoint simulation = {};        ///< the state of the gas; without bytes: that of the scene
  io::Writer::Position output = {};  ///< the rows that the output file had
  std::string observation = {};      ///< what observables and schedules remember
  std::optional<double> velocities_set = {};  ///< when a caller first replaced all velocities
  UserDataByName data = {};                   ///< the user's own
  std::optional<RunFailure> failure = {};  ///< of a bundle: how the run failed after this instant

  /// The file that it was read from, and its checksum.
  struct Origin {
    std::string path = {};
    std::uint64_t checksum = 0;
    bool instead_of_newest = false;  ///< it is the one before, as the newest cannot be read
  };
  Origin origin = {};
};

/// The checkpoints of one output file, in files beside it: the newest, "FILE.checkpoint", and the
/// one before, "FILE.checkpoint.old". If the output file is a symbolic link, they are beside the
/// file that it leads to, so that they are found by either name. Each has a version and a checksum.
/// Whenever the process or the machine stops, one of the two is whole, once there has been one. A
/// run that fails leaves a third one there, the bundle "FILE.failure", from which its failure can
/// be shown again.
class CheckpointFiles {
 public:
  explicit CheckpointFiles(const std::string& output_file);

  const std::string& newest() const { return newest_; }
  const std::string& older() const { return older_; }
  const std::string& bundle() const { return bundle_; }
  /// Whether there is one to continue from, as far as can be told.
  bool exist() const;
  /// Throws IoError if none could be written here.
  void require_writable() const;

  /// What becomes of the newest one when there is a newer one.
  enum class Newest { becomes_older, is_replaced };
  /// Makes this one the newest. It is on the disk when this returns. Throws IoError, and keeps
  /// those before.
  void write(const RunCheckpoint& checkpoint, Newest present = Newest::becomes_older);

  /// Writes the bundle, in the same way.
  void write_bundle(const RunCheckpoint& checkpoint);
  /// Moves the bundle, if there is one, beside the new name of the output file.
  void move_bundle(const std::string& output_file) const;

  struct Latest {
    RunCheckpoint checkpoint;
    std::string warning;  ///< why it is not the newest, or empty
  };
  /// The newest one that is whole and can be read. If there is none, throws IoError if one cannot
  /// be read, and InputError if they are missing, damaged or of another major or minor version.
  Latest latest() const;
  /// The checkpoint or bundle in a file of any name. Throws as latest() does.
  static RunCheckpoint read(const std::string& path);

  /// Throws IoError if another program has written a newer one since this one was read.
  static void require_unchanged(const RunCheckpoint::Origin& origin);

  /// Removes them, if there are any. Throws IoError if that is not possible.
  void remove();

 private:
  std::string newest_, older_, bundle_;
};

}  // namespace needlework::runs
