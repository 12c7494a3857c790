#include "src/scene/rod_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "src/box/vector.h"
#include "src/machine/stop_request.h"

namespace needlework {
namespace {

// Sites of a cell, as shares of its edges; rods are along the third.
constexpr Vector hexagonal[] = {{0, 0, 0}, {0.5, 0.5, 0}};
constexpr Vector hexagonal_in_gaps[] = {
    {0, 0, 0}, {0.5, 0.5, 0}, {0, 1.0 / 3, 0.5}, {0.5, 5.0 / 6, 0.5}};
constexpr Vector square_in_gaps[] = {{0, 0, 0}, {0.5, 0.5, 0.5}};
// Face-centred cubic lattices: by their cubic cells, and in hexagonal layers.
constexpr Vector cubic[] = {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
constexpr Vector three_layers[] = {{0, 0, 0},
                                   {0.5, 0.5, 0},
                                   {0, 1.0 / 3, 1.0 / 3},
                                   {0.5, 5.0 / 6, 1.0 / 3},
                                   {0, 2.0 / 3, 2.0 / 3},
                                   {0.5, 1.0 / 6, 2.0 / 3}};
constexpr std::array<std::span<const Vector>, 5> families = {hexagonal, hexagonal_in_gaps,
                                                             square_in_gaps, cubic, three_layers};
// For rods and for spheres; the others are for spheres that the first have no room for.
constexpr std::size_t families_of_rods = 3;

// Two walls may leave rounding errors between rods and themselves.
constexpr double beside_walls = 1 + 0x1p-30;

// Of crossed blocks, at least.
constexpr double rods_in_block = 16;

struct Choice {
  std::size_t family = 0;
  std::array<std::size_t, 3> axes{};  // of the box, along the edges of the cell
  std::array<std::int64_t, 3> cells{};
  double clearance = 0;
};

// The edges of the box that a lattice fills, in the order of the edges of its cells.
struct Edges {
  Vector low, length;
  std::array<bool, 3> periodic;
};

double last_site(std::size_t family, std::size_t axis) {
  double out = 0;
  for (const Vector& site : families[family]) out = std::max(out, site[axis]);
  return out;
}

double edge_of_cell(const Edges& edges, std::size_t family, std::size_t axis, std::int64_t cells) {
  const double sites = static_cast<double>(cells) - 1 + last_site(family, axis);
  if (edges.periodic[axis]) return edges.length[axis] / static_cast<double>(cells);
  return sites > 0 ? edges.length[axis] / sites : std::numeric_limits<double>::infinity();
}

// The least distance of the axes of two rods on the lattice.
double least_distance(std::size_t family, const Vector& cell, double length) {
  double least = std::numeric_limits<double>::infinity();
  const auto sites = families[family];
  for (const Vector& site : sites) {
    for (int x = -2; x <= 2; ++x) {
      for (int y = -2; y <= 2; ++y) {
        for (int z = -2; z <= 2; ++z) {
          const Vector share = {x + site[0] - sites[0][0], y + site[1] - sites[0][1],
                                z + site[2] - sites[0][2]};
          if (share == Vector{}) continue;
          const auto along = [&](std::size_t axis) {
            return share[axis] == 0 ? 0 : std::abs(share[axis]) * cell[axis];
          };
          const double between = std::max(along(2) - length, 0.0);
          least = std::min(least, std::hypot(along(0), along(1), between));
        }
      }
    }
  }
  return least;
}

struct Fit {
  Choice choice;
  Edges edges;
};

// The fit with the most room of the families from `first` on, up to `end`.
Fit best_fit(const LatticeBox& box, double length, double diameter, std::size_t count,
             std::optional<std::size_t> along, std::size_t first, std::size_t end) {
  Choice best;
  Edges best_edges{};
  for (const auto& axes : {std::array<std::size_t, 3>{0, 1, 2},
                           {1, 0, 2},
                           {0, 2, 1},
                           {2, 0, 1},
                           {1, 2, 0},
                           {2, 1, 0}}) {
    if (along && axes[2] != *along) continue;
    Edges edges{};
    for (std::size_t n = 0; n < 3; ++n) {
      const std::size_t axis = axes[n];
      edges.periodic[n] = box.periodic[axis];
      const double beside =
          edges.periodic[n] ? 0 : 0.5 * (diameter + (n == 2 ? length : 0)) * beside_walls;
      edges.low[n] = box.low[axis] + beside;
      edges.length[n] = box.high[axis] - box.low[axis] - 2 * beside;
    }
    if (std::ranges::any_of(edges.length, [](double each) { return each < 0; })) continue;
    for (std::size_t family = first; family < end; ++family) {
      const auto sites = static_cast<std::int64_t>(families[family].size());
      const auto cells_needed = (static_cast<std::int64_t>(count) + sites - 1) / sites;
      const auto most_along = [&](std::size_t n, double spacing) {
        return static_cast<std::int64_t>(edges.length[n] / spacing) + 1;
      };
      for (std::int64_t nx = 1; nx <= most_along(0, diameter); ++nx) {
        StopRequest::check();
        for (std::int64_t ny = 1; ny <= most_along(1, diameter); ++ny) {
          const std::int64_t nz = (cells_needed + nx * ny - 1) / (nx * ny);
          if (nz > 2 * most_along(2, length + 0.5 * diameter)) continue;
          const Vector cell = {edge_of_cell(edges, family, 0, nx),
                               edge_of_cell(edges, family, 1, ny),
                               edge_of_cell(edges, family, 2, nz)};
          const double clearance = least_distance(family, cell, length) / diameter;
          if (!(clearance > best.clearance)) continue;
          best = {family, axes, {nx, ny, nz}, clearance};
          best_edges = edges;
        }
      }
    }
  }
  return {best, best_edges};
}

}  // namespace

std::optional<RodLattice> rod_lattice(const LatticeBox& box, double length, double diameter,
                                      std::size_t count, std::optional<std::size_t> along) {
  const auto fit = [&](std::size_t first, std::size_t end) {
    return best_fit(box, length, diameter, count, along, first, end);
  };
  auto [best, best_edges] = fit(0, families_of_rods);
  if (length == 0 && !(best.clearance > 1)) {
    const Fit denser = fit(families_of_rods, families.size());
    best = denser.choice;
    best_edges = denser.edges;
  }
  if (count > 0 && !(best.clearance > 1)) return std::nullopt;
  RodLattice out;
  out.clearance = best.clearance;
  Vector director{};
  director[best.axes[2]] = 1;
  out.director.assign(count, director);
  const auto sites = families[best.family];
  const std::size_t all =
      sites.size() * static_cast<std::size_t>(best.cells[0] * best.cells[1] * best.cells[2]);
  std::size_t site_number = 0, taken = 0;
  for (std::int64_t z = 0; z < best.cells[2]; ++z) {
    for (std::int64_t y = 0; y < best.cells[1]; ++y) {
      for (std::int64_t x = 0; x < best.cells[0]; ++x) {
        for (const Vector& site : sites) {
          // The first site at which a share of count / all sites is due.
          if (++site_number * count / all <= taken) continue;
          ++taken;
          const Vector share = {static_cast<double>(x) + site[0], static_cast<double>(y) + site[1],
                                static_cast<double>(z) + site[2]};
          Vector& position = out.position.emplace_back();
          for (std::size_t n = 0; n < 3; ++n) {
            const double edge = edge_of_cell(best_edges, best.family, n, best.cells[n]);
            const double place = share[n] == 0 ? 0 : share[n] * edge;
            // In the middle, where all are in one layer between walls.
            position[best.axes[n]] = std::isfinite(place) && std::isfinite(edge)
                                         ? best_edges.low[n] + place
                                         : best_edges.low[n] + 0.5 * best_edges.length[n];
          }
        }
      }
    }
  }
  return out;
}

std::optional<RodLattice> crossed_rods(const LatticeBox& box, double length, double diameter,
                                       std::size_t count) {
  // Smaller blocks than of some rods would leave room between them.
  const double most = std::max(2.0, std::cbrt(static_cast<double>(count) / rods_in_block));
  std::array<std::size_t, 3> counts{};
  Vector edge{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double room = box.high[axis] - box.low[axis];
    const double fitting = room / ((length + diameter) * beside_walls);
    counts[axis] = static_cast<std::size_t>(std::min(fitting, most));
    if (counts[axis] < 2) return std::nullopt;
    edge[axis] = room / static_cast<double>(counts[axis]);
  }
  const std::size_t blocks = counts[0] * counts[1] * counts[2];
  RodLattice out;
  out.clearance = std::numeric_limits<double>::infinity();
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::array<std::size_t, 3> at = {block % counts[0], block / counts[0] % counts[1],
                                           block / (counts[0] * counts[1])};
    // No rod reaches beyond its block.
    LatticeBox room{.low = {}, .high = {}, .periodic = {false, false, false}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      room.low[axis] = box.low[axis] + static_cast<double>(at[axis]) * edge[axis];
      room.high[axis] = room.low[axis] + edge[axis];
    }
    const std::size_t share = count * (block + 1) / blocks - count * block / blocks;
    const auto lattice = rod_lattice(room, length, diameter, share, (at[0] + at[1] + at[2]) % 3);
    if (!lattice) return std::nullopt;
    out.position.insert(out.position.end(), lattice->position.begin(), lattice->position.end());
    out.director.insert(out.director.end(), lattice->director.begin(), lattice->director.end());
    out.clearance = std::min(out.clearance, lattice->clearance);
  }
  return out;
}

}  // namespace needlework
