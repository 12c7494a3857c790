// Draws initial states: needles at once, rods of finite width where there is room for them.
#include "src/engine/drawn_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "needlework/simulation.h"
#include "src/box/box.h"
#include "src/machine/stop_request.h"
#include "src/physics/vectors.h"
#include "src/scene/check.h"
#include "src/scene/confinement.h"
#include "src/scene/drawing.h"
#include "src/scene/growth_plan.h"
#include "src/scene/rod_room.h"
#include "src/scene/validity.h"

namespace needlework {
namespace {

constexpr std::uint64_t most_tries = 1000000;  // of one rod
// Beyond so many tries of each rod, a lattice is quicker.
constexpr double tries_by_choice = 100;
// And so many where there is no lattice.
constexpr double tries_without_choice = 10000;

double volume_of(const Scene& scene) {
  const auto& box = scene.needles.box;
  return box[0] * box[1] * box[2];
}

double packing_fraction(const Scene& scene) {
  return scene.composition().packing_fraction(volume_of(scene));
}

// Collisions per rod after which parallel rods have forgotten their order; measured for rods of
// five diameters, whose order falls by e in 25 and 150 collisions at packing fractions of 0.2 and
// 0.31.
double collisions_to_forget(const Scene& scene) { return packing_fraction(scene) > 0.2 ? 400 : 60; }

RodOrder order_of(const Scene& scene) {
  return scene.initial.packing == "crossed" ? RodOrder::crossed : RodOrder::parallel;
}

std::string place_of_packing(const Scene& scene) {
  return place_of(scene, "initial.packing", fmt::format("\"{}\"", scene.initial.packing));
}

double tries_of(const Scene& scene) {
  return estimated_tries(scene.composition(), volume_of(scene));
}

// Whether inserting rods would take far longer than it may. The estimate is that of a fluid, in
// which rods find more room.
bool is_hopeless(const Scene& scene) { return tries_of(scene) > 100 * tries_without_choice; }

// Thin needles take up no room, and fixed bodies would have to move.
bool may_grow(const Composition& composition) {
  return composition.has_width() && !composition.is_partly_thin() && !composition.has_fixed();
}

void require_growable(const Scene& scene) {
  const Composition composition = scene.composition();
  if (may_grow(composition)) return;
  throw InputError(fmt::format("{}: expected bodies with a diameter, none of them fixed: {}",
                               place_of_packing(scene),
                               composition.has_fixed() ? "those that grow push each other about"
                                                       : "thin needles find room anywhere"));
}

// From the sizes at which bodies begin that grow to those of the scene: few tries insert them, at
// not too high a packing fraction. A share of these sizes.
double share_at_start(const Scene& scene) {
  constexpr double few_tries = 8, most_packing = 0.25;
  const Composition composition = scene.composition();
  const double volume = volume_of(scene);
  double low = 0, high = std::min(0.99, std::cbrt(most_packing / packing_fraction(scene)));
  if (estimated_tries(enlarged(composition, high), volume) <= few_tries) return high;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    (estimated_tries(enlarged(composition, middle), volume) <= few_tries ? low : high) = middle;
  }
  return low;
}

// Of the mean diameter, in thermal speeds; spheres that grow ten times as slowly get from 0.644 to
// 0.651 before they jam.
constexpr double rate_of_growth = 0.01;

// Collisions of a body while it grows: heat per growth is that of the pressure, and heat per
// collision that of the rate.
double collisions_to_grow(const Scene& scene) {
  constexpr int steps = 64;
  constexpr double heat_of_collisions = 0.6;
  const Composition composition = scene.composition();
  const double from = std::log(share_at_start(scene));
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double scale = std::exp(from * (i + 0.5) / steps);
    sum += estimated_pressure(enlarged(composition, scale), volume_of(scene)) - 1;
  }
  return 2 * sum * (-from / steps) / (heat_of_collisions * rate_of_growth);
}

void require_insertable(const Scene& scene) {
  if (!is_hopeless(scene)) return;
  throw InputError(fmt::format(
      "{}: at a packing fraction of {:.4g} a rod would find no place in {} tries: expected "
      "\"lattice\", or a larger box",
      place_of_packing(scene), packing_fraction(scene), most_tries));
}

