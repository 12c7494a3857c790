#include "src/engine/initial_gas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <vector>

#include "needlework/error.h"
#include "src/composition/total_mass.h"
#include "src/engine/rods_apart.h"
#include "src/machine/stop_request.h"
#include "src/physics/vectors.h"
#include "src/scene/box_edges.h"
#include "src/scene/check.h"
#include "src/scene/confinement.h"
#include "src/scene/derived_numbers.h"
#include "src/scene/growth_plan.h"
#include "src/scene/own_bodies.h"
#include "src/scene/section.h"

namespace needlework {
namespace {

void check_size(std::size_t actual, std::size_t expected, const char* what) {
  if (actual == expected) return;
  throw InputError(std::string("state: ") + std::to_string(actual) + " rows of " + what +
                   ": expected " + std::to_string(expected));
}

[[noreturn]] void refuse_vector(const Vec3d& a, const char* what, Id id, const char* expected) {
  throw InputError(fmt::format("state: needle {}: {} = ({}, {}, {}): expected {}", id.value, what,
                               a.x, a.y, a.z, expected));
}

void check_vector(const Vec3d& a, const char* what, Id id) {
  if (!is_finite(a)) refuse_vector(a, what, id, "finite numbers");
}

// The numbers that records count to, also once the centre is wrapped into the box.
void check_image(const Gas& gas, Needle i) {
  const Vec3d& r = gas.records[i].flight.r;
  const std::array<double, 3> place = to_array(r);
  const Boxes boxes = gas.box.wrap(place).boxes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int32_t image = gas.images[i][axis];
    if (image < -most_boxes || image > most_boxes) {
      throw InputError(
          fmt::format("state: needle {}: image = {}: expected a whole number from {} to {}",
                      gas.ids[i].value, image, -most_boxes, most_boxes));
    }
    if (std::abs(image + boxes[axis]) <= most_boxes) continue;
    throw InputError(fmt::format(
        "state: needle {}: position {} in a box of {}, with image {}: expected it within {} boxes",
        gas.ids[i].value, place[axis], gas.box.edge(axis), image, most_boxes));
  }
}

// A state that was read from a file is not run as one of other bodies.
void require_same_bodies(const Composition& composition, const Bodies& bodies) {
  for (const auto& [key, known, value] : {std::tuple("length", &Bodies::length, &Species::length),
                                          {"diameter", &Bodies::diameter, &Species::diameter},
                                          {"mass", &Bodies::mass, &Species::mass},
                                          {"k", &Bodies::k, &Species::k}}) {
    const std::vector<double>& expected = bodies.*known;
    if (expected.empty()) continue;
    check_size(expected.size(), composition.size(), "species");
    for (std::size_t n = 0; n < expected.size(); ++n) {
      const double given = composition[n].*value;
      const Species& its = composition[n];
      const bool is_fixed = its.fixed && std::isinf(expected[n]) && value == &Species::mass;
      const bool counts = (its.has_axis() || value != &Species::k) && !its.sizes && !is_fixed;
      if (!counts || std::abs(given - expected[n]) <= 1e-12 * expected[n]) continue;
      throw InputError(fmt::format("state: bodies of {} = {}: expected {}, as in the scene", key,
                                   expected[n], given));
    }
  }
}

// The species of the scene with the counts of the state.
Composition composition_of(const Scene& scene, const State& initial) {
  Composition composition = scene.composition();
  if (!composition.is_mixture()) composition.set_count(0, initial.size());
  if (composition.count() != initial.size()) {
    throw InputError(
        fmt::format("state: {} needles: expected {}, as the species of the scene count",
                    initial.size(), composition.count()));
  }
  require_same_bodies(composition, initial.bodies);
  return composition;
}

// Gives each needle its species; needles are in order of id, and came from these rows of the state.
void set_species(Gas& gas, const State& initial, const std::vector<std::size_t>& rows) {
  const Composition& composition = gas.composition;
  if (!composition.is_mixture()) {
    const auto other =
        std::find_if(initial.species.begin(), initial.species.end(),
                     [&](SpeciesIndex index) { return index != initial.species.front(); });
    if (other == initial.species.end()) return;
    throw InputError(
        fmt::format("state: needles of species {} and {}: expected a scene with as many "
                    "[[species]]",
                    initial.species.front(), *other));
  }
  if (initial.species.empty()) {
    std::size_t i = 0;
    for (std::size_t index = 0; index < composition.size(); ++index) {
      for (std::uint64_t n = 0; n < composition[index].count; ++n) {
        gas.records[i++].species = static_cast<SpeciesIndex>(index);
      }
    }
    return;
  }
  check_size(initial.species.size(), initial.size(), "species");
  std::vector<std::uint64_t> counts(composition.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SpeciesIndex index = initial.species[rows[i]];
    if (index >= composition.size()) {
      throw InputError(fmt::format("state: needle {}: species = {}: expected an index below {}",
                                   gas.ids[i].value, index, composition.size()));
    }
    ++counts[index];
    gas.records[i].species = index;
  }
  for (std::size_t index = 0; index < composition.size(); ++index) {
    if (counts[index] == composition[index].count) continue;
    throw InputError(fmt::format("state: {} needles of species {}: expected {}, as in the scene",
                                 counts[index], composition[index].name, composition[index].count));
  }
}

// Gives each needle its body, where those of a species differ, larger than it is by this factor.
void set_own_bodies(Gas& gas, const Composition& composition, double larger, const State& initial,
                    const std::vector<std::size_t>& rows) {
  const std::vector<BodyNumbers> bodies = own_bodies_of(composition, initial);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    gas.own_bodies[i] = bodies[rows[i]];
    gas.own_bodies[i].length *= larger;
    gas.own_bodies[i].diameter *= larger;
  }
}

