// What is saved of a run, so that it can continue as if it had not been stopped: the records with
// their touches, the present window, sums and counts. Search, calendar and the order of storage
// are not saved, because no trajectory depends on them.
#include <algorithm>
#include <cmath>

#include "needlework/error.h"
#include "src/archive/archive.h"
#include "src/engine/run.h"
#include "src/engine/space_order.h"
#include "src/physics/vectors.h"

namespace needlework {

void transfer(Archive& archive, Vec3d& a) { archive(a.x, a.y, a.z); }
void transfer(Archive& archive, Time& time) { archive(time.epoch, time.offset); }
void transfer(Archive& archive, RecordedTouch& touch) {
  archive(touch.partner.value, touch.partner_serial, touch.shift, touch.side, touch.collided,
          touch.gap);
}
void transfer(Archive& archive, Counters& counters) {
  for (const Counters::Named& counter : Counters::all) archive(counters.*counter.value);
}

namespace kernels {
void transfer(Archive& archive, Flight& flight) {
  archive(flight.r, flight.v, flight.u, flight.w, flight.p, flight.omega);
}
}  // namespace kernels

namespace {

// The square enters the energy.
bool square_is_finite(const Vec3d& a) { return std::isfinite(dot(a, a)); }

void require(bool condition) {
  if (!condition) Archive::throw_damaged();
}

bool is_time(const Clock& clock, Time time) {
  return time.offset >= 0 && time.offset < clock.epoch_length();
}

// The parameters on which the trajectory depends.
std::vector<double> physics_of(const Run& run, const Scene& scene) {
  constexpr double absent = -1;
  const Species& species = run.gas.species.front();
  const Accuracy accuracy = run.accuracy;
  return {species.length,
          species.mass,
          species.k,
          run.restitution.epsilon,
          run.restitution.beta,
          scene.collisions.tc.value_or(absent),
          scene.collisions.tc_relative.value_or(absent),
          static_cast<double>(accuracy.isolation),
          static_cast<double>(accuracy.escalation),
          static_cast<double>(accuracy.float_filter),
          accuracy.root_tolerance,
          accuracy.sampling_step};
}

std::vector<RecordedTouch> touches_of(const Gas& gas, Needle i) {
  const Record& record = gas.records[i];
  if (record.touch_count == 0) return {};
  std::vector<RecordedTouch> out{record.first_touch};
  if (record.touch_count > 1) {
    const auto further = gas.further_touches->of(gas.ids[i], record.serial);
    out.insert(out.end(), further.begin(), further.end());
  }
  return out;
}

void transfer_needle(Archive& archive, Gas& gas, Needle i) {
  Record& record = gas.records[i];
  archive(gas.ids[i].value, gas.images[i], record.time, record.flight, record.renewal,
          record.serial, record.species);
  std::vector<RecordedTouch> touches;
  if (!archive.reads()) touches = touches_of(gas, i);
  archive(touches);
  if (!archive.reads()) return;
  const kernels::Flight& f = record.flight;
  require(is_finite(f.r) && square_is_finite(f.v) && is_finite(f.u) && square_is_finite(f.w) &&
          is_finite(f.p) && std::abs(dot(f.u, f.u) - 1) < 1e-6 && std::isfinite(f.omega) &&
          f.omega >= 0);
  require(record.species < gas.species.size());
  require(is_time(gas.clock, record.time) && is_time(gas.clock, record.renewal));
  for (const auto& [place, edge] :
       {std::pair(f.r.x, gas.box[0]), std::pair(f.r.y, gas.box[1]), std::pair(f.r.z, gas.box[2])}) {
    require(place >= 0 && place < edge);
  }
  for (const RecordedTouch& touch : touches) gas.add_touch(i, touch);
}

}  // namespace

// Damaged numbers could keep a run from ever ending. Speeds are bounded by the energy, which is
// known twice.
void Run::require_consistent() const {
  require(is_time(gas.clock, now) && is_time(gas.clock, window_end) && now.epoch >= 0);
  require(quantum_ > 0 && std::isfinite(quantum_) && std::isfinite(initial_energy));
  if (gas.size() < 2) return;
  require(window_span_ > 0 && search_span > 0 && mean_free_time > 0 && contact_time >= 0);
  const auto is_past = [&](const Record& record) {
    return record.time.epoch >= 0 && record.time <= now && record.renewal > record.time;
  };
  require(std::ranges::all_of(gas.records, is_past));
  Totals sums;
  sum_energies(sums);
  const double sum = sums.energy * static_cast<double>(gas.size());
  require(std::abs(sum - energy()) <= 1e-6 * energy_at_window_);
}

// Needles are saved in order of id, whatever their order in storage.
void Run::transfer(Archive& archive, const std::vector<Needle>& by_id) {
  double epoch_length = gas.clock.epoch_length();
  archive(gas.box, epoch_length);
  if (archive.reads()) {
    require(std::isfinite(epoch_length) && epoch_length > 0);
    gas.clock = Clock(epoch_length);
    for (const double edge : gas.box) {
      require(std::isfinite(edge) && edge >= 2.01 * gas.longest);
    }
  }
  const bool has_last_collisions = effects.contact_time;
  if (has_last_collisions) last_collision.resize(gas.size(), Time{-(std::int64_t{1} << 62), 0});
  for (const Needle i : by_id) {
    transfer_needle(archive, gas, i);
    if (has_last_collisions) archive(last_collision[i]);
  }
  const auto increases = [](Id a, Id b) { return a < b; };
  require(!archive.reads() || std::ranges::is_sorted(gas.ids, increases));
  require(!archive.reads() ||
          std::ranges::adjacent_find(gas.ids, std::ranges::equal_to{}) == gas.ids.end());
  archive(now, window_end, window_span_, mean_free_time, contact_time, search_span, initial_energy,
          energy_at_window_, quantum_, quanta_at_window_);
  per_quantum_ = 1 / quantum_;
  archive(tally.collisions, tally.tc_collisions, tally.energy, tally.hash, tally.counters,
          tally.instant, tally.at_instant);
  if (archive.reads()) require_consistent();
}

Checkpoint Run::save(const Scene& scene, const std::vector<Needle>& by_id) {
  Checkpoint out;
  out.bytes.reserve(4096 + 220 * by_id.size());  // growing would take twice the memory
  Archive archive = Archive::to(out.bytes);
  std::vector<double> physics = physics_of(*this, scene);
  std::uint64_t count = gas.size();
  archive(physics, count);
  transfer(archive, by_id);
  return out;
}

Run::Run(const Scene& scene, const Checkpoint& saved) : Run(scene) {
  Archive archive = Archive::from(saved.bytes);
  std::vector<double> physics;
  std::uint64_t count;
  archive(physics, count);
  if (physics != physics_of(*this, scene)) {
    throw InputError(
        "the saved state is of other needles, collisions or accuracy than those of the scene: "
        "expected the same");
  }
  require(count <= saved.bytes.size());
  gas.records.resize(count);
  gas.ids.resize(count);
  gas.images.resize(count);
  std::vector<Needle> by_id(count);
  for (Needle i{0}; i < count; ++i) by_id[i] = i;
  transfer(archive, by_id);
  archive.require_end();
  if (!sorted) return;
  const std::vector<Needle> order = order_in_space(gas, now);
  reorder(gas, order);
  if (effects.contact_time) permute(last_collision, order);
}

}  // namespace needlework