[[noreturn]] void refuse_lattice(const Scene& scene) {
  const Composition composition = scene.composition();
  const bool spheres = composition.are_spheres();
  throw InputError(fmt::format(
      "{}: no lattice of {} has room for {} {} at a packing fraction of {:.4g}: expected a larger "
      "box, or edges that fit {} better",
      place_of_packing(scene),
      order_of(scene) == RodOrder::crossed ? "crossed blocks"
      : spheres                            ? "spheres"
                                           : "parallel rods",
      composition.count(), spheres ? "spheres" : "rods", packing_fraction(scene),
      spheres ? "them" : "the rods"));
}

// With a second wall along each axis that has one, as nothing holds the gas to the first without
// gravity.
Scene closed(Scene scene) {
  const std::array<Gap, 3> gaps = gaps_of(scene);
  for (const Scene::WallSide& side : scene.wall_sides()) {
    if (gaps[side.axis].is_open()) scene.walls[side.entry].side = "both";
  }
  return scene;
}

// Elastic collisions of rods, with nothing else that a scene may call for.
Scene elastic(const Scene& scene, const State& state) {
  Scene out = closed(scene);
  out.initial = {};
  out.collisions = {};
  std::erase_if(out.pairs, [](const Scene::Pair& pair) { return pair.meet; });
  out.forces = {};
  out.driving = {};
  out.output = {};
  if (out.shear) out.shear->rate = 0;  // a box that is tilted as the scene's is at its start
  for (Scene::Wall& wall : out.walls) {
    wall.epsilon = 1;
    wall.temperature.reset();
    // As good as at rest, where it is at the start.
    if (!wall.motion) continue;
    const bool shakes = wall.motion->amplitude > 0;
    if (shakes) wall.motion->frequency = 1e-100;
    if (!shakes) wall.motion.reset();
  }
  for (Species& each : out.species) each.t_tr = each.t_rot = 1;
  // Which parts find the trajectory changes no bit of it, and those of the scene may be slow.
  out.engine.search = out.engine.queue = "auto";
  out.engine.cell_side.reset();
  out.engine.capsule_radius.reset();
  out.needles.count = state.size();
  return out;
}

// The state, with velocities of the scene.
State drawn_from(const Simulation& simulation, const Scene& scene) {
  State out;
  simulation.copy(out);
  out.image.clear();
  out.id.clear();
  draw_velocities(scene, out);
  return out;
}

// Whether two rods that touch where they have last collided approach each other, in a state in
// order of id.
bool approach(const State& state, const Collision& last) {
  const std::size_t a = last.first, b = last.second;
  const auto arm = [&](std::size_t i, double length) {
    const Vec3d u = vector_of(state.orientation[i]);
    return std::pair(u * length, cross(vector_of(state.angular_velocity[i]), u) * length);
  };
  const auto [first, turns_first] = arm(a, last.arm_first);
  const auto [second, turns_second] = arm(b, last.arm_second);
  const Vec3d apart = vector_of(state.position[a]) - vector_of(state.position[b]);
  const Box box = box_of(state);
  const Image<double> image = box.image(box.nearest(apart));
  const Vec3d velocity =
      vector_of(state.velocity[a]) - vector_of(state.velocity[b]) - image.velocity;
  return dot(apart - image.place + first - second, velocity + turns_first - turns_second) < 0;
}

void add_flow(const Scene& scene, State& state) {
  const Shear shear(scene.shear->rate, scene.needles.box, scene.shear->offset);
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.velocity[i][0] += shear.rate() * state.position[i][1];
  }
}

// A lattice has images that have not slid: these slide, as fast as the rods move, to where the
// scene has them.
State slid(const Scene& scene, State state) {
  Scene sliding = elastic(scene, state);
  sliding.shear = Scene::Shear{.rate = 1 / scene.needles.box[1]};
  draw_velocities(sliding, state);
  add_flow(sliding, state);
  Simulation simulation(sliding, state);
  Scene::Until until;
  until.time = scene.shear->offset;
  until.wall_s = 0.1;
  while (simulation.advance(until) == Stop::wall_time) StopRequest::check();
  State out = drawn_from(simulation, scene);
  out.slide = scene.shear->offset;
  out.shear_rate = 0;
  out.peculiar_velocity.clear();
  return out;
}

