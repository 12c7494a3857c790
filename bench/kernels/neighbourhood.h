// What kernels work on: needles drawn from equilibrium, as a search finds them around one of them.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/contact_function.h"
#include "kernels/near_needles.h"

namespace needlework::bench {

/// A gas of the density of one of the paper's scenes.
struct GasName {
  const char* name;
  double density;  ///< [L^-3]
};
inline constexpr GasName gases[] = {{"dilute", 0.72}, {"dense", 11.6}};

/// How far searches look ahead at this density and T = 1, about.
double time_ahead(double density);

/// Two needles whose bounding spheres meet within the time ahead.
struct NearPair {
  kernels::Flight first, second;

  /// Refers to this pair, which must outlive it.
  kernels::Pair view() const {
    kernels::Pair out;
    out.first = &first;
    out.second = &second;
    return out;
  }
};
std::vector<NearPair> near_pairs(double density, std::size_t count);

/// One needle and the cells around it.
struct Neighbourhood {
  kernels::Seeker seeker{};
  std::vector<kernels::CellView> cells;
  std::size_t needles = 0;  ///< in these cells
};

/// Cells of a gas, of the sides that the searches choose, and neighbourhoods of `count` of its
/// needles. The words of the blocks hold directors (for overlapping) or velocities (for
/// approaching).
struct Neighbourhoods {
  enum class Columns { directors, velocities };
  Neighbourhoods(double density, Columns columns, std::size_t count);

  kernels::Surroundings around(const Neighbourhood& one) const {
    return {blocks.data(), next.data(), one.cells.data(), one.cells.size(), format};
  }

  kernels::WordFormat format;
  std::vector<kernels::NeedleBlock> blocks;
  std::vector<std::uint32_t> next;
  std::vector<Neighbourhood> all;
  std::size_t most_needles = 0;  ///< of any
};

/// Pairs of one needle with those that meet its bounding sphere, as bracket() takes them.
struct PairBatch {
  explicit PairBatch(const std::vector<NearPair>& pairs, double time_ahead);

  kernels::PairColumns columns();
  /// Undoes what bracket() has written.
  void restart();

  kernels::Seeker seeker{};
  std::size_t size;

 private:
  std::size_t room_;
  std::vector<float> storage_;
};

/// Those of the first `count` needles.
std::vector<PairBatch> pair_batches(double density, std::size_t count);

}  // namespace needlework::bench
