#include "src/engine/present_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "kernels/free_flight.h"
#include "needlework/error.h"
#include "src/composition/sizes.h"
#include "src/physics/director.h"
#include "src/physics/vectors.h"

namespace needlework {

// As whoever multiplies what a file says of the start by the scale has them, bit by bit.
static BodyNumbers body_of(const Gas& gas, const PresentSizes& sizes, Needle i) {
  const Body body = gas.body(i);
  BodyNumbers out{body.length(), 2 * body.radius, body.mass, body.inertia};
  if (!gas.growth) return out;
  if (gas.has_own_bodies()) {
    const double share = sizes.at_start.longest() / gas.composition.longest();
    out.length *= share;
    out.diameter *= share;
  } else {
    const Species& species = sizes.at_start[gas.records[i].species];
    out.length = species.length;
    out.diameter = species.diameter;
    if (!species.fixed) out.inertia = species.inertia();
  }
  out.length *= sizes.scale;
  out.diameter *= sizes.scale;
  return out;
}

void copy_own_bodies(const Gas& gas, const PresentSizes& sizes, const std::vector<Needle>& order,
                     OwnBodies& own) {
  const std::size_t rows = gas.has_own_bodies() || gas.growth ? order.size() : 0;
  for (std::vector<double>* column : {&own.length, &own.diameter, &own.mass, &own.inertia})
    column->resize(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const BodyNumbers body = body_of(gas, sizes, order[row]);
    own.length[row] = body.length;
    own.diameter[row] = body.diameter;
    own.mass[row] = body.mass;
    own.inertia[row] = body.inertia;
  }
}

void copy_state(const Gas& gas, Time at, kernels::Isa isa, const std::vector<Needle>& order,
                State& out) {
  using C = kernels::FlightColumns;
  const Box box = gas.box_at(at);
  out.box = gas.edges_at(at);
  out.low = gas.low_at(at);
  out.periodic = box.periodic();
  out.slide = to_double(box.row_above().offset);
  out.shear_rate = gas.shear ? gas.shear->rate() : 0;
  out.resize(gas.size());
  out.peculiar_velocity.resize(gas.shear ? gas.size() : 0);
  out.peculiar_x.resize(gas.peculiar_x ? gas.size() : 0);
  out.species.resize(gas.composition.is_mixture() ? gas.size() : 0);
  // Few enough for the columns to stay in the first-level cache.
  constexpr std::size_t at_once = 64;
  static_assert(at_once % kernels::flights_at_once == 0);
  double columns[C::columns][at_once] = {};
  kernels::FlightColumns flights;
  for (int c = 0; c < C::columns; ++c) flights.column[c] = columns[c];
  for (std::size_t begin = 0; begin < order.size(); begin += at_once) {
    const std::span needles(&order[begin], std::min(at_once, order.size() - begin));
    for (std::size_t n = 0; n < needles.size(); ++n) {
      const Record& record = gas.records[needles[n]];
      flights.put(n, record.flight, gas.clock.difference(at, record.time));
    }
    kernels::fly(isa, flights, needles.size());
    for (std::size_t n = 0; n < needles.size(); ++n) {
      const Needle i = needles[n];
      const kernels::Flight& flight = gas.records[i].flight;
      const double elapsed = columns[C::elapsed][n];
      const bool slides = gas.slides && gas.records[i].is_sliding();
      const kernels::BodyState sliding = slides ? gas.present(i, at) : kernels::BodyState{};
      const auto [place, boxes] =
          box.wrap(to_array(slides      ? sliding.r
                            : gas.falls ? gas.motion(gas.records[i]).centre(elapsed)
                                        : flights.centre(n)));
      const bool just_now = elapsed == 0;
      const std::size_t row = begin + n;
      out.id[row] = gas.ids[i].value;
      if (!out.species.empty()) out.species[row] = gas.records[i].species;
      out.position[row] = place;
      out.image[row] = box.counted_now(gas.images[i] + shift_of(boxes));  // see most_boxes
      const Vec3d velocity = slides ? sliding.v : gas.motion(gas.records[i]).velocity(elapsed);
      out.velocity[row] = to_array(velocity - box.image(boxes).velocity);
      if (gas.shear) {
        const Vec3d centre = gas.motion(gas.records[i]).centre(elapsed);
        out.peculiar_velocity[row] = to_array(velocity - gas.flow_at(centre));
      }
      if (gas.peculiar_x) out.peculiar_x[row] = (*gas.peculiar_x)[i] + gas.way_beside_flow(i, at);
      out.orientation[row] = to_array(just_now ? flight.u : normalised(flights.director(n)));
      out.angular_velocity[row] = to_array(flight.w);
      if (!slides) continue;
      out.orientation[row] = to_array(normalised(sliding.u));
      out.angular_velocity[row] = to_array(project_out(sliding.w, normalised(sliding.u)));
    }
  }
}

FreeNeedle needle_at(const Gas& gas, const PresentSizes& sizes, Time at, Id id) {
  const auto found = std::find(gas.ids.begin(), gas.ids.end(), id);
  if (found == gas.ids.end()) {
    throw InputError(fmt::format("needle {}: expected the id of a needle", id.value));
  }
  const Needle i(static_cast<std::size_t>(found - gas.ids.begin()));
  kernels::BodyState there = gas.present(i, at);
  // A director that has not moved keeps its bits.
  const Record& record = gas.records[i];
  if (record.time != at || record.is_sliding()) there.u = normalised(there.u);
  const Box box = gas.box_at(at);
  const auto [place, boxes] = box.wrap(to_array(there.r));
  FreeNeedle out;
  out.position = place;
  out.orientation = to_array(there.u);
  out.velocity = to_array(there.v - box.image(boxes).velocity);
  out.angular_velocity = to_array(there.w);
  const BodyNumbers body = body_of(gas, sizes, i);
  out.length = body.length;
  out.diameter = body.diameter;
  return out;
}

void require_images(const Gas& gas, Time at) {
  for (Needle i{0}; i < gas.size(); ++i) {
    const Vec3d centre =
        gas.slides ? gas.present(i, at).r : gas.motion_from(gas.records[i], at).centre();
    add_boxes(gas, i, gas.box_at(at).wrap(to_array(centre)).boxes);
  }
}

}  // namespace needlework
