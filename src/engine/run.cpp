#include "src/engine/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_set>
#include <utility>

#include "kernels/in_parallel.h"
#include "needlework/error.h"
#include "src/effects/driving/andersen.h"
#include "src/effects/walls/walls.h"
#include "src/engine/exact_sums.h"
#include "src/engine/present_state.h"
#include "src/engine/space_order.h"
#include "src/machine/stop_request.h"
#include "src/scene/accuracy.h"
#include "src/scene/box_edges.h"
#include "src/scene/check.h"
#include "src/scene/confinement.h"
#include "src/scene/growth_plan.h"
#include "src/scene/observable_names.h"

namespace needlework {
namespace {

bool is_at_rest(const Record& record) {
  return record.flight.v == Vec3d{} && record.flight.omega == 0;
}

// The walls in the order in which reports count them.
std::vector<Wall> walls_of(const Scene& scene, const Gas& gas) {
  const Box& box = gas.box;
  const std::optional<MovingEdges>& moving = gas.moving_edges;
  std::vector<Wall> out;
  for (const Scene::WallSide& side : scene.wall_sides()) {
    const Scene::Wall& given = scene.walls[side.entry];
    Wall& wall = out.emplace_back();
    wall.plane.axis = static_cast<int>(side.axis);
    wall.plane.normal = side.is_high ? -1 : 1;
    wall.plane.place = side.is_high ? box.edge(side.axis) : 0;
    wall.epsilon = given.epsilon;
    wall.temperature = given.temperature.value_or(0);
    if (!given.motion) continue;
    if (moving) wall.edge = moving->of(side.axis, side.is_high);
    if (given.motion->tangential) {
      // Along the two other axes, in their order.
      const auto [first, second] = *given.motion->tangential;
      wall.sliding = side.axis == 0   ? Vec3d{0, first, second}
                     : side.axis == 1 ? Vec3d{first, 0, second}
                                      : Vec3d{first, second, 0};
    }
    wall.plane.amplitude = given.motion->amplitude;
    wall.plane.frequency = given.motion->frequency;
    const double turns = given.motion->phase / (2 * std::numbers::pi);
    wall.turns = turns - std::floor(turns);
  }
  return out;
}

// Needles clatter on walls as they bounce on each other. Where those slide, hits of walls have the
// t_c rule, with the threshold of contacts as t_c.
bool slides_beside_walls(const Scene& scene) {
  return scene.collisions.sliding && !scene.walls.empty();
}

bool has_contact_time(const Scene& scene) {
  return scene.collisions.tc || scene.collisions.tc_relative || slides_beside_walls(scene);
}

// Of the box, at the mean speed and by falling; infinite where nothing moves.
double crossing_time(const Gas& gas, const std::vector<SumsOfSquares>& sums) {
  double square = 0;  // of the speed
  for (const SumsOfSquares& sum : sums) square += sum.v2 / static_cast<double>(gas.size());
  const double edge = gas.box.longest_edge();
  square += edge * std::sqrt(dot(gas.gravity, gas.gravity));
  return square > 0 ? edge / std::sqrt(square) : std::numeric_limits<double>::infinity();
}

}  // namespace

Effects effects_of(const Scene& scene) {
  const Composition composition = scene.composition();
  const std::optional<std::size_t> only = composition.only();
  return {
      .rough = composition.is_rough(),
      .contact_time = scene.collisions.tc || scene.collisions.tc_relative,
      .table = !only || !is_unit(composition[*only]),
      .passing = !composition.all_meet(),
      .width = composition.has_width(),
      .spheres = composition.has_width() && composition.are_spheres(),
      .mixed = composition.is_partly_thin(),
      .sliding = scene.collisions.sliding,
      .kicks = scene.driving.kicks.has_value(),
      .gravity = has_gravity(scene),
      .shear = scene.shear.has_value(),
      .stress = scene.shear || std::ranges::find(scene.output.observables, pressure_tensor_name) !=
                                   scene.output.observables.end(),
      .growth = scene.driving.growth.has_value()};
}

Run::Run(const Scene& scene)
    : accuracy(accuracy_of(scene.engine)),
      effects(effects_of(scene)),
      sorted(scene.engine.storage != "by-id"),
      tc_(scene.collisions.tc),
      tc_relative_(slides_beside_walls(scene) ? scene.collisions.sliding_below
                                              : scene.collisions.tc_relative) {
  const Composition composition = scene.composition();
  gas.set_composition(
      scene.driving.growth
          ? enlarged(composition, growth_plan(scene, composition, scene.needles.box).largest)
          : composition);
}

void Run::add_effects(const Scene& scene) {
  const auto is_observed = [&](std::string_view name) {
    return std::ranges::find(scene.output.observables, name) != scene.output.observables.end();
  };
  if (scene.shear && std::ranges::any_of(path_observable_names, is_observed))
    gas.peculiar_x = &gas.columns.add<double>("peculiar x", 0);
  if (has_contact_time(scene)) contact_time_rule.emplace(gas);
  if (effects.sliding) {
    sliding.emplace(gas, Sliding::Parameters{.below = scene.collisions.sliding_below,
                                             .elastic_strikes = scene.collisions.elastic_strikes});
  }
  if (!scene.walls.empty()) {
    ContactTimeOfWalls contact_time_of_walls{contact_time_rule ? &*contact_time_rule : nullptr,
                                             &contact_time, scene.collisions.elastic_strikes};
    if (effects.sliding)
      contact_time_of_walls.advice =
          "a longer collisions.sliding_below helps, unless it rests on the wall";
    add_source(std::make_unique<Walls>(gas, walls_of(scene, gas), scene.needles.seed,
                                       contact_time_of_walls));
  }
  const Scene::Driving& driving = scene.driving;
  if (driving.andersen) {
    add_source(std::make_unique<Andersen>(
        gas, Andersen::Parameters{.rate = driving.andersen->rate,
                                  .temperature = driving.andersen->temperature,
                                  .seed = scene.needles.seed}));
  }
  if (driving.kicks) {
    kicks.emplace(Kicks::Parameters{.every = driving.kicks->every,
                                    .translational = driving.kicks->translational,
                                    .rotational = driving.kicks->rotational,
                                    .seed = scene.needles.seed});
  }
}

void Run::find_last_time(const Scene& scene) {
  if (gas.growth) {
    last_time = gas.growth->end();
    at_last_time = growing->parameters().at_end;
  }
  if (!gas.moving_edges) return;
  if (const auto meeting = meeting_of(scene, gas.box.edges()))
    last_time = gas.clock.add({}, meeting->time);
}

void Run::find_next_instant() {
  Time last = replaces_velocities() ? next_instant() : Time::never();
  if (gas.growth) last = std::min(last, gas.growth->end());
  constexpr double end = std::numeric_limits<double>::infinity();
  search_until_ = {last.epoch, std::nextafter(last.offset, end)};
}

Growing::Parameters Run::parameters_of_growing(const Scene& scene) const {
  // Beyond this pressure, no growth that is worth its time is left.
  constexpr double jammed_at = 1e6, share_heated = 0.01;
  const Scene::Growth& growth = *scene.driving.growth;
  const double cool_every = growth.cool_every.value_or(std::max(1.0, share_heated / growth.rate));
  const double bodies = static_cast<double>(gas.size());
  Growing::Parameters out;
  out.cools = cool_every > 0;
  out.collisions = std::max(1.0, (out.cools ? cool_every : 1) * bodies);
  out.most_pressure = growth.until_pressure.value_or(jammed_at);
  out.at_most = growth.until_pressure ? Stop::pressure : Stop::jammed;
  out.at_end = growth_plan(scene, scene.composition(), gas.box.edges()).end;
  return out;
}

Run::Run(const Scene& scene, Gas initial) : Run(scene) {
  gas = std::move(initial);
  gas.columns.resize(gas.size());
  add_effects(scene);
  if (const auto reason = out_of_range(numbers()); !reason.empty())
    throw InputError("state: " + reason);
  open_window();
  // A body that meets no other one tells time by how long it takes through the box.
  const double span = windows.span();
  gas.set_clock(
      Clock(std::isfinite(span) ? span : crossing_time(gas, sums_of_squares(gas, now, 1))));
  if (gas.shear && !gas.shear->is_followable()) {
    throw InputError(fmt::format(
        "{}: rows of boxes slide by more than 2^31 edges in {:.3g}, a mean free time: expected a "
        "lower rate, or a longer edge along x",
        place_of(scene, "shear.rate", fmt::to_string(scene.shear->rate)),
        gas.clock.epoch_length()));
  }
  for (const auto& source : sources) source->begin(gas);
  if (gas.growth) {
    gas.growth->find_end(gas.clock);
    Growing::Parameters parameters = parameters_of_growing(scene);
    parameters.temperature = totals().t_tr;
    const double free_times = 2 * parameters.collisions / static_cast<double>(gas.size());
    growing.emplace(parameters, free_times * windows.mean_free_time(), gas.clock);
  }
  find_last_time(scene);
  find_next_instant();
  for (Needle i{0}; i < gas.size(); ++i) {
    StopRequest::check_in_turn(i);
    const kernels::Flight flight = gas.records[i].flight;
    renew_record(gas, i, now, {gas.motion(gas.records[i]).centre(0), flight.v, flight.u, flight.w},
                 gas.body(i));
  }
  open_window();
  initial_energy = present_energy();
  work_at_start = work_of_pull(gas, sums_now());
  // Done before search and calendar allocate their memory, which would add to that of sorting.
  if (sorted) reorder(gas, order_in_space(gas, now));
}

void Run::open_window(const std::vector<SumsOfSquares>& sums, double work) {
  expect_energy();
  work_at_opening = work;
  energy_shares.settle(energy, tally);
  energy.open(energy_of(gas, sums), energy_of_motion(gas, sums), tally.energy);
  temperature_integral.note(gas.clock, now, translational_temperature(gas, sums));
  windows.open(mean_free_time_of(gas, sums, now), usual_time_of_events(sums), gas.clock, now);
  set_contact_time();
}

void Run::expect_energy() {
  double temperature = 0;
  for (const auto& source : sources) {
    temperature = std::max(temperature, source->usual_temperature());
  }
  energy.expect(2.5 * temperature * static_cast<double>(gas.size()));
}

// Of kicks, of the crossing of the box, of a fall, and of what the sources say.
double Run::usual_time_of_events(const std::vector<SumsOfSquares>& sums) const {
  double out = kicks ? kicks->every() : std::numeric_limits<double>::infinity();
  if (sources.empty() || gas.size() == 0) return out;
  for (const auto& source : sources) out = std::min(out, source->usual_time());
  return std::min(out, crossing_time(gas, sums));
}

void Run::pass_window() {
  // Walls and gravity make densities that kinetic theory does not know, and growth those of glasses
  // and crystals. The many small bounces of a pair that slides are not counted: they would shorten
  // the mean free time and with it t_c, which
  // would make them smaller still, without end. Nor are crowded ones, where needles slide.
  if ((!gas.box.is_periodic() || gas.growth) && gas.size() > 1) {
    windows.measure(tally.collisions - tally.tc_collisions - tally.sliding.crowded, gas.size(),
                    gas.clock.since_start(now));
  }
  open_window_and_note_drift();
  if (effects.stress)
    stress_batches.pass_window(gas.clock.since_start(now), [&] { return stress_sums(); });
  std::uint64_t events = tally.collisions;
  for (const SourceTally& source : tally.by_source) events += source.events;
  windows.count(events);
}

void Run::open_window_and_note_drift() {
  const std::vector<SumsOfSquares> sums = sums_now();
  const double work = work_beside_events(sums);
  const double by_account = present_energy() + (work - work_at_opening);
  open_window(sums, work);
  energy.note_drift_from(by_account);
}

void Run::set_contact_time() {
  contact_time = tc_ ? *tc_ : tc_relative_ ? *tc_relative_ * windows.mean_free_time() : 0;
}

double Run::energy_drift() const {
  const std::vector<SumsOfSquares> sums = sums_now();
  return energy.drift(energy_of(gas, sums) - (work_beside_events(sums) - work_at_opening),
                      tally.energy);
}

double Run::work_beside_events(const std::vector<SumsOfSquares>& sums) const {
  const double pull = work_of_pull(gas, sums);
  if (!gas.shear) return pull;
  return pull + work_of_flow_in_flights(gas, now, team.threads());
}

StressSums Run::stress_sums() const {
  StressSums out;
  if (gas.size() == 0) return out;
  out.kinetic = carried_in_flights(gas, now, team.threads());
  if (tally.stress.empty()) return out;
  const StressTally& over = tally.stress.front();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      out.kinetic[i][j] += over.kinetic[std::min(i, j)][std::max(i, j)].value();
      out.collisional[i][j] = over.collisional[i][j].value();
    }
  }
  return out;
}

