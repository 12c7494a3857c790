#include "src/engine/rods_apart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "needlework/error.h"
#include "src/engine/present_state.h"

namespace needlework {
namespace {

/// Rods never overlap by more than this share of their diameter, but for what rounding adds.
constexpr double most_overlap_of_rods = 1e-13;

}  // namespace

RodShape shape_of(const Gas& gas, Needle i, Time now) {
  const double scale = gas.scale_at(now);
  return {2 * gas.half_length(i) * scale, 2 * gas.radius(i) * scale, gas.records[i].species};
}

double explained_overlap(const Gas& gas, Time at) {
  // Least distance of axes in contact.
  const bool thin = gas.composition.is_partly_thin();
  double smallest = gas.composition.widest();
  // Positions and directors are rounded when records are made, and again when they are moved on.
  const double rounding = 0x1p-51 * (gas.longest + gas.box.sum_of_edges());
  double fastest = 0;
  for (Needle i{0}; i < gas.size(); ++i) {
    const Record& record = gas.records[i];
    const double radius = gas.radius(i);
    if (radius > 0) smallest = std::min(smallest, radius * (thin ? 1 : 2));
    const double fallen =
        std::sqrt(dot(gas.gravity, gas.gravity)) * gas.clock.difference(at, record.time);
    const double turns = gas.half_length(i) * record.flight.omega;
    fastest = std::max(fastest, std::sqrt(dot(record.flight.v, record.flight.v)) + fallen + turns);
  }
  return most_overlap_of_rods * smallest + rounding + 2 * fastest * gas.clock.resolution();
}

std::optional<RodOverlap> find_overlap(const Gas& gas, Time at, kernels::Isa isa,
                                       double tolerance) {
  if (!gas.composition.has_width()) return {};
  std::vector<Needle> order;
  std::vector<RodShape> shapes;
  for (Needle i{0}; i < gas.size(); ++i) {
    order.push_back(i);
    shapes.push_back(shape_of(gas, i, at));
  }
  State state;
  copy_state(gas, at, isa, order, state);
  RodGrid grid(gas.composition, shapes, gas.box_at(at));
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto overlap =
        grid.overlap(state.position[i], state.orientation[i], shapes[i], tolerance);
    grid.enter(state.position[i], state.orientation[i], shapes[i]);
    if (!overlap) continue;
    const auto [first, second] = std::minmax(state.id[overlap->other], state.id[i]);
    return RodOverlap{first, second, overlap->expected - overlap->distance};
  }
  return {};
}

void require_rods_apart(const Gas& gas, Time at, kernels::Isa isa, double tolerance) {
  const auto found = find_overlap(gas, at, isa, tolerance);
  if (!found) return;
  throw InvalidStateError(
      fmt::format("rods {} and {} overlap by {:.3g} at time {:.17g}, expected at most {:.3g}: a "
                  "contact was missed; this is a defect of the program",
                  found->first, found->second, found->depth, gas.clock.since_start(at), tolerance),
      {{found->first, found->second}});
}

}  // namespace needlework