// The rate of a scene is that of the mean diameter of bodies, in the mean thermal speed.
void let_grow(Gas& gas, const Scene& scene, const GrowthPlan& plan) {
  double squares = 0, diameters = 0;
  for (Needle i{0}; i < gas.size(); ++i) {
    const Vec3d& v = gas.records[i].flight.v;
    squares += gas.body(i).mass * dot(v, v);
    diameters += 2 * gas.radius(i);
  }
  const double speed = std::sqrt(squares / (3 * gas.mass()));
  if (!(speed > 0)) {
    throw InputError(fmt::format(
        "{}: expected bodies that move, as it counts in their thermal speed at the start",
        place_of(scene, "driving.growth.rate", fmt::to_string(scene.driving.growth->rate))));
  }
  // Of a scene that starts from a file, nobody knew it before.
  if (!(plan.largest > plan.start) && plan.end == Stop::grown) {
    throw InputError(
        fmt::format("{}: expected more than the packing fraction at the start",
                    place_of(scene, "driving.growth.until_packing",
                             fmt::to_string(scene.driving.growth->until_packing.value_or(1)))));
  }
  const double mean_diameter = diameters / static_cast<double>(gas.size());
  gas.growth.emplace(plan.start / plan.largest, scene.driving.growth->rate * speed / mean_diameter);
}

// That fixed needles are at rest.
void require_fixed_at_rest(const Gas& gas) {
  if (!gas.composition.has_fixed()) return;
  for (Needle i{0}; i < gas.size(); ++i) {
    if (!gas.is_fixed(i)) continue;
    const kernels::Flight& flight = gas.records[i].flight;
    for (const auto& [what, value] :
         {std::pair("velocity", flight.v), std::pair("angular velocity", flight.w)}) {
      if (!(value == Vec3d{})) refuse_vector(value, what, gas.ids[i], "0, as its species is fixed");
    }
  }
}