StressTotals Run::stress() const {
  const double volume =
      gas.mean_of_edges(now, [](const Vector& edge) { return edge[0] * edge[1] * edge[2]; });
  const auto between = [&](const StressSums& from, const StressSums& to, double time) {
    return StressTotals::between(from, to, time, volume, gas.box.periodic(),
                                 gas.shear ? gas.shear->rate() : 0);
  };
  StressTotals out = between({}, stress_sums(), gas.clock.since_start(now));
  const auto error = [&](double StressTotals::*number) {
    return stress_batches.error(between, [&](const StressTotals& batch) { return batch.*number; });
  };
  out.shear_stress_error = error(&StressTotals::shear_stress);
  out.viscosity_error = error(&StressTotals::viscosity);
  out.first_normal_difference_error = error(&StressTotals::first_normal_difference);
  out.second_normal_difference_error = error(&StressTotals::second_normal_difference);
  return out;
}

Totals Run::totals() const {
  Totals out = totals_of(gas, now, team.threads());
  out.time = gas.clock.since_start(now);
  out.collisions = tally.collisions;
  out.tc_collisions = tally.tc_collisions;
  return out;
}

EnergyBudget Run::energy_budget() const {
  EnergyBudget out;
  const double needles = static_cast<double>(std::max<std::size_t>(gas.moving(), 1));
  out.pairs = energy_shares.pairs(energy, tally) / needles;
  out.velocities_set = energy_shares.velocities_set() / needles;
  if (kicks) out.kicks = energy_shares.kicks() / needles;
  if (growing) {
    out.growth = energy_shares.growth(energy, tally) / needles;
    out.cooling = energy_shares.cooling() / needles;
  }
  if (!(gas.pull == Vec3d{})) {
    out.gravity = (work_of_pull(gas, sums_now()) - work_at_start) / needles;
  }
  if (gas.shear) {
    const double in_flights = work_of_flow_in_flights(gas, now, team.threads());
    out.shear = (energy_shares.flow(energy, tally) + in_flights) / needles;
  }
  for (std::size_t n = 0; n < sources.size(); ++n) {
    if (sources[n]->kind() == Happening::thermostat) {
      out.thermostat = energy_shares.source(n, energy, tally) / needles;
    }
    if (sources[n]->kind() != Happening::wall) continue;
    for (std::size_t wall = 0; wall < sources[n]->objects(); ++wall) {
      out.walls.push_back(energy_shares.object(first_object[n] + wall, energy, tally) / needles);
    }
  }
  return out;
}

