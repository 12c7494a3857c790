#include "src/engine/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "kernels/free_flight.h"
#include "kernels/power_of_two.h"
#include "needlework/error.h"
#include "src/engine/exact_sums.h"
#include "src/engine/space_order.h"
#include "src/machine/stop_request.h"
#include "src/physics/director.h"
#include "src/physics/mean_free_time.h"
#include "src/physics/vectors.h"
#include "src/scene/accuracy.h"
#include "src/scene/box_edges.h"
#include "src/scene/derived_numbers.h"

namespace needlework {
namespace {

std::array<double, 3> array(const Vec3d& a) { return {a.x, a.y, a.z}; }

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
  const double place[3] = {r.x, r.y, r.z};
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t image = gas.images[i][axis];
    if (image < -most_boxes || image > most_boxes) {
      throw InputError(
          fmt::format("state: needle {}: image = {}: expected a whole number from {} to {}",
                      gas.ids[i].value, image, -most_boxes, most_boxes));
    }
    const double boxes = wrap(place[axis], gas.box[axis]).boxes;
    if (std::abs(image + boxes) <= most_boxes) continue;
    throw InputError(fmt::format(
        "state: needle {}: position {} in a box of {}, with image {}: expected it within {} boxes",
        gas.ids[i].value, place[axis], gas.box[axis], image, most_boxes));
  }
}

bool is_at_rest(const Record& record) {
  return record.flight.v == Vec3d{} && record.flight.w == Vec3d{};
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

}  // namespace

Effects effects_of(const Scene& scene) {
  const Composition composition = scene.composition();
  return {.rough = composition.is_rough(),
          .contact_time = scene.collisions.tc || scene.collisions.tc_relative,
          .table = composition.is_mixture() || !is_unit(composition[0])};
}

