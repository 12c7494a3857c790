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

Species species_of(const Scene& scene) {
  if (scene.species.size() > 1) {
    throw InputError(fmt::format(
        "species: {} entries: expected one: gases of several species are not simulated yet",
        scene.species.size()));
  }
  const Scene::Species species = scene.one_species();
  return {.length = species.length, .mass = species.mass, .k = species.k};
}

// For one species the collision rate is that of needles of length and mass 1, times L^2 / sqrt(m).
double mean_free_time_of(const Gas& gas, const Totals& sums) {
  const Species& species = gas.species.front();
  return mean_free_time({.density = gas.density(),
                         .t_tr = sums.t_tr,
                         .t_rot = sums.t_rot,
                         .length = species.length,
                         .mass = species.mass,
                         .k = species.k});
}

}  // namespace

Effects effects_of(const Scene& scene) {
  return {.rough = scene.collisions.beta != -1,
          .contact_time = scene.collisions.tc || scene.collisions.tc_relative,
          .table = !species_of(scene).is_unit()};
}

Gas make_gas(const Scene& scene, const State& initial) {
  const std::size_t count = initial.size();
  check_size(initial.velocity.size(), count, "velocity");
  check_size(initial.orientation.size(), count, "orientation");
  check_size(initial.angular_velocity.size(), count, "angular velocity");
  if (!initial.image.empty()) check_size(initial.image.size(), count, "image");
  if (!initial.id.empty()) check_size(initial.id.size(), count, "id");
  const double length = species_of(scene).length;
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
  Gas gas;
  gas.box = initial.box;
  gas.set_species({species_of(scene)});

  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!initial.id.empty()) {
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return initial.id[a] < initial.id[b]; });
  }
  gas.records.resize(count);
  gas.ids.resize(count);
  gas.images.resize(count);
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
  return gas;
}

Run::Run(const Scene& scene)
    : restitution{scene.collisions.epsilon, scene.collisions.beta},
      accuracy(accuracy_of(scene.engine)),
      effects(effects_of(scene)),
      sorted(scene.engine.storage != "by-id"),
      tc_(scene.collisions.tc),
      tc_relative_(scene.collisions.tc_relative) {
  gas.set_species({species_of(scene)});
}

Run::Run(const Scene& scene, Gas initial) : Run(scene) {
  gas = std::move(initial);
  if (const auto reason = out_of_range(numbers()); !reason.empty())
    throw InputError("state: " + reason);
  open_window();
  gas.clock = Clock(mean_free_time);
  for (Needle i{0}; i < gas.size(); ++i) {
    StopRequest::check_in_turn(i);
    const kernels::Flight flight = gas.records[i].flight;
    renew_record(gas, i, now, {flight.u, flight.v, flight.w, gas.longest});
  }
  open_window();
  initial_energy = energy();
  // Done before search and calendar allocate their memory, which would add to that of sorting.
  if (sorted) reorder(gas, order_in_space(gas, now));
}

void Run::open_window() {
  Totals sums;
  sum_energies(sums);
  const double count = static_cast<double>(gas.size());
  energy_at_window_ = sums.energy * count;
  quanta_at_window_ = tally.energy;
  mean_free_time = mean_free_time_of(gas, sums);
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
  sum_energies(sums);
  return drift_of_windows_ + drift_to(sums.energy * static_cast<double>(gas.size()), energy());
}

void Run::report(Collision& collision, Needle a, Needle b, CollisionReports* later) const {
  if (times_callback) {
    if (later) {
      later->times.push_back(collision.time);
    } else {
      times_callback({&collision.time, 1});
    }
  }
  if (!callback) return;
  const auto state_of = [&](Needle i) {
    const kernels::Flight& flight = gas.records[i].flight;
    return StateAfterCollision{array(flight.r), array(flight.v), array(flight.u), array(flight.w)};
  };
  collision.after = {state_of(a), state_of(b)};
  if (later) {
    later->collisions.push_back(collision);
  } else {
    callback(collision);
  }
}

GasNumbers Run::numbers_with(double v2, double w2, bool moves) const {
  const Species& species = gas.species.front();
  return {.count = static_cast<double>(gas.size()),
          .length = species.length,
          .mass = species.mass,
          .k = species.k,
          .v2 = v2,
          .w2 = w2,
          .moves = moves};
}

GasNumbers Run::numbers() const {
  const auto [v2, w2] = sums_of_squares();
  return numbers_with(v2, w2, !std::all_of(gas.records.begin(), gas.records.end(), is_at_rest));
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

void Run::require_followable(double v2, double w2, bool moves) const {
  if (gas.size() == 0) return;
  if (const auto reason = out_of_range(numbers_with(v2, w2, moves)); !reason.empty())
    throw InputError("set_velocities: " + reason);
  require_images(now);
  Totals sums;
  set_energies(v2, w2, sums);
  const double between = mean_free_time_of(gas, sums), least = 0x1p10 * gas.clock.resolution();
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
  if (gas.size() < 2) return true;
  const Vec3d& v = gas.records[0].flight.v;
  return std::all_of(gas.records.begin(), gas.records.end(), [&](const Record& record) {
    return record.flight.omega == 0 && record.flight.v == v;
  });
}

std::optional<Collisionless> Run::collisionless() const {
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

std::array<double, 2> Run::sums_of_squares() const {
  return exact_sums(gas.records, threads_at_hand(), [](const Record& a) {
    return std::array{dot(a.flight.v, a.flight.v), dot(a.flight.w, a.flight.w)};
  });
}

void Run::sum_energies(Totals& out) const {
  if (gas.size() == 0) return;
  const auto [v2, w2] = sums_of_squares();
  set_energies(v2, w2, out);
}

// From the sums of v^2 and w^2, which is enough where all needles are of one species.
void Run::set_energies(double v2, double w2, Totals& out) const {
  const double count = static_cast<double>(gas.size());
  const Species& species = gas.species.front();
  out.t_tr = species.mass * v2 / (3 * count);
  out.t_rot = species.mass * (species.length * species.length) * w2 / (4 * species.k * count);
  out.energy = 1.5 * out.t_tr + out.t_rot;
}

Totals Run::totals() const {
  Totals out;
  out.time = gas.clock.since_start(now);
  out.collisions = tally.collisions;
  out.tc_collisions = tally.tc_collisions;
  if (gas.size() == 0) return out;
  // All at once: reading the records takes most of the time.
  const auto [v2, w2, x, y, z] = exact_sums(gas.records, threads_at_hand(), [](const Record& a) {
    const Vec3d& v = a.flight.v;
    return std::array{dot(v, v), dot(a.flight.w, a.flight.w), v.x, v.y, v.z};
  });
  set_energies(v2, w2, out);
  out.momentum = {x, y, z};
  for (double& component : out.momentum) component *= gas.species.front().mass;
  return out;
}

void Run::copy(kernels::Isa isa, const std::vector<Needle>& by_id, State& out) const {
  using C = kernels::FlightColumns;
  out.box = gas.box;
  out.resize(gas.size());
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
