// Correlations of pairs at the distance r of their centres, taken between nearest images,
// of which there are none along axes with walls:
//
//   g   pairs with r in a bin, divided by N (N - 1) / 2 times the share of pairs of bodies that
//   know
//       of nothing but the walls (ideal_pairs.h): in a periodic box the bin's share of its volume
//   p2  mean of P2(u_i . u_j) = (3 (u_i . u_j)^2 - 1) / 2 over these pairs; 0 for independent
//       directors, 1 for parallel ones, NaN where there are no pairs
//
// With several species, of the pairs of each two of them: N_a N_b pairs of needles of a and b.
//
// r goes up to 3 lengths of the longest needles, or to half the shortest periodic edge of the box
// if that is less, at the start where walls move edges; the ideal gas is in the box of the instant.
// Pairs come from a list of cells at least that wide, in an order that follows
// from the state alone.
#include <algorithm>
#include <array>
#include <cmath>

#include "src/box/box.h"
#include "src/observe/ideal_pairs.h"
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

constexpr std::size_t bins = 60;

struct Needle {
  Vector position, director;
  std::size_t species;
};
using Cell = std::vector<Needle>;

class PairCorrelation : public Observable {
 public:
  explicit PairCorrelation(const GasSetting& gas) : gas_(gas) {
    const IdealPairs ideal(gas);
    reach_ = std::min(3 * gas.length, ideal.reach());
    for (std::size_t n = 0; n <= bins; ++n) borders_.push_back(reach_ * double(n) / bins);
    take_ideal(ideal, gas.box.edges());
  }

