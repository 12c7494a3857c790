// What an observable is: values at the times of the series, which a scene calls for by name.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "needlework/collision.h"
#include "needlework/composition.h"
#include "needlework/scene.h"
#include "needlework/series.h"
#include "needlework/state.h"
#include "needlework/totals.h"
#include "src/archive/archive.h"
#include "src/box/box.h"
#include "src/box/moving_edge.h"
#include "src/composition/sizes.h"
#include "src/observe/grid.h"
#include "src/observe/vector.h"
#include "src/observe/wall_slabs.h"

namespace needlework::observe {

/// Which species each needle is of, by its id, and what it is where those of a species differ.
class SpeciesById {
 public:
  SpeciesById() = default;
  /// Of needles in order of id; no species: all are of the first.
  SpeciesById(std::vector<std::uint32_t> ids, std::vector<SpeciesIndex> species, OwnBodies own = {})
      : ids_(std::move(ids)), species_(std::move(species)), own_(std::move(own)) {}

  /// 0 for an id that is none.
  std::size_t operator()(std::uint32_t id) const {
    return species_.empty() ? 0 : species_of_row(row(id));
  }
  /// Its numbers, those of this species where it has none of its own.
  BodyNumbers body(std::uint32_t id, const Species& species) const {
    const std::size_t i = own_.empty() ? size() : row(id);
    if (i == size()) return {species.length, species.diameter, species.mass, species.inertia()};
    return {own_.length[i], own_.diameter[i], own_.mass[i], own_.inertia[i]};
  }

  std::size_t size() const { return ids_.size(); }
  /// In order of id; size() for an id that is none.
  std::size_t row(std::uint32_t id) const {
    const auto found = std::lower_bound(ids_.begin(), ids_.end(), id);
    const bool is_there = found != ids_.end() && *found == id;
    return is_there ? static_cast<std::size_t>(found - ids_.begin()) : size();
  }
  std::size_t species_of_row(std::size_t row) const {
    return row < species_.size() ? species_[row] : 0;
  }
  /// Columns of rows, or empty.
  const OwnBodies& own() const { return own_; }

 private:
  std::vector<std::uint32_t> ids_;
  std::vector<SpeciesIndex> species_;
  OwnBodies own_;
};

/// What is known of a gas before it is sampled. An observable of single needles is made for each
/// species, with a setting that tells of its needles alone.
struct GasSetting {
  std::size_t count = 0;    ///< of the needles that the observable is given
  std::size_t all = 0;      ///< of all species
  Box box;                  ///< at the start, if walls move edges
  double length = 1;        ///< the longest extent [L]
  double mass = 1;          ///< of one species the mean, of several none
  double inertia = 1;       ///< I = m L^2 / (2 k), or q m D^2 / 4 of rough spheres
  int rotations = 2;        ///< rotational degrees of freedom; 3 of rough spheres
  bool is_sheared = false;  ///< rows of boxes slide, if only by what they have at the start
  double shear_rate = 0;    ///< of the uniform flow [1 / time]
  bool grows = false;       ///< whether bodies do; sizes are those of the start
  std::array<int, 3> cells{1, 1, 1};
  std::vector<Slabs> wall_slabs;  ///< across each axis with walls
  Composition composition;
  SpeciesById species_by_id;

  /// The edges of the box as walls with a velocity move them, where there are some.
  std::optional<MovingEdges> moving_edges;

  /// The rotational temperature with this mean square of the angular velocity, of one species.
  double t_rot(double w2) const { return inertia * w2 / rotations; }
  double volume() const { return box.volume(); }
  double volume_at(double time) const;
  /// The mean between two times since the start of the scene.
  double mean_volume(double from, double until) const;
  GasSetting of_species(std::size_t index) const;
};

/// Of a scene that is complete. Cells are those of output.grid, or the default.
GasSetting setting_of(const Scene& scene);

/// Shape of a field with such values for each two species; the values' own if there is one species.
std::vector<SeriesField::Extent> by_pair(const Composition& composition,
                                         std::vector<SeriesField::Extent> shape);

/// Sums by species at one instant, collisions of each two by Composition::pair_index, hits on
/// walls, what has changed the energy, the virial of rods, contacts, the pressure tensor, and
/// sizes.
struct SpeciesSums {
  std::vector<SpeciesTotals> totals = {};
  std::vector<std::uint64_t> collisions = {};
  std::vector<WallTotals> walls = {};
  EnergyBudget energy = {};
  double virial = 0;              ///< of rods, Simulation::virial()
  double t_tr_integral = 0;       ///< of rods, Simulation::t_tr_integral()
  SlidingContacts contacts = {};  ///< of needles that slide on each other
  StressSums stress = {};         ///< where it is measured
  GrowthTotals growth = {};       ///< of bodies that grow
};

/// The gas at one instant. Holds references.
class Snapshot {
 public:
  /// The state in order of id, with positions in the box; may be without needles if no observable
  /// reads it.
  Snapshot(const GasSetting& gas, const State& state, const Totals& totals,
           const SpeciesSums& species)
      : gas(gas), state(state), totals(totals), species(species) {}

  const GasSetting& gas;
  const State& state;
  const Totals& totals;
  const SpeciesSums& species;

  std::size_t species_of(std::size_t i) const {
    return gas.composition.is_mixture() ? state.species[i] : 0;
  }
  /// The edges of the box and where the low ones are, by the state where walls move them. [L]
  const Vector& edges() const { return gas.moving_edges ? state.box : gas.box.edges(); }
  const Vector& low() const { return state.low; }
  double volume() const { return edges()[0] * edges()[1] * edges()[2]; }
  Grid grid() const { return {edges(), gas.cells, low()}; }

  /// Computed once for all observables.
  const Weights& weights() const;
  /// The means in the cells of the grid, computed once for all observables.
  const CellMeans& cells() const {
    if (!cells_) cells_ = means_in_cells(grid(), state, weights());
    return *cells_;
  }

 private:
  mutable std::optional<Weights> weights_;
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
