// What an observable is: values at the times of the series, which a scene calls for by name.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "needlework/collision.h"
#include "needlework/scene.h"
#include "needlework/series.h"
#include "needlework/state.h"
#include "needlework/totals.h"
#include "src/archive/archive.h"
#include "src/observe/grid.h"
#include "src/observe/vector.h"

namespace needlework::observe {

/// Units in words, for SeriesField::unit.
namespace unit {
inline constexpr const char* none = "";
inline constexpr const char* time = "time";
inline constexpr const char* length = "length";
inline constexpr const char* area = "length squared";
inline constexpr const char* wave_number = "radians per length";
inline constexpr const char* density = "needles per volume";
inline constexpr const char* speed = "length per time";
inline constexpr const char* angular_speed = "radians per time";
inline constexpr const char* energy = "energy";
inline constexpr const char* angle = "radians";
}  // namespace unit

/// What is known of a gas before it is sampled.
struct GasSetting {
  std::size_t count = 0;
  Vector box{};
  double length = 1, mass = 1;
  double inertia = 1;  ///< I = m L^2 / (2 k)
  std::array<int, 3> cells{1, 1, 1};

  double volume() const { return box[0] * box[1] * box[2]; }
  Grid grid() const { return {box, cells}; }
};

/// Of a scene that is complete. Cells are those of output.grid, or the default.
GasSetting setting_of(const Scene& scene);

/// The gas at one instant. Holds references.
class Snapshot {
 public:
  /// The state in order of id, with positions in the box; may be without needles if no observable
  /// reads it.
  Snapshot(const GasSetting& gas, const State& state, const Totals& totals)
      : gas(gas), state(state), totals(totals) {}

  const GasSetting& gas;
  const State& state;
  const Totals& totals;

  /// The means in the cells of the grid, computed once for all observables.
  const CellMeans& cells() const {
    if (!cells_) cells_ = means_in_cells(gas.grid(), state);
    return *cells_;
  }

 private:
  mutable std::optional<CellMeans> cells_;
};

/// The numbers of one sample, one row after the other.
class Row {
 public:
  void put(double value) { values_.push_back(value); }
  template <class Numbers>
  void put_all(const Numbers& numbers) {
    values_.insert(values_.end(), numbers.begin(), numbers.end());
  }
  void clear() { values_.clear(); }
  const std::vector<double>& values() const { return values_; }

 private:
  std::vector<double> values_;
};

/// One observable. All sums run in the order of the state, which is that of ids, so that rows
/// depend on nothing else. Where a value is undefined, as a mean over no needles, it is NaN.
class Observable {
 public:
  virtual ~Observable() = default;

  /// Its datasets, the same at any time.
  virtual std::vector<SeriesField> fields() const = 0;
  /// Puts a row of each field that is not constant, in their order.
  virtual void sample(const Snapshot& now, Row& row) = 0;

  /// Whether sample() reads Snapshot::state, which costs a copy of all needles.
  virtual bool reads_state() const { return true; }
  /// Whether collision() is to be called for each collision, in order of time. A row then tells
  /// what happened since the last sample.
  virtual bool reads_collisions() const { return false; }
  virtual void collision(const Collision&) {}

  /// A caller has replaced all velocities, which no theory of a gas left to itself describes.
  virtual void velocities_set() {}

  /// Saves or restores what rows depend on besides the snapshot, so that a run that continues from
  /// a checkpoint goes on with the same rows. Most observables remember nothing.
  virtual void transfer(Archive&) {}
};

using ObservablePointer = std::unique_ptr<Observable>;

}  // namespace needlework::observe
