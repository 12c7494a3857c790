// Which rods of finite width overlap, found by cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "kernels/contact_function.h"
#include "needlework/composition.h"
#include "src/box/box.h"

namespace needlework {

/// Rods in a box, entered one after the other. Thin needles, and those that pass through each
/// other, do not overlap.
class RodGrid {
 public:
  /// `composition` must outlive the grid. Every edge of the box is at least twice the largest
  /// extent along periodic axes.
  RodGrid(const Composition& composition, const Box& box, std::size_t rods);

  /// A rod that overlaps one that has been entered.
  struct Overlap {
    std::size_t other;  ///< as it has been entered, from 0
    double distance;    ///< of the axes [L]
    double expected;    ///< at least [L]
  };
  /// The first rod entered that this one overlaps by more than `tolerance`. [L]
  std::optional<Overlap> overlap(const std::array<double, 3>& centre,
                                 const std::array<double, 3>& director, SpeciesIndex species,
                                 double tolerance) const;
  /// All of them, in no order.
  std::vector<Overlap> overlaps(const std::array<double, 3>& centre,
                                const std::array<double, 3>& director, SpeciesIndex species,
                                double tolerance) const;
  void enter(const std::array<double, 3>& centre, const std::array<double, 3>& director,
             SpeciesIndex species);

 private:
  template <class Visit>
  void visit_overlaps(const std::array<double, 3>& centre, const std::array<double, 3>& director,
                      SpeciesIndex species, double tolerance, Visit&& visit) const;

  struct Rod {
    kernels::Flight flight;
    SpeciesIndex species;
    std::uint32_t next;  ///< in the same cell, or none
  };
  using Cell = std::array<std::int64_t, 3>;
  /// The cells of the rods of one extent.
  struct Level {
    double extent = 0;  ///< [L]
    std::size_t entered = 0;
    Cell counts{};
    std::vector<std::uint32_t> first;  ///< in each cell

    std::size_t index_of(const Cell& cell) const;
  };
  Cell cell_of(const Level& level, const Vec3d& r) const;
  /// Calls visit(i) for the rods of a level in the cells within `reach` of r, each once.
  template <class Visit>
  void for_each_near(const Level& level, const Vec3d& r, double reach, const Visit& visit) const;

  const Composition& composition_;
  Box box_;
  std::vector<Level> levels_;
  std::vector<std::size_t> level_of_species_;
  std::vector<Rod> rods_;
};

}  // namespace needlework