// That tips are inside the walls, as they are at the start, to within rounding.
void require_inside(const Scene& scene, const Gas& gas) {
  const std::array<Gap, 3> gaps = gaps_of(scene);
  const std::vector<Scene::WallSide> walls = scene.wall_sides();
  if (walls.empty()) return;
  for (Needle i{0}; i < gas.size(); ++i) {
    const Record& record = gas.records[i];
    const Vec3d &r = record.flight.r, &u = record.flight.u;
    const std::array<double, 3> centre = {r.x, r.y, r.z}, director = {u.x, u.y, u.z};
    const double scale = gas.scale_at({});
    const double half = scale * gas.half_length(i) / std::hypot(u.x, u.y, u.z);
    for (const Scene::WallSide& side : walls) {
      Gap wall = gaps[side.axis];
      (side.is_high ? wall.has_low : wall.has_high) = false;
      const double reach = half * std::abs(director[side.axis]) + scale * gas.radius(i);
      const double beyond = wall.beyond(centre[side.axis], reach, gas.box.edge(side.axis));
      if (beyond <= gas.touch_tolerance()) continue;
      throw InputError(fmt::format(
          "state: needle {}: a tip is {:.3g} beyond the wall {}-{}: expected both inside{}",
          gas.ids[i].value, beyond, "xyz"[side.axis], side.is_high ? "high" : "low",
          shakes(scene.walls[side.entry]) ? ", where walls.motion.phase puts it at the start"
                                          : ""));
    }
  }
}

// How far a wall comes into the box [L], and the key that says so.
struct Advance {
  double distance = 0;
  const char* key = "";
  double value = 0;
};
Advance advance_of(const Scene::WallMotion& motion, bool is_high, double edge) {
  if (!motion.velocity) return {motion.amplitude, "walls.motion.amplitude", motion.amplitude};
  if (is_high == (*motion.velocity > 0)) return {};
  if (!motion.stop_at) {
    return {std::numeric_limits<double>::infinity(), "walls.motion.velocity", *motion.velocity};
  }
  const double stop = *motion.stop_at;
  return {is_high ? edge - stop : stop, "walls.motion.stop_at", stop};
}

// That no wall moves as far as to where a needle is fixed.
void require_fixed_out_of_the_way(const Scene& scene, const Gas& gas) {
  if (!gas.composition.has_fixed()) return;
  for (const Scene::WallSide& side : scene.wall_sides()) {
    const auto& motion = scene.walls[side.entry].motion;
    if (!motion) continue;
    const double edge = gas.box.edge(side.axis);
    const Advance advance = advance_of(*motion, side.is_high, edge);
    for (Needle i{0}; i < gas.size(); ++i) {
      if (!gas.is_fixed(i)) continue;
      const Vec3d& u = gas.records[i].flight.u;
      const double half = gas.half_length(i) / std::hypot(u.x, u.y, u.z);
      const double reach = half * std::abs(to_array(u)[side.axis]) + gas.radius(i);
      const double centre = to_array(gas.records[i].flight.r)[side.axis];
      const double room = (side.is_high ? edge - centre : centre) - reach;
      if (advance.distance <= room + gas.touch_tolerance()) continue;
      const bool is_piston = motion->velocity.has_value();
      throw InputError(fmt::format(
          "{}: expected {} of at {} {:.10g}, where needle {} is fixed",
          place_of(scene, key_of_entry(advance.key, side.entry), fmt::to_string(advance.value)),
          !is_piston || motion->stop_at ? "one" : "a motion.stop_at",
          is_piston && side.is_high ? "least" : "most",
          is_piston && side.is_high ? edge - room : room, gas.ids[i].value));
    }
  }
}