// Moves bodies by elastic collisions. `doing` is what whoever asks is told meanwhile.
State stirred(const Scene& scene, State state, double collisions_per_rod, const char* doing) {
  const Scene still = elastic(scene, state);
  draw_velocities(still, state);
  Simulation simulation(still, state);
  std::optional<Collision> last;
  simulation.on_collision([&](const Collision& collision) { last = collision; });
  // In parts, after which whoever asks for it may stop the drawing.
  Scene::Until until;
  until.collisions_per_needle = collisions_per_rod;
  until.wall_s = 0.1;
  // Bodies that hardly ever meet, or never, need not be moved on for ever.
  constexpr double times_as_long = 100;
  const double by_then = times_as_long * collisions_per_rod * simulation.mean_free_time();
  until.time = std::isfinite(by_then) ? by_then : 0;
  while (simulation.advance(until) == Stop::wall_time) {
    const auto rods = static_cast<double>(simulation.needles());
    StopRequest::check(
        {doing, 2 * static_cast<double>(simulation.collisions()) / (collisions_per_rod * rods)});
  }
  State out = drawn_from(simulation, scene);
  // By its new velocities, the pair of the last collision would begin the run with another one.
  if (last && approach(out, *last)) {
    until.collisions_per_needle.reset();
    until.time = simulation.time() + 0.5 * simulation.mean_free_time();
    while (simulation.advance(until) == Stop::wall_time) StopRequest::check();
    out = drawn_from(simulation, scene);
  }
  return out;
}

DrawnState melted(const Scene& scene, State state, RodOrder order, double collisions_per_rod) {
  DrawnState out{stirred(scene, std::move(state), collisions_per_rod, "moving rods from a lattice"),
                 {}};
  out.placement = fmt::format(
      "{} rods placed {}, then moved in {} elastic collisions per rod", out.state.size(),
      order == RodOrder::parallel ? "on a lattice" : "in crossed blocks", collisions_per_rod);
  return out;
}

// The largest eigenvalue of the mean of (3 u u - 1) / 2 over directors u.
double nematic_order(const State& state) {
  std::array<std::array<double, 3>, 3> q{};
  for (const auto& u : state.orientation) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) q[a][b] += 1.5 * u[a] * u[b];
  }
  double squares = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      q[a][b] = q[a][b] / static_cast<double>(state.size()) - (a == b ? 0.5 : 0);
      squares += q[a][b] * q[a][b];
    }
  }
  const double size = std::sqrt(squares / 6);
  if (size == 0) return 0;
  double determinant = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    determinant +=
        q[0][a] * (q[1][(a + 1) % 3] * q[2][(a + 2) % 3] - q[1][(a + 2) % 3] * q[2][(a + 1) % 3]);
  }
  const double half = std::clamp(0.5 * determinant / (size * size * size), -1.0, 1.0);
  return 2 * size * std::cos(std::acos(half) / 3);
}

// Bodies are inserted smaller than they are, and grow while they collide.
DrawnState grown(const Scene& scene) {
  // Collisions of each after it has grown, in which it forgets how.
  constexpr double collisions_to_forget = 20;
  const double share = share_at_start(scene);
  Insertion rods = insert_rods(closed(scene), most_tries, static_cast<double>(most_tries), share);
  if (rods.placed < rods.state.size()) {
    throw InputError(
        fmt::format("{}: a body of {:.4g} of its size found no place in {} tries: "
                    "expected a larger box",
                    place_of_packing(scene), share, most_tries));
  }
  Scene growing = elastic(scene, rods.state);
  growing.driving.growth = Scene::Growth{};
  Scene::Growth& growth_of_scene = *growing.driving.growth;
  growth_of_scene.rate = rate_of_growth;
  growth_of_scene.cool_every = 4;
  growth_of_scene.from = share;
  draw_velocities(growing, rods.state);
  Simulation simulation(growing, rods.state);
  Scene::Until until;
  until.wall_s = 0.1;
  Stop stop;
  while ((stop = simulation.advance(until)) == Stop::wall_time) {
    const double scale = simulation.growth()->scale;
    StopRequest::check({"growing bodies", (scale - share) / (1 - share)});
  }
  const GrowthTotals growth = *simulation.growth();
  if (stop != Stop::grown) {
    throw InputError(fmt::format(
        "{}: bodies that grow jam at a packing fraction of {:.4g}, where P V / (N T) is {:.3g}, "
        "before they come to {:.4g}: expected a larger box",
        place_of_packing(scene), growth.packing_fraction, growth.pressure,
        packing_fraction(scene)));
  }
  const double collisions =
      2 * static_cast<double>(simulation.collisions()) / static_cast<double>(simulation.needles());
  State state;
  simulation.copy(state);
  state.image.clear();
  state.id.clear();
  state.own_bodies = rods.state.own_bodies;
  DrawnState out{stirred(scene, std::move(state), collisions_to_forget, "moving bodies"), {}};
  out.placement =
      fmt::format("{} bodies inserted at {:.3g} of their sizes, grown in {:.4g} collisions each",
                  out.state.size(), share, collisions);
  if (!scene.composition().are_spheres())
    out.placement += fmt::format(" to a nematic order of {:.3g}", nematic_order(out.state));
  return out;
}

