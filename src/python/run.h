// A simulation with its output, as Python uses it.
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "needlework/scene.h"
#include "needlework/state.h"
#include "src/python/scene_source.h"
#include "src/runs/limits.h"
#include "src/runs/prepared_run.h"

namespace needlework::python {

/// One thread at a time uses a Run: while it advances, without the GIL, all but interrupt() throw
/// UseError. Members are called with the GIL held.
class Run {
 public:
  /// Without a state, that of the scene. Throws what the program would report.
  Run(const SceneSource& source, std::optional<State> state, bool force);
  /// Continues the run of an output file from its last checkpoint.
  explicit Run(const std::string& file);
  ~Run();

  /// Runs until one of the conditions is met, which count from the start of the run, or those of
  /// the scene if there are none. Returns a word for the reason. `show` is None or called with
  /// lines of progress. Throws what a callback or the handler of a signal has thrown.
  std::string run(const runs::Limits& limits, const pybind11::object& show);
  /// The same for conditions that count from the present state.
  std::string advance(const runs::Limits& limits, const pybind11::object& show);
  void interrupt() noexcept { run_->simulation().interrupt(); }

  /// `callback`, unless it is None, is given arrays of up to `batch` rows of this type.
  void on_collisions(const pybind11::object& callback, std::size_t batch,
                     const pybind11::dtype& type);
  /// The same for all that happens.
  void on_happenings(const pybind11::object& callback, std::size_t batch,
                     const pybind11::dtype& type);
  void set_velocities(std::vector<std::array<double, 3>> velocity,
                      std::vector<std::array<double, 3>> angular_velocity);
  /// Adds a sample of the present state to the output file, and a frame if it is wanted.
  void sample(bool frame);
  /// Sets a value of the user's own, or removes it if there are no bytes.
  void set_data(const std::string& name, std::optional<std::string> bytes, bool json);
  /// All of them: pairs of whether it is JSON and its bytes, by name.
  pybind11::dict data();
  /// When a caller first replaced all velocities, or None.
  std::optional<double> velocities_set();
  /// Writes the present state to a file of its own; see write_state().
  void save(const std::string& path, bool force);
  /// Saves the run beside its output file, so that it can be continued from here.
  void checkpoint();
  void close();

  /// A copy of the present state: read-only arrays position, velocity, orientation,
  /// angular_velocity, image, id and species, and those of OwnBodies or None.
  pybind11::tuple state();
  pybind11::dict totals();
  /// Pairs of a name and sums, in the order of the scene.
  pybind11::list species_totals();
  /// By names such as "a-b".
  pybind11::dict collisions_by_pair();
  /// A dictionary of each wall, in the order of the scene.
  pybind11::list wall_totals();
  pybind11::dict energy_budget();
  pybind11::dict rod_totals();
  pybind11::object sliding_contacts();
  pybind11::object growth();
  pybind11::object stress();
  /// Under uniform shear: slide, rate, and velocities beside the flow; else None.
  pybind11::object flow();
  /// Edges of the box and where the low ones are, now.
  pybind11::tuple box();
  pybind11::dict counters();
  /// The scene, which does not change, and the parts of the engine in use.
  pybind11::dict facts();
  double time();
  double mean_free_time();
  std::string hash();
  pybind11::list warnings() const;

 private:
  void add_warning(const std::string& warning);
  void require_idle() const;
  void require_open() const;
  /// Calls the function without the GIL. Meanwhile this Run is busy.
  void work(const std::function<void()>& function);
  std::string drive(const Scene::Until& until, const pybind11::object& show);

  std::optional<runs::PreparedRun> run_;
  std::vector<std::string> warnings_;
  bool busy_ = false;  ///< guarded by the GIL
  bool closed_ = false;
};

}  // namespace needlework::python