// That no two rods overlap but by rounding, and that smooth spheres do not turn.
void require_room_for_rods(const Gas& gas) {
  if (!gas.composition.has_width()) return;
  std::vector<RodShape> shapes;
  for (Needle i{0}; i < gas.size(); ++i) shapes.push_back(shape_of(gas, i, {}));
  RodGrid grid(gas.composition, shapes, gas.box_at({}));
  std::size_t pairs = 0;
  RodGrid::Overlap worst{};
  std::array<std::uint32_t, 2> worst_ids{};
  for (Needle i{0}; i < gas.size(); ++i) {
    StopRequest::check_in_turn(i);
    const Record& record = gas.records[i];
    if (!gas.body(i).turns() && !(record.flight.w == Vec3d{})) {
      refuse_vector(record.flight.w, "angular velocity", gas.ids[i],
                    "0, as a smooth sphere does not turn");
    }
    const std::array<double, 3> centre = to_array(record.flight.r),
                                director = to_array(record.flight.u);
    for (const RodGrid::Overlap& overlap :
         grid.overlaps(centre, director, shapes[i], gas.touch_tolerance())) {
      ++pairs;
      if (pairs > 1 && overlap.expected - overlap.distance <= worst.expected - worst.distance)
        continue;
      worst = overlap;
      worst_ids = {gas.ids[Needle(overlap.other)].value, gas.ids[i].value};
    }
    grid.enter(centre, director, shapes[i]);
  }
  if (pairs == 0) return;
  throw InputError(
      fmt::format("state: {}rods {} and {} overlap: their axes are {:.4g} apart, less than {:.10g}",
                  pairs == 1 ? "" : fmt::format("{} pairs of rods overlap; deepest, ", pairs),
                  worst_ids[0], worst_ids[1], worst.distance, worst.expected));
}

}  // namespace

void set_gravity(Gas& gas, const Scene& scene) {
  gas.gravity = vector_of(scene.forces.gravity);
  gas.falls = !(gas.gravity == Vec3d{});
  const auto along_periodic = [&](double g, std::size_t axis) {
    return gas.box.is_periodic(axis) ? g : 0;
  };
  gas.pull = {along_periodic(gas.gravity.x, 0), along_periodic(gas.gravity.y, 1),
              along_periodic(gas.gravity.z, 2)};
}

void set_shear(Gas& gas, const Scene& scene, double slide) {
  if (scene.shear) gas.shear.emplace(scene.shear->rate, gas.box.edges(), slide);
}

namespace {

// The slide at the start, which scene or state may say, or both.
double slide_of(const Scene& scene, const State& initial) {
  const double given = scene.shear ? scene.shear->offset : 0, edge = initial.box[0];
  if (!scene.shear && (initial.slide != 0 || initial.shear_rate != 0)) {
    throw InputError(fmt::format(
        "state: its rows of boxes have slid by {:.10g}, at a shear rate of {:.10g}: expected a "
        "scene with [shear]",
        initial.slide, initial.shear_rate));
  }
  if (!(initial.slide >= 0 && (initial.slide < edge || initial.slide == 0))) {
    throw InputError(fmt::format("state: slide = {}: expected a length from 0 to below {:.10g}",
                                 initial.slide, edge));
  }
  if (given != 0 && initial.slide != 0 && std::abs(given - initial.slide) > 1e-12 * edge) {
    throw InputError(fmt::format("{}: expected {}, as in the state, or none",
                                 place_of(scene, "shear.offset", fmt::to_string(given)),
                                 initial.slide));
  }
  return initial.slide != 0 ? initial.slide : given;
}

// Velocities in the laboratory. Those of a state in another flow, or of one that says only these,
// are those beside its flow and that of the scene.
std::vector<std::array<double, 3>> velocities_of(const Gas& gas, const State& initial) {
  const double rate = gas.shear ? gas.shear->rate() : 0;
  const bool by_peculiar = initial.velocity.empty() && !initial.peculiar_velocity.empty();
  const bool other_flow =
      initial.shear_rate != 0 && std::abs(initial.shear_rate - rate) > 1e-12 * std::abs(rate);
  auto out = by_peculiar ? initial.peculiar_velocity : initial.velocity;
  if (out.size() != initial.size()) return out;
  const double more = by_peculiar ? rate : other_flow ? rate - initial.shear_rate : 0;
  if (more == 0) return out;
  for (std::size_t i = 0; i < out.size(); ++i) out[i][0] += more * initial.position[i][1];
  return out;
}

}  // namespace