Gas make_gas(const Scene& scene, const State& initial) {
  const std::size_t count = initial.size();
  check_size(initial.velocity.size(), count, "velocity");
  check_size(initial.orientation.size(), count, "orientation");
  check_size(initial.angular_velocity.size(), count, "angular velocity");
  if (!initial.image.empty()) check_size(initial.image.size(), count, "image");
  if (!initial.id.empty()) check_size(initial.id.size(), count, "id");
  Gas gas;
  gas.box = initial.box;
  gas.set_composition(composition_of(scene, initial));
  const double length = gas.longest;
  for (const double edge : initial.box) {
    if (!(edge >= least_edge(length) && edge <= largest_edge(length))) {
      throw InputError(fmt::format("state: box edge {}: expected from {:.10g} to {:.10g}", edge,
                                   least_edge(length), largest_edge(length)));
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
    flight.r = vector_of(initial.position[from]);
    flight.v = vector_of(initial.velocity[from]);
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
  return gas;
}

Run::Run(const Scene& scene)
    : accuracy(accuracy_of(scene.engine)),
      effects(effects_of(scene)),
      sorted(scene.engine.storage != "by-id"),
      tc_(scene.collisions.tc),
      tc_relative_(scene.collisions.tc_relative) {
  gas.set_composition(scene.composition());
}

void Run::add_columns() {
  if (effects.contact_time) contact_time_rule.emplace(gas);
}

Run::Run(const Scene& scene, Gas initial) : Run(scene) {
  gas = std::move(initial);
  gas.columns.resize(gas.size());
  add_columns();
  if (const auto reason = out_of_range(numbers()); !reason.empty())
    throw InputError("state: " + reason);
  open_window();
  gas.clock = Clock(mean_free_time);
  for (Needle i{0}; i < gas.size(); ++i) {
    StopRequest::check_in_turn(i);
    const kernels::Flight flight = gas.records[i].flight;
    renew_record(gas, i, now,
                 {flight.u, flight.v, flight.w, gas.species_of(gas.records[i]).length});
  }
  open_window();
  initial_energy = energy();
  // Done before search and calendar allocate their memory, which would add to that of sorting.
  if (sorted) reorder(gas, order_in_space(gas, now));
}

void Run::open_window() {
  const std::vector<SumsOfSquares> sums = sums_of_squares();
  Totals all;
  set_energies(sums, all);
  energy_at_window_ = all.energy * static_cast<double>(gas.size());
  quanta_at_window_ = tally.energy;
  mean_free_time = mean_free_time_of(sums);
  set_scales();
  window_end = gas.clock.add(now, window_span_);
}

void Run::set_scales() {
  // The energy of the gas is about 2^58 quanta, so that sums of many changes fit 64 bits.
  const int quantum = energy_at_window_ > 0 ? exponent_of(energy_at_window_) - 58 : 0;
  quantum_ = times_power_of_two(1, quantum);
  per_quantum_ = 1 / quantum_;
  contact_time = tc_ ? *tc_ : tc_relative_ ? *tc_relative_ * mean_free_time : 0;
  const bool endless = !std::isfinite(mean_free_time);
  window_span_ = endless ? mean_free_time : std::ldexp(1.0, std::ilogb(mean_free_time));
  search_span = 4 * window_span_;
}

void Run::pass_window() {
  const double by_account = energy();
  open_window();
  drift_of_windows_ += drift_to(energy_at_window_, by_account);
  const bool quiet = tally.collisions == std::exchange(collisions_before_, tally.collisions);
  quiet_windows_ = quiet ? quiet_windows_ + 1 : 0;
}

double Run::drift_to(double energy_of_all, double by_account) {
  return energy_of_all > 0 ? (energy_of_all - by_account) / energy_of_all : 0;
}

double Run::energy_drift() const {
  Totals sums;
  set_energies(sums_of_squares(), sums);
  return drift_of_windows_ + drift_to(sums.energy * static_cast<double>(gas.size()), energy());
}

void Run::report(Happening& happening, Needle a, Needle b, Reports* later) const {
  if (times_callback && happening.is_collision()) {
    if (later) {
      later->times.push_back(happening.event.time);
    } else {
      times_callback({&happening.event.time, 1});
    }
  }
  if (!happening_callback && !(callback && happening.is_collision())) return;
  const auto state_of = [&](Needle i) {
    const kernels::Flight& flight = gas.records[i].flight;
    return StateAfterCollision{array(flight.r), array(flight.v), array(flight.u), array(flight.w)};
  };
  happening.event.after[0] = state_of(a);
  if (b != no_needle) happening.event.after[1] = state_of(b);
  if (later) {
    later->happenings.push_back(happening);
  } else {
    pass_on(happening);
  }
}

void Run::pass_on(const Happening& happening) const {
  if (callback && happening.is_collision()) callback(happening.event);
  if (happening_callback) happening_callback(happening);
}

void Run::add_source(std::unique_ptr<EventSource> source) {
  constexpr std::size_t most = std::numeric_limits<decltype(Happening::kind)>::max();
  if (sources.size() == most) throw InputError(fmt::format("more than {} sources of events", most));
  sources.push_back(std::move(source));
  gas.columns.keep_changes();
  effects.sources = true;
}

GasNumbers Run::numbers_with(const std::vector<SumsOfSquares>& sums, bool moves) const {
  GasNumbers out{.count = static_cast<double>(gas.size()), .species = {}, .moves = moves};
  for (std::size_t index = 0; index < sums.size(); ++index) {
    const Species& species = gas.composition[index];
    out.species.push_back({.length = species.length,
                           .mass = species.mass,
                           .k = species.k,
                           .v2 = sums[index].v2,
                           .w2 = sums[index].w2});
  }
  return out;
}

GasNumbers Run::numbers() const {
  return numbers_with(sums_of_squares(),
                      !std::all_of(gas.records.begin(), gas.records.end(), is_at_rest));
}

void Run::require_images(Time at) const {
  for (Needle i{0}; i < gas.size(); ++i) {
    const Record& record = gas.records[i];
    const Vec3d centre = centre_after(record.flight, gas.clock.difference(at, record.time));
    const double place[3] = {centre.x, centre.y, centre.z};
    for (int axis = 0; axis < 3; ++axis) {
      add_boxes(gas.images[i][axis], wrap(place[axis], gas.box[axis]).boxes, gas.ids[i]);
    }
  }
}

void Run::require_followable(const std::vector<SumsOfSquares>& sums, bool moves) const {
  if (gas.size() == 0) return;
  if (const auto reason = out_of_range(numbers_with(sums, moves)); !reason.empty())
    throw InputError("set_velocities: " + reason);
  require_images(now);
  const double between = mean_free_time_of(sums), least = 0x1p10 * gas.clock.resolution();
  if (between < least) {
    throw InputError(fmt::format(
        "set_velocities: a mean free time of {:.3g}: expected at least {:.3g}, as times of this "
        "run are told apart to {:.3g}: start another simulation of the new state",
        between, least, gas.clock.resolution()));
  }
}

ReplacedRecords Run::replace_velocities(const std::function<Vec3d(Needle)>& velocity,
                                        const std::function<Vec3d(Needle)>& angular_velocity) {
  ReplacedRecords replaced;
  for (Needle i{0}; i < gas.size(); ++i) {
    const Record& record = gas.records[i];
    auto& entry = replaced.add(i, record);
    const Vec3d director = director_after(record.flight, gas.clock.difference(now, record.time));
    entry.wraps = renew_record(
        gas, i, now, {director, velocity(i), angular_velocity(i), gas.species_of(record).length});
  }
  open_window();
  return replaced;
}

bool Run::nothing_can_happen() const {
  if (!sources.empty() && gas.size() > 0) return false;
  if (gas.size() < 2) return true;
  const Vec3d& v = gas.records[0].flight.v;
  return std::all_of(gas.records.begin(), gas.records.end(), [&](const Record& record) {
    return record.flight.omega == 0 && record.flight.v == v;
  });
}

std::optional<Collisionless> Run::collisionless() const {
  if (!sources.empty()) return std::nullopt;  // events may change directions of flight
  if (nothing_can_happen() && gas.size() > 1) return Collisionless::alike;
  return needlework::collisionless(gas.size(), [&](std::size_t i) {
    const kernels::Flight& flight = gas.records[i].flight;
    return Motion{flight.v, flight.u, flight.w};
  });
}

Stop Run::end_of_events() const {
  if (nothing_can_happen()) return Stop::nothing_can_happen;
  throw InvalidStateError(fmt::format(
      "time {:.6g}: the next event is after {:.6g}, the largest time of this run (2^62 epochs of "
      "{:.3g}): expected an earlier end",
      gas.clock.since_start(now), gas.clock.since_start(Time::never()), gas.clock.epoch_length()));
}

std::vector<SumsOfSquares> Run::sums_of_squares() const {
  std::vector<SumsOfSquares> out(gas.composition.size());
  if (gas.size() == 0) return out;
  for (std::size_t species = 0; species < out.size(); ++species) {
    const auto [v2, w2] = exact_sums(gas.records, threads_at_hand(), [&](const Record& a) {
      if (a.species != species) return std::array{0.0, 0.0};
      return std::array{dot(a.flight.v, a.flight.v), dot(a.flight.w, a.flight.w)};
    });
    out[species] = {v2, w2};
  }
  return out;
}

SpeciesTotals Run::totals_of(SpeciesIndex index, const SumsOfSquares& sums) const {
  const Species& species = gas.composition[index];
  SpeciesTotals out;
  out.count = species.count;
  if (out.count == 0) return out;
  const double count = static_cast<double>(species.count);
  out.t_tr = species.mass * sums.v2 / (3 * count);
  out.t_rot = species.mass * (species.length * species.length) * sums.w2 / (4 * species.k * count);
  return out;
}

std::vector<SpeciesTotals> Run::species_totals() const {
  const std::vector<SumsOfSquares> sums = sums_of_squares();
  std::vector<SpeciesTotals> out;
  for (const SumsOfSquares& each : sums) {
    out.push_back(totals_of(static_cast<SpeciesIndex>(out.size()), each));
  }
  return out;
}

void Run::set_energies(const std::vector<SumsOfSquares>& sums, Totals& out) const {
  if (gas.size() == 0) return;
  out.t_tr = out.t_rot = 0;
  for (std::size_t index = 0; index < sums.size(); ++index) {
    const SpeciesTotals of = totals_of(static_cast<SpeciesIndex>(index), sums[index]);
    const double share = static_cast<double>(of.count) / static_cast<double>(gas.size());
    out.t_tr += share * of.t_tr;
    out.t_rot += share * of.t_rot;
  }
  out.energy = 1.5 * out.t_tr + out.t_rot;
}

double Run::mean_free_time_of(const std::vector<SumsOfSquares>& sums) const {
  std::vector<SpeciesTemperatures> temperatures;
  for (std::size_t index = 0; index < sums.size(); ++index) {
    const SpeciesTotals of = totals_of(static_cast<SpeciesIndex>(index), sums[index]);
    temperatures.push_back({of.t_tr, of.t_rot});
  }
  if (gas.composition.is_mixture()) {
    return needlework::mean_free_time(gas.composition, gas.box[0] * gas.box[1] * gas.box[2],
                                      temperatures);
  }
  const Species& species = gas.composition[0];
  return needlework::mean_free_time({.density = gas.density(),
                                     .t_tr = temperatures[0].t_tr,
                                     .t_rot = temperatures[0].t_rot,
                                     .length = species.length,
                                     .mass = species.mass,
                                     .k = species.k});
}

Totals Run::totals() const {
  Totals out;
  out.time = gas.clock.since_start(now);
  out.collisions = tally.collisions;
  out.tc_collisions = tally.tc_collisions;
  if (gas.size() == 0) return out;
  std::vector<SumsOfSquares> sums;
  for (std::size_t species = 0; species < gas.composition.size(); ++species) {
    // All at once: reading the records takes most of the time.
    const auto [v2, w2, x, y, z] = exact_sums(gas.records, threads_at_hand(), [&](const Record& a) {
      if (a.species != species) return std::array<double, 5>{};
      const Vec3d& v = a.flight.v;
      return std::array{dot(v, v), dot(a.flight.w, a.flight.w), v.x, v.y, v.z};
    });
    sums.push_back({v2, w2});
    const double mass = gas.composition[species].mass;
    for (const auto& [axis, sum] : {std::pair(0, x), std::pair(1, y), std::pair(2, z)}) {
      out.momentum[axis] += mass * sum;
    }
  }
  set_energies(sums, out);
  return out;
}

void Run::copy(kernels::Isa isa, const std::vector<Needle>& by_id, State& out) const {
  using C = kernels::FlightColumns;
  out.box = gas.box;
  out.resize(gas.size());
  out.species.resize(gas.composition.is_mixture() ? gas.size() : 0);
  // Few enough for the columns to stay in the first-level cache.
  constexpr std::size_t at_once = 64;
  static_assert(at_once % kernels::flights_at_once == 0);
  double columns[C::columns][at_once] = {};
  kernels::FlightColumns flights;
  for (int c = 0; c < C::columns; ++c) flights.column[c] = columns[c];
  for (std::size_t begin = 0; begin < by_id.size(); begin += at_once) {
    const std::span needles(&by_id[begin], std::min(at_once, by_id.size() - begin));
    for (std::size_t n = 0; n < needles.size(); ++n) {
      const Record& record = gas.records[needles[n]];
      flights.put(n, record.flight, gas.clock.difference(now, record.time));
    }
    kernels::fly(isa, flights, needles.size());
    for (std::size_t n = 0; n < needles.size(); ++n) {
      const Needle i = needles[n];
      const kernels::Flight& flight = gas.records[i].flight;
      std::array<double, 3> r = array(flights.centre(n));
      Shift image = gas.images[i];
      for (int axis = 0; axis < 3; ++axis) {
        const Wrapped wrapped = wrap(r[axis], gas.box[axis]);
        r[axis] = wrapped.place;
        image[axis] += static_cast<std::int32_t>(wrapped.boxes);  // see most_boxes
      }
      const bool just_now = columns[C::elapsed][n] == 0;
      const std::size_t row = begin + n;
      out.id[row] = gas.ids[i].value;
      if (!out.species.empty()) out.species[row] = gas.records[i].species;
      out.position[row] = r;
      out.image[row] = image;
      out.velocity[row] = array(flight.v);
      out.orientation[row] = array(just_now ? flight.u : normalised(flights.director(n)));
      out.angular_velocity[row] = array(flight.w);
    }
  }
}

FreeNeedle Run::needle(Id id) const {
  const auto found = std::find(gas.ids.begin(), gas.ids.end(), id);
  if (found == gas.ids.end()) {
    throw InputError(fmt::format("needle {}: expected the id of a needle", id.value));
  }
  const Record& record = gas.records[static_cast<std::size_t>(found - gas.ids.begin())];
  const double elapsed = gas.clock.difference(now, record.time);
  const Vec3d centre = centre_after(record.flight, elapsed);
  FreeNeedle out;
  out.position = {wrap(centre.x, gas.box[0]).place, wrap(centre.y, gas.box[1]).place,
                  wrap(centre.z, gas.box[2]).place};
  out.orientation =
      array(elapsed == 0 ? record.flight.u : normalised(director_after(record.flight, elapsed)));
  out.velocity = array(record.flight.v);
  out.angular_velocity = array(record.flight.w);
  return out;
}

}  // namespace needlework