void Run::add_source(std::unique_ptr<EventSource> source) {
  constexpr std::size_t most = std::numeric_limits<decltype(Happening::source)>::max();
  if (sources.size() == most) throw InputError(fmt::format("more than {} sources of events", most));
  first_object.push_back(objects);
  objects += source->objects();
  sources.push_back(std::move(source));
  gas.columns.keep_changes();
  effects.sources = true;
}

GasNumbers Run::numbers() const {
  return numbers_of(gas, sums_of_squares(gas, now, team.threads()),
                    !std::all_of(gas.records.begin(), gas.records.end(), is_at_rest));
}

void Run::require_followable(const std::vector<SumsOfSquares>& sums, bool moves) const {
  if (gas.size() == 0) return;
  if (const auto reason = out_of_range(numbers_of(gas, sums, moves)); !reason.empty())
    throw InputError("set_velocities: " + reason);
  require_images(gas, now);
  const double between = mean_free_time_of(gas, sums, now), least = 0x1p10 * gas.clock.resolution();
  if (between < least) {
    throw InputError(fmt::format(
        "set_velocities: a mean free time of {:.3g}: expected at least {:.3g}, as times of this "
        "run are told apart to {:.3g}: start another simulation of the new state",
        between, least, gas.clock.resolution()));
  }
}

