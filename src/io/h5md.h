// H5MD 1.1 files: trajectories, series and collisions out; initial states in.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "src/engine/simulation.h"
#include "src/scene/scene.h"

namespace needlework::io {

/// What a file says about its run besides the scene.
struct RunInfo {
  std::string isa;
  int threads = 1;
  double epoch_length = 0;
};

/// Writes one run to one file, created on construction. Everything written before the last flush()
/// can be read after a crash. Throws IoError with the path and the reason.
class Writer {
 public:
  /// Refuses an existing file unless `force`. The file appears under its name only when this
  /// constructor has written a valid H5MD header.
  Writer(const std::string& path, bool force, const Scene& scene, const RunInfo& run);
  Writer(Writer&&) noexcept;
  Writer& operator=(Writer&&) noexcept;
  ~Writer();

  /// Appends a sample to each series under /observables (t_tr, t_rot, energy, momentum, collisions,
  /// tc_collisions), on their common step and time.
  void write_series(const Totals& totals);
  /// Appends a frame to /particles/needles. `step` is the number of collisions so far.
  void write_frame(double time, std::uint64_t step, const State& state);
  /// Appends to /events; buffered.
  void write_event(const Collision& collision);
  void flush();
  void close();  ///< flushes and reports errors; the destructor is silent

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Reads the last frame of any H5MD file with position, velocity, orientation, angular_velocity.
/// Box edges as [3], [3][3], [F][3] or [F][3][3]; id as plain dataset, time-dependent or none; no
/// mass, no image and positions on the box edge are fine. Throws IoError (unreadable) or InputError
/// (wrong content), naming file, dataset, value and what was expected.
State read_last_frame(const std::string& path);

/// What `needlework info FILE` prints: layout, sizes, times, parameters.
std::string describe(const std::string& path);

}  // namespace needlework::io
