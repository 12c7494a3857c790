// H5MD 1.1 files: trajectories, sums and collisions out; initial states in.
//
// What a Writer leaves in a file, F frames, S samples, E collisions, N needles:
//
//   /h5md                 version [1, 1], author, creator
//   /particles/needles    box (edges [F][3][3]), position, velocity, image, orientation and
//                         angular_velocity, each [F][N][3]; id [N], mass [N]
//   /observables          t_tr, t_rot, energy, momentum [F][3], collisions, tc_collisions, each [F]
//   /series               the same sums, each [S], and their step and time
//   /events               time, epoch, offset, normal_velocity, tc, each [E]; pair (ids), arms,
//   each
//                         [E][2]; shift, impulse, each [E][3]; see Collision
//   /parameters           scene, title, version, seed, isa, threads, epoch_length, k, epsilon, beta
//
// What depends on time is an H5MD element: a group with value, step (collisions so far) and time.
// All elements of frames share one step and one time, those of the series another. /observables is
// on the grid of the frames because readers of H5MD, MDAnalysis among them, index it by the frame;
// the finer series are kept apart from it. Everything is in the units of the scene, so there are no
// unit attributes.
//
// HDF5 is entered by one thread at a time: the functions here wait for each other, but not for
// other code of the process that uses HDF5.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "needlework/collision.h"
#include "needlework/scene.h"
#include "needlework/state.h"
#include "needlework/totals.h"

namespace needlework::io {

/// What a file says about its run besides the scene.
struct RunInfo {
  std::string isa;                    ///< name of the instruction set in use, never "auto"
  int threads = 1;                    ///< threads in use
  double epoch_length = 0;            ///< of the epochs in /events [time]
  std::string accuracy = "standard";  ///< level in use, with those knobs that are set
};

/// Writes one run to one file. All that was written before the last flush() survives the death of
/// the program at any moment, kill -9 and full disks included; power failures are the file system's
/// business. The file opens in HDF5 1.10 and later like any other, be it closed, left behind or
/// still being written; in the latter two, only rows that have a step count.
///
/// All members throw IoError, "PATH: reason" in one line, when the file cannot be written, and
/// again when used after that; std::logic_error when used wrongly.
class Writer {
 public:
  /// Creates the file: under a temporary name in the same folder, and under its own when a valid
  /// header is in it. An existing file is replaced if `force`, else IoError; a directory or a
  /// device never. scene.needles.count must be the number of needles of all frames, also when the
  /// scene takes its initial state from a file; /events exists if scene.output.events.
  Writer(const std::string& path, bool force, const Scene& scene, const RunInfo& run);
  Writer(Writer&&) noexcept;
  Writer& operator=(Writer&&) noexcept;
  ~Writer();

  /// Appends a sample to each element of /series.
  void write_series(const Totals& totals);
  /// Appends a frame to /particles/needles, and the totals at its time to /observables. A state
  /// without images has none in the file but zeros. The ids of all frames must be the same, in the
  /// same order.
  void write_frame(const Totals& totals, const State& state);
  /// Appends to /events; written in blocks of a few thousand.
  void write_event(const Collision& collision);
  /// Brings to the file what was written so far.
  void flush();
  /// Flushes, closes and reports errors. The destructor does the same but is silent.
  void close();

 private:
  struct Implementation;
  template <class Action>
  void use(Action action);

  std::unique_ptr<Implementation> implementation_;
};

/// Reads the last frame of any H5MD file that has position, velocity, orientation and
/// angular_velocity in /particles/needles, or in the only group under /particles, whatever its
/// name.
///
/// Each may be an H5MD element of [F][N][3] or a plain dataset [N][3], of any kind of number. Box
/// edges may be [3], [3][3] (a diagonal matrix), [F][3] or [F][3][3], plain or an element; id and
/// image plain, an element, or none; mass is not needed. Elements with steps of their own are read
/// at the last step that all have. Centres may lie on or outside the edges of the box. Numbers are
/// taken as they are, without any normalisation: |u| = 1 and u·w = 0 must hold within 1e-6 (of
/// |w|).
///
/// Throws IoError if the file cannot be read or is cut short, and InputError for wrong content,
/// "PATH: /DATASET[index] = VALUE: expected ...".
State read_last_frame(const std::string& path);

/// What a Writer has kept of a run but for its frames and events.
struct RecordedRun {
  std::string scene;           ///< Scene::text
  std::string version;         ///< of the program
  std::uint64_t needles = 0;   ///< their number
  std::vector<Totals> series;  ///< without samples if `with_series` was false
};

/// Reads a file of a Writer. Throws IoError if it cannot be read, and InputError for content that
/// no Writer leaves.
RecordedRun read_run(const std::string& path, bool with_series = true);

/// What `needlework info FILE` prints: datasets with their shapes, frames, times and parameters of
/// any H5MD file, some lines of text. Throws IoError if the file cannot be read.
std::string describe(const std::string& path);

}  // namespace needlework::io