static_assert(length_with_sliding == 1 + 2 * most_departure);

// All contacts end now. One that has been cut before, of which an event is due at this time, has
// been counted: only one of its needles still refers to it.
void Run::count_strikes() {
  std::unordered_set<const Slide*> seen;
  for (Needle i{0}; i < gas.size(); ++i) {
    const Record& record = gas.records[i];
    if (!record.is_sliding() || seen.insert(gas.slides->of(gas.ids[i], record)).second) continue;
    ++tally.sliding.by_strike;
    tally.sliding.time.add(std::max(0.0, gas.clock.difference(now, record.time)));
  }
}

ReplacedRecords Run::replace_velocities(const std::function<Vec3d(Needle)>& velocity,
                                        const std::function<Vec3d(Needle)>& angular_velocity) {
  if (sliding) count_strikes();
  ReplacedRecords replaced;
  for (Needle i{0}; i < gas.size(); ++i) {
    const Record& record = gas.records[i];
    auto& entry = replaced.add(i, record);
    if (record.is_sliding()) sliding->let_go(i, record, now);
    const kernels::BodyState present = gas.present(i, now);
    if (effects.stress) count(flight_carries(gas, i, now), tally);
    if (gas.peculiar_x) (*gas.peculiar_x)[i] += gas.way_beside_flow(i, now);
    entry.wraps = renew_record(
        gas, i, now, {present.r, velocity(i), present.u, angular_velocity(i)}, gas.body(i));
  }
  open_window();
  return replaced;
}