  std::vector<SeriesField> fields() const override {
    return {
        {"g", "Number of pairs by distance, divided by that of an ideal gas", unit::none,
         by_pair(gas_.composition, {{"distance bins", bins}})},
        {"p2", "Mean of (3 cos^2 - 1) / 2 of the angle between the needles of these pairs",
         unit::none, by_pair(gas_.composition, {{"distance bins", bins}})},
        {"borders",
         "Borders of the bins of distance",
         unit::length,
         {{"distance bins + 1", bins + 1}},
         SeriesField::Kind::constant,
         borders_},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    const Composition& composition = gas_.composition;
    pairs_.assign(composition.pairs() * bins, 0.0);
    p2_.assign(composition.pairs() * bins, 0.0);
    if (now.edges() != edges_) take_ideal(IdealPairs(gas_, now.edges()), now.edges());
    visit_near_pairs(now.state);
    for (std::size_t a = 0; a < composition.size(); ++a) {
      for (std::size_t b = a; b < composition.size(); ++b) {
        const double first = static_cast<double>(composition[a].count);
        const double second = static_cast<double>(composition[b].count);
        put_g(composition.pair_index(a, b), a == b ? first * (first - 1) / 2 : first * second, row);
      }
    }
    for (std::size_t n = 0; n < pairs_.size(); ++n) row.put(p2_[n] / pairs_[n]);
  }

 private:
  void take_ideal(const IdealPairs& ideal, const Vector& edges) {
    edges_ = edges;
    ideal_.clear();
    for (std::size_t a = 0; a < gas_.composition.size(); ++a) {
      for (std::size_t b = a; b < gas_.composition.size(); ++b) {
        const std::vector<double> shares = ideal.shares(a, b, borders_);
        ideal_.insert(ideal_.end(), shares.begin(), shares.end());
      }
    }
  }

  void put_g(std::size_t pair, double all_pairs, Row& row) const {
    for (std::size_t n = 0; n < bins; ++n) {
      const std::size_t place = pair * bins + n;
      row.put(pairs_[place] / (all_pairs * ideal_[place]));
    }
  }

  void add(const Box& box, const Needle& one, const Needle& other) {
    const auto [x, y, z] = minus(other.position, one.position);
    const Vec3d nearest = box.shortest({x, y, z});
    const double square = dot(nearest, nearest);
    if (!(square < reach_ * reach_)) return;
    const auto bin = static_cast<std::size_t>(std::sqrt(square) / reach_ * bins);
    if (bin >= bins) return;
    const std::size_t place = gas_.composition.pair_index(one.species, other.species) * bins + bin;
    ++pairs_[place];
    p2_[place] += second_legendre(dot(one.director, other.director));
  }

  void add_pairs_within(const Box& box, const Cell& cell) {
    for (std::size_t n = 0; n < cell.size(); ++n)
      for (std::size_t m = n + 1; m < cell.size(); ++m) add(box, cell[n], cell[m]);
  }

  void visit_near_pairs(const State& state) {
    const Box box = box_of(state);
    // Where rows of boxes slide, cells have edges along the vectors of the present lattice, so that
    // neighbours are the same in all rows. Cells of a given volume are thinner along x for that.
    const double slide = box.vectors()[1][0];
    const double slope = (slide - box.edge(0) * std::nearbyint(slide / box.edge(0))) / box.edge(1);
    const Vector apart{box.edge(0) / std::hypot(1, slope), box.edge(1), box.edge(2)};
    std::array<int, 3> extent{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      extent[axis] = static_cast<int>(std::min(apart[axis] / reach_, 100.0));
      // With two cells along an axis, one would be on both sides of the other.
      if (extent[axis] < 3) extent[axis] = 1;
    }
    const Grid grid(box.edges(), extent, state.low);
    std::vector<Cell> cells(grid.size());
    for (std::size_t i = 0; i < state.size(); ++i) {
      const std::size_t species = gas_.composition.is_mixture() ? state.species[i] : 0;
      Vector place = state.position[i];
      if (slope != 0) {
        const double x = place[0] - slope * place[1];
        place[0] = x - box.edge(0) * std::floor(x / box.edge(0));
      }
      cells[grid.cell_of(place)].push_back({state.position[i], state.orientation[i], species});
    }
    for (const Cell& cell : cells) add_pairs_within(box, cell);
    if (cells.size() == 1) return;
    for (int x = 0; x < extent[0]; ++x)
      for (int y = 0; y < extent[1]; ++y)
        for (int z = 0; z < extent[2]; ++z) add_pairs_across(box, cells, extent, {x, y, z});
  }

  // The pairs of a cell with half of its 26 neighbours: each pair once.
  void add_pairs_across(const Box& box, const std::vector<Cell>& cells,
                        const std::array<int, 3>& extent, const std::array<int, 3>& cell) {
    const auto at = [&](int dx, int dy, int dz) -> const Cell& {
      const std::array<int, 3> step{dx, dy, dz};
      std::size_t index = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int n = (cell[axis] + step[axis] + extent[axis]) % extent[axis];
        index = index * static_cast<std::size_t>(extent[axis]) + static_cast<std::size_t>(n);
      }
      return cells[index];
    };
    const Cell& here = at(0, 0, 0);
    for (int neighbour = 14; neighbour < 27; ++neighbour) {  // 13 is the cell itself
      const std::array<int, 3> step{neighbour / 9 - 1, neighbour / 3 % 3 - 1, neighbour % 3 - 1};
      const auto leaves = [&](std::size_t axis) { return extent[axis] == 1 && step[axis] != 0; };
      if (leaves(0) || leaves(1) || leaves(2)) continue;
      for (const Needle& other : at(step[0], step[1], step[2]))
        for (const Needle& one : here) add(box, one, other);
    }
  }

  GasSetting gas_;
  double reach_ = 0;
  std::vector<double> borders_;
  Vector edges_{};                  ///< of the box that the ideal gas is in
  std::vector<double> ideal_;       ///< share of all pairs, by pair of species, then bin
  std::vector<double> pairs_, p2_;  ///< by pair of species, then bin
};

}  // namespace

ObservablePointer make_pair_correlation(const GasSetting& gas) {
  return std::make_unique<PairCorrelation>(gas);
}

}  // namespace needlework::observe