// Nothing where that takes more tries a rod.
std::optional<DrawnState> inserted(const Scene& scene, double most_tries_on_average) {
  Insertion rods = insert_rods(scene, most_tries, most_tries_on_average);
  if (rods.placed < rods.state.size()) return std::nullopt;
  DrawnState out{std::move(rods.state), {}};
  draw_velocities(scene, out.state);
  const auto placed = static_cast<double>(std::max<std::uint64_t>(1, rods.placed));
  out.placement = fmt::format("{} rods inserted one by one, in {:.3g} tries each", rods.placed,
                              static_cast<double>(rods.tries) / placed);
  return out;
}

// With velocities beside the flow.
DrawnState draw_in_flow(const Scene& scene) {
  if (!scene.composition().has_width()) return {draw_needles(scene), {}};
  const std::string& packing = scene.initial.packing;
  if (packing == "insertion") {
    require_insertable(scene);
    if (auto state = inserted(scene, most_tries)) return std::move(*state);
    throw InputError(
        fmt::format("{}: a rod found no place in {} tries: expected \"lattice\", or a "
                    "larger box",
                    place_of_packing(scene), most_tries));
  }
  if (packing == "compress") {
    require_growable(scene);
    return grown(scene);
  }
  if (packing == "auto" && !is_hopeless(scene)) {
    if (auto state = inserted(scene, tries_by_choice)) return std::move(*state);
  }
  if (auto lattice = place_rods_on_lattice(scene, order_of(scene))) {
    if (scene.shear && scene.shear->offset > 0) *lattice = slid(scene, std::move(*lattice));
    return melted(scene, std::move(*lattice), order_of(scene), collisions_to_forget(scene));
  }
  if (packing == "auto" && may_grow(scene.composition())) return grown(scene);
  if (packing == "auto" && !is_hopeless(scene)) {
    if (auto state = inserted(scene, tries_without_choice)) return std::move(*state);
  }
  refuse_lattice(scene);
}

}  // namespace

DrawnState draw_state(const Scene& scene) {
  require_valid(scene, drawable);
  DrawnState out = draw_in_flow(scene);
  if (scene.shear) add_flow(scene, out.state);
  return out;
}

PlannedPlacement plan_placement(const Scene& scene) {
  require_valid(scene, drawable);
  const double tries = tries_of(scene);
  const std::string& packing = scene.initial.packing;
  if (packing == "insertion") require_insertable(scene);
  const auto grown = [&] {
    return PlannedPlacement{.way = PlannedPlacement::Way::grown,
                            .collisions = collisions_to_grow(scene)};
  };
  if (packing == "compress") {
    require_growable(scene);
    return grown();
  }
  if (packing == "insertion" || (packing == "auto" && tries <= tries_by_choice))
    return {.tries = tries};
  if (place_rods_on_lattice(scene, order_of(scene)))
    return {.way = PlannedPlacement::Way::on_lattice, .collisions = collisions_to_forget(scene)};
  if (packing == "auto" && may_grow(scene.composition())) return grown();
  if (packing != "auto" || is_hopeless(scene)) refuse_lattice(scene);
  return {.tries = std::min(tries, tries_without_choice)};
}

State draw_initial_state(const Scene& scene) { return draw_state(scene).state; }

}  // namespace needlework