ReplacedRecords Run::set_velocities(const std::function<Vec3d(Needle)>& velocity,
                                    const std::function<Vec3d(Needle)>& angular_velocity) {
  const std::vector<SumsOfSquares> sums = sums_now();
  const double before = energy_by_account(sums);
  temperature_integral.note(gas.clock, now, translational_temperature(gas, sums));
  ReplacedRecords replaced = replace_velocities(velocity, angular_velocity);
  energy_shares.velocities_set(before, energy.at_opening());
  return replaced;
}

bool Run::is_out_of_order() const {
  // Number of cell crossings per needle after which storage is sorted again. Measured: with 6,
  // sorting itself takes 2 % of the time of 1e4 needles; after 24 and more, 1e5 needles have lost
  // their order.
  constexpr std::uint64_t crossings = 12;
  return sorted && tally.counters.crossings - sorted_at_ > crossings * gas.size();
}

std::vector<Needle> Run::sort_storage() {
  ++tally.counters.sorts;
  sorted_at_ = tally.counters.crossings;
  std::vector<Needle> order = order_in_space(gas, now);
  reorder(gas, order);
  return order;
}

ReplacedRecords Run::kick() {
  require_images(gas, now);
  // The energy before, to the last digit.
  open_window_and_note_drift();
  const double before = energy.at_opening();

  const std::uint64_t number = ++kicks_done;
  std::vector<Kicks::Change> changes(gas.size());
  kernels::in_parallel(gas.size(), team.threads(), [&](std::size_t begin, std::size_t end) {
    for (Needle i(begin); i < end; ++i) {
      if (gas.is_fixed(i)) continue;
      changes[i] = kicks->change(gas.ids[i], number, gas.body(i), gas.present(i, now).u);
    }
  });
  // Fixed bodies take up any momentum, so that the sum is not kept; nor is that of no bodies.
  const bool is_kept = !gas.composition.has_fixed() && gas.size() > 0;
  const auto [x, y, z] = exact_sums(gas.records, team.threads(), [&](const Record& record) {
    const Needle i(static_cast<std::size_t>(&record - gas.records.data()));
    if (!is_kept) return std::array{0.0, 0.0, 0.0};
    const Vec3d momentum = changes[i].velocity * gas.body(i).mass;
    return std::array{momentum.x, momentum.y, momentum.z};
  });
  const Vec3d of_all = is_kept ? Vec3d{x, y, z} * (1 / gas.mass()) : Vec3d{};
  find_next_instant();
  ReplacedRecords replaced = replace_velocities(
      [&](Needle i) { return gas.present(i, now).v + (changes[i].velocity - of_all); },
      [&](Needle i) { return gas.present(i, now).w + changes[i].angular_velocity; });
  energy_shares.kicked(before, energy.at_opening());
  if (const auto reason = out_of_range(numbers()); !reason.empty())
    throw InvalidStateError(fmt::format("kick {}: {}", number, reason));
  return replaced;
}

double Run::virial() const {
  const auto& virial = tally.virial;
  const double taken = virial.size() > 1 ? virial.back().value() : 0;
  return virial.empty() ? 0 : virial.front().value() - taken;
}

double Run::temperature_integral_now() const {
  return temperature_integral.at(gas.clock, now, translational_temperature(gas, sums_now()));
}