// Momentum along y would carry needles to where the flow is faster, all the time.
void require_steady_flow(const Scene& scene, const Gas& gas, std::string_view what,
                         const std::function<double(Needle)>& velocity_y) {
  if (!keeps_drift(scene)) return;
  constexpr double most = 0x1p-20;  // beyond what rounding to single precision does
  double sum = 0, size = 0;
  for (Needle i{0}; i < gas.size(); ++i) {
    const double momentum = gas.body(i).mass * velocity_y(i);
    sum += momentum;
    size += std::abs(momentum);
  }
  if (std::abs(sum) <= most * size) return;
  throw InputError(fmt::format(
      "{}: a total momentum of {:.6g} along y, across the flow of [shear]: expected 0 to within "
      "rounding, as it would make that along x grow for ever; subtract {:.17g} from the velocities "
      "along y",
      what, sum, sum / total_mass(gas.composition)));
}

Gas make_gas(const Scene& scene, const State& initial) {
  const std::size_t count = initial.size();
  check_size(initial.orientation.size(), count, "orientation");
  check_size(initial.angular_velocity.size(), count, "angular velocity");
  if (!initial.image.empty()) check_size(initial.image.size(), count, "image");
  if (!initial.id.empty()) check_size(initial.id.size(), count, "id");
  Gas gas;
  gas.box = Box(initial.box, scene.periodic());
  gas.moving_edges = moving_edges_of(scene, initial.box);
  set_gravity(gas, scene);
  set_shear(gas, scene, slide_of(scene, initial));
  const auto velocities = velocities_of(gas, initial);
  check_size(velocities.size(), count, "velocity");
  const Composition composition = composition_of(scene, initial);
  GrowthPlan growth;
  if (scene.driving.growth) growth = growth_plan(scene, composition, initial.box);
  gas.set_composition(growth.largest == 1 ? composition : enlarged(composition, growth.largest));
  const double length = gas.longest;
  const Room room(scene);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double edge = initial.box[axis];
    if (!room.holds(edge, axis)) {
      throw InputError(fmt::format("state: box edge {}: expected from {:.10g} to {:.10g}", edge,
                                   room.least(axis), room.most()));
    }
  }
  if (is_too_sparse(initial.box, static_cast<double>(count), length)) {
    throw InputError(fmt::format("state: box edges {}, {}, {} for {} needles: expected {}",
                                 initial.box[0], initial.box[1], initial.box[2], count,
                                 not_too_sparse));
  }
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!initial.id.empty()) {
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return initial.id[a] < initial.id[b]; });
  }
  gas.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    StopRequest::check_in_turn(i);
    const std::size_t from = order[i];
    kernels::Flight& flight = gas.records[i].flight;
    flight.r = vector_of(initial.position[from]) - vector_of(initial.low);
    flight.v = vector_of(velocities[from]);
    flight.u = vector_of(initial.orientation[from]);
    flight.w = vector_of(initial.angular_velocity[from]);
    gas.ids[i] = {initial.id.empty() ? static_cast<std::uint32_t>(i) : initial.id[from]};
    if (i > 0 && gas.ids[i] == gas.ids[i - 1]) {
      throw InputError("state: id " + std::to_string(gas.ids[i].value) +
                       " twice: expected distinct ids");
    }
    if (!initial.image.empty()) gas.images[i] = initial.image[from];
    check_vector(flight.r, "position", gas.ids[i]);
    check_image(gas, Needle(i));
    check_vector(flight.v, "velocity", gas.ids[i]);
    check_vector(flight.u, "orientation", gas.ids[i]);
    check_vector(flight.w, "angular velocity", gas.ids[i]);
    if (flight.u == Vec3d{})
      refuse_vector(flight.u, "orientation", gas.ids[i], "one that is not 0");
  }
  set_species(gas, initial, order);
  set_own_bodies(gas, composition, growth.largest, initial, order);
  if (scene.driving.growth) let_grow(gas, scene, growth);
  require_fixed_at_rest(gas);
  require_steady_flow(scene, gas, "state", [&](Needle i) { return gas.records[i].flight.v.y; });
  require_inside(scene, gas);
  require_fixed_out_of_the_way(scene, gas);
  require_room_for_rods(gas);
  return gas;
}

}  // namespace needlework
