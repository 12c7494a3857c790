// Which rods of finite width overlap, found by cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kernels/contact_function.h"
#include "needlework/composition.h"
#include "src/box/box.h"

namespace needlework {

/// What a rod is, as far as overlaps go.
struct RodShape {
  double length = 0, diameter = 0;  ///< [L]
  SpeciesIndex species = 0;

  double extent() const { return length + diameter; }  ///< from end to end [L]
};

/// Rods in a box, entered one after the other. Thin needles, and those that pass through each
/// other, do not overlap.
class RodGrid {
 public:
  /// For these rods of these species, which must outlive the grid. Every edge of the box is at
  /// least twice the largest extent along periodic axes.
  RodGrid(const Composition& composition, std::span<const RodShape> rods, const Box& box);

  /// A rod that overlaps one that has been entered.
  struct Overlap {
    std::size_t other;  ///< as it has been entered, from 0
    double distance;    ///< of the axes [L]
    double expected;    ///< at least [L]
  };
  /// The first rod entered that this one overlaps by more than `tolerance`. [L]
  std::optional<Overlap> overlap(const std::array<double, 3>& centre,
                                 const std::array<double, 3>& director, const RodShape& rod,
                                 double tolerance) const;
  /// All of them, in no order.
  std::vector<Overlap> overlaps(const std::array<double, 3>& centre,
                                const std::array<double, 3>& director, const RodShape& rod,
                                double tolerance) const;
  void enter(const std::array<double, 3>& centre, const std::array<double, 3>& director,
             const RodShape& rod);

 private:
  template <class Visit>
  void visit_overlaps(const std::array<double, 3>& centre, const std::array<double, 3>& director,
                      const RodShape& rod, double tolerance, Visit&& visit) const;

  struct Rod {
    kernels::Flight flight;
    RodShape shape;
    std::uint32_t next;  ///< in the same cell, or none
  };
  using Cell = std::array<std::int64_t, 3>;
  /// The cells of rods of about one extent.
  struct Level {
    double extent = 0;  ///< the largest; others are longer than half of it [L]
    std::size_t entered = 0;
    Cell counts{};
    std::vector<std::uint32_t> first;  ///< in each cell

    std::size_t index_of(const Cell& cell) const;
  };
  Cell cell_of(const Level& level, const Vec3d& r) const;
  /// Calls visit(i) for the rods of a level in the cells within `reach` of r, each once.
  template <class Visit>
  void for_each_near(const Level& level, const Vec3d& r, double reach, const Visit& visit) const;

  Level& level_of(const RodShape& rod);

  const Composition& composition_;
  Box box_;
  std::vector<Level> levels_;  ///< the longest rods first
  std::vector<Rod> rods_;
};

}  // namespace needlework