void Run::measure_growth() {
  growing->measure(gas.clock, now, {tally.collisions, virial(), temperature_integral_now()},
                   static_cast<double>(gas.moving()));
  find_next_instant();
}

ReplacedRecords Run::cool() {
  require_images(gas, now);
  // The energy before, to the last digit.
  open_window_and_note_drift();
  const double before = energy.at_opening();
  const double factor = std::sqrt(growing->parameters().temperature / totals().t_tr);
  gas.growth->count_from(gas.clock, now);
  ReplacedRecords replaced =
      replace_velocities([&](Needle i) { return gas.present(i, now).v * factor; },
                         [&](Needle i) { return gas.present(i, now).w * factor; });
  energy_shares.cooled(before, energy.at_opening());
  return replaced;
}

double Run::next_look_for_jam() const {
  constexpr double collisions_of_a_body = 8;
  if (!gas.moving_edges || !effects.width) return std::numeric_limits<double>::infinity();
  return static_cast<double>(looked_for_jam_.collisions) +
         collisions_of_a_body * static_cast<double>(gas.moving());
}

bool Run::is_jammed() {
  // Elastic bodies grow ever faster. Where times of contacts round by so much of what overlaps may
  // be, they have been seen to overlap by more from 4 on.
  constexpr double most_rounded = 0.25, most_moved = 1e-6, most_flown = 0.1, long_look = 512;
  const JamLook before = std::exchange(looked_for_jam_, {now, tally.collisions});
  const double speed = gas.moving_edges->speed(gas.clock.exact_difference(now, {}));
  const double thermal = std::sqrt(2 * std::max(0.0, present_energy()) / gas.mass());
  const auto has_moved_little = [&](const JamLook& since, double walls) {
    const double elapsed = gas.clock.difference(now, since.time);
    return thermal * elapsed <= most_flown * gas.longest && speed * elapsed <= walls * gas.longest;
  };
  const bool is_rounded = thermal * gas.clock.resolution() > most_rounded * gas.touch_tolerance();
  if (speed > 0 && is_rounded && has_moved_little(before, 1)) return true;
  if (static_cast<double>(tally.collisions - looked_long_for_jam_.collisions) <
      long_look * static_cast<double>(gas.moving()))
    return false;
  const JamLook long_before = std::exchange(looked_long_for_jam_, looked_for_jam_);
  return speed > 0 && has_moved_little(long_before, most_moved);
}

bool Run::nothing_can_happen() const {
  if (gas.size() == 0) return true;
  if (kicks) return false;
  if (!sources.empty()) {
    const auto sets_in_motion = [](const auto& source) {
      return std::isfinite(source->usual_time());
    };
    return !gas.falls && std::ranges::none_of(sources, sets_in_motion) &&
           std::ranges::all_of(gas.records, is_at_rest);
  }
  return collisionless().has_value();
}

std::optional<Collisionless> Run::collisionless() const {
  // Events and kicks may change directions of flight.
  if (!sources.empty() || kicks) return std::nullopt;
  if (gas.size() > 1 && !gas.composition.any_meet()) return Collisionless::passing;
  // Images fly past each other, and bodies grow into each other.
  if ((gas.shear || gas.growth) && gas.size() > 1) return std::nullopt;
  const auto state_of = [&](std::size_t i) {
    const kernels::Flight& flight = gas.records[i].flight;
    // Spheres do not meet by turning.
    return kernels::BodyState{flight.r, flight.v, flight.u, flight.omega > 0 ? flight.w : Vec3d{}};
  };
  // Of width, only those touch nothing that have no motion relative to each other. Spheres that
  // have begun on a lattice have equal directors, so that to look for other reasons would take
  // long.
  if (effects.width && gas.size() > 1 && !move_alike(gas.size(), state_of)) return std::nullopt;
  return needlework::collisionless(gas.size(), state_of);
}

Stop Run::end_of_events() const {
  if (nothing_can_happen()) return Stop::nothing_can_happen;
  throw InvalidStateError(fmt::format(
      "time {:.6g}: the next event is after {:.6g}, the largest time of this run (2^62 epochs of "
      "{:.3g}): expected an earlier end",
      gas.clock.since_start(now), gas.clock.since_start(Time::never()), gas.clock.epoch_length()));
}

}  // namespace needlework
