#include "src/engine/run.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "kernels/free_flight.h"
#include "kernels/power_of_two.h"
#include "needlework/error.h"
#include "src/engine/space_order.h"
#include "src/physics/director.h"
#include "src/physics/mean_free_time.h"
#include "src/scene/accuracy.h"
#include "src/trajectory/exact_sum.h"

namespace needlework {
namespace {

Vec3d vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }
std::array<double, 3> array(const Vec3d& a) { return {a.x, a.y, a.z}; }

bool is_finite(const Vec3d& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

void check_size(std::size_t actual, std::size_t expected, const char* what) {
  if (actual == expected || actual == 0) return;
  throw InputError(std::string("state: ") + std::to_string(actual) + " rows of " + what +
                   ": expected " + std::to_string(expected));
}

// Sums over needles of terms, exactly: the sums of all terms(record), an array.
template <class Terms>
auto sums_of(const Gas& gas, Terms&& terms) {
  decltype(terms(gas.records[0])) largest{}, out;
  for (const Record& record : gas.records) {
    const auto term = terms(record);
    for (std::size_t n = 0; n < term.size(); ++n) {
      largest[n] = std::max(largest[n], std::abs(term[n]));
    }
  }
  std::vector<ExactSum> sums(largest.begin(), largest.end());
  for (const Record& record : gas.records) {
    const auto term = terms(record);
    for (std::size_t n = 0; n < term.size(); ++n) sums[n].add(term[n]);
  }
  for (std::size_t n = 0; n < out.size(); ++n) out[n] = sums[n].value();
  return out;
}

}  // namespace

Gas make_gas(const Scene& scene, const State& initial) {
  const std::size_t count = initial.size();
  check_size(initial.velocity.size(), count, "velocity");
  check_size(initial.orientation.size(), count, "orientation");
  check_size(initial.angular_velocity.size(), count, "angular velocity");
  check_size(initial.image.size(), count, "image");
  check_size(initial.id.size(), count, "id");
  for (const double edge : initial.box) {
    if (!(edge >= 2.01) || !std::isfinite(edge)) {
      throw InputError("state: box edge " + std::to_string(edge) + ": expected at least 2.01");
    }
  }
  Gas gas;
  gas.box = initial.box;
  gas.k = scene.needles.k;

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
    const std::size_t from = order[i];
    kernels::Flight& flight = gas.records[i].flight;
    flight.r = vector(initial.position[from]);
    flight.v = vector(initial.velocity[from]);
    flight.u = vector(initial.orientation[from]);
    flight.w = vector(initial.angular_velocity[from]);
    gas.ids[i] = initial.id.empty() ? static_cast<std::uint32_t>(i) : initial.id[from];
    if (i > 0 && gas.ids[i] == gas.ids[i - 1]) {
      throw InputError("state: id " + std::to_string(gas.ids[i]) + " twice: expected distinct ids");
    }
    if (!initial.image.empty()) gas.images[i] = initial.image[from];
    const bool finite =
        is_finite(flight.r) && is_finite(flight.u) && is_finite(flight.v) && is_finite(flight.w);
    if (!finite || flight.u == Vec3d{}) {
      throw InputError("state: needle " + std::to_string(gas.ids[i]) +
                       ": expected finite numbers and a director that is not 0");
    }
  }
  return gas;
}

Run::Run(const Scene& scene, Gas initial)
    : gas(std::move(initial)),
      restitution{scene.collisions.epsilon, scene.collisions.beta},
      accuracy(accuracy_of(scene.engine)),
      sorted(scene.engine.storage != "by-id"),
      tc_(scene.collisions.tc),
      tc_relative_(scene.collisions.tc_relative) {
  open_window();
  gas.clock = Clock(mean_free_time);
  for (Needle i = 0; i < gas.size(); ++i) {
    const kernels::Flight flight = gas.records[i].flight;
    renew_record(gas, i, now, flight.u, flight.v, flight.w);
  }
  open_window();
  initial_energy = energy();
  // Before search and calendar take their memory, which would add to what sorting needs.
  if (sorted) reorder(gas, order_in_space(gas, now));
}

void Run::open_window() {
  Totals sums;
  sum_energies(sums);
  const double count = static_cast<double>(gas.size());
  energy_at_window_ = sums.energy * count;
  quanta_at_window_ = tally.energy;
  // 2^58 quanta, so that sums of many changes fit.
  quantum_ = energy_at_window_ > 0 ? times_power_of_two(1, exponent_of(energy_at_window_) - 58) : 1;
  per_quantum_ = 1 / quantum_;
  mean_free_time = needlework::mean_free_time(gas.density(), sums.t_tr, sums.t_rot, gas.k);
  contact_time = tc_ ? *tc_ : tc_relative_ ? *tc_relative_ * mean_free_time : 0;
  const bool endless = !std::isfinite(mean_free_time);
  window_span_ = endless ? mean_free_time : std::ldexp(1.0, std::ilogb(mean_free_time));
  window_end = gas.clock.add(now, window_span_);
  search_span = 4 * window_span_;
}

void Run::tell(Collision& report, Needle a, Needle b, std::vector<Collision>* later) const {
  const auto aftermath = [&](Needle i) {
    const kernels::Flight& flight = gas.records[i].flight;
    return StateAfterCollision{array(flight.r), array(flight.v), array(flight.u), array(flight.w)};
  };
  report.after = {aftermath(a), aftermath(b)};
  if (later) {
    later->push_back(report);
  } else {
    callback(report);
  }
}

bool Run::nothing_can_happen() const {
  if (gas.size() < 2) return true;
  const Vec3d& v = gas.records[0].flight.v;
  return std::all_of(gas.records.begin(), gas.records.end(), [&](const Record& record) {
    return record.flight.omega == 0 && record.flight.v == v;
  });
}

void Run::sum_energies(Totals& out) const {
  if (gas.size() == 0) return;
  const double count = static_cast<double>(gas.size());
  const auto [v2, w2] = sums_of(gas, [](const Record& a) {
    return std::array{dot(a.flight.v, a.flight.v), dot(a.flight.w, a.flight.w)};
  });
  out.t_tr = v2 / (3 * count);
  out.t_rot = w2 / (4 * gas.k * count);
  out.energy = 1.5 * out.t_tr + out.t_rot;
}

Totals Run::totals() const {
  Totals out;
  out.time = gas.clock.since_start(now);
  out.collisions = tally.collisions;
  out.tc_collisions = tally.tc_collisions;
  if (gas.size() == 0) return out;
  sum_energies(out);
  out.momentum = sums_of(gas, [](const Record& a) { return array(a.flight.v); });
  return out;
}

State Run::state(kernels::Isa isa) const {
  using C = kernels::FlightColumns;
  State out;
  out.box = gas.box;
  std::vector<Needle> by_id(gas.size());
  std::iota(by_id.begin(), by_id.end(), Needle{0});
  std::sort(by_id.begin(), by_id.end(),
            [&](Needle a, Needle b) { return gas.ids[a] < gas.ids[b]; });
  // Few enough for their columns to stay in the first-level cache.
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
        image[axis] = add_boxes(image[axis], wrapped.boxes);
      }
      const bool just_now = columns[C::elapsed][n] == 0;
      out.id.push_back(gas.ids[i]);
      out.position.push_back(r);
      out.image.push_back(image);
      out.velocity.push_back(array(flight.v));
      out.orientation.push_back(array(just_now ? flight.u : normalised(flights.director(n))));
      out.angular_velocity.push_back(array(flight.w));
    }
  }
  return out;
}

}  // namespace needlework
