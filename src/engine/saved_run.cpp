// What is saved of a run, so that it can continue as if it had not been stopped: the records with
// their touches, the present window, sums and counts. Search, calendar and the order of storage
// are not saved, because no trajectory depends on them. What follows from saved numbers is computed
// again by the functions that have computed it in the run, to the same bits.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "needlework/error.h"
#include "src/archive/archive.h"
#include "src/engine/initial_gas.h"
#include "src/engine/run.h"
#include "src/engine/space_order.h"
#include "src/machine/stop_request.h"
#include "src/physics/transfer.h"
#include "src/physics/vectors.h"
#include "src/scene/box_of.h"
#include "src/scene/confinement.h"
#include "src/scene/own_bodies.h"

namespace needlework {

void transfer(Archive& archive, Counters& counters) {
  for (const Counters::Named& counter : Counters::all) archive(counters.*counter.value);
}

namespace {

void require(bool condition) {
  if (!condition) Archive::throw_damaged();
}

// What a needle takes in a checkpoint, without touches and without the memory of the t_c rule.
constexpr std::size_t least_bytes_of_a_needle = 141;
// What that memory and one touch add; few needles have more touches.
constexpr std::size_t usual_further_bytes = 40;
constexpr std::size_t most_touches = std::numeric_limits<decltype(Record::touch_count)>::max();
constexpr Time long_ago = ContactTimeRule::long_ago;

bool is_time(const Clock& clock, Time time) {
  return time.offset >= 0 && time.offset < clock.epoch_length() && time >= long_ago &&
         time <= Time::never();
}

void require_flight(const kernels::Flight& f, const Body& body) {
  require(is_finite(f.r) && is_finite(f.v) && is_finite(f.u) && is_finite(f.w));
  require(std::abs(dot(f.u, f.u) - 1) < 1e-6);
  const double largest = std::max({std::abs(f.w.x), std::abs(f.w.y), std::abs(f.w.z)});
  require(!body.has_axis() || std::abs(dot(f.u, f.w)) <= 1e-6 * largest + 1e-300);
  require(body.turns() || largest == 0);
  require(std::isfinite(f.omega));
}

// Such numbers that all means and searches are right.
void require_body(const BodyNumbers& body, const Species& species) {
  if (!species.sizes) {  // its bodies are alike, beside others that differ
    const auto require_near = [](double value, double expected) {
      require(std::abs(value - expected) <= 1e-12 * expected);
    };
    require_near(body.length, species.length);
    require_near(body.diameter, species.diameter);
    require_near(body.mass, species.mass);
    require_near(body.inertia, species.inertia());
    return;
  }
  // Sizes that grow do so one by one, each with its own rounding.
  constexpr double rounding = 1e-12;
  const auto require_within = [](double value, double least, double greatest) {
    require(value >= least * (1 - rounding) && value <= greatest * (1 + rounding));
  };
  const Sizes& sizes = *species.sizes;
  constexpr double largest = std::numeric_limits<double>::max() / 2;
  require_within(body.length + body.diameter, sizes.least_extent, sizes.greatest_extent);
  require_within(body.length, 0, sizes.length.greatest);
  require_within(body.diameter, sizes.diameter.least, sizes.diameter.greatest);
  require_within(body.mass, sizes.mass.least, largest);
  require(std::isfinite(body.inertia));
  if (!species.fixed) require_within(body.inertia, sizes.inertia.least, largest);
}

// The parameters on which the trajectory depends.
std::vector<double> physics_of(const Run& run, const Scene& scene) {
  constexpr double absent = -1;
  const Composition& composition = run.gas.composition;
  const Species& species = composition[0];
  const Restitution& restitution = composition.restitution(0, 0);
  const Accuracy accuracy = run.accuracy;
  std::vector<double> out = {run.gas.box.edge(0),
                             run.gas.box.edge(1),
                             run.gas.box.edge(2),
                             species.length,
                             species.mass,
                             species.k,
                             restitution.epsilon,
                             restitution.beta,
                             scene.collisions.tc.value_or(absent),
                             scene.collisions.tc_relative.value_or(absent),
                             static_cast<double>(accuracy.isolation),
                             static_cast<double>(accuracy.escalation),
                             static_cast<double>(accuracy.float_filter),
                             accuracy.root_tolerance,
                             accuracy.sampling_step};
  const auto add = [&](const std::vector<double>& parameters) {
    out.insert(out.end(), parameters.begin(), parameters.end());
  };
  if (run.effects.stress) add({1});
  if (run.gas.shear) add({run.gas.shear->velocity()});
  if (run.gas.peculiar_x) add({1});
  if (run.gas.falls) add({run.gas.gravity.x, run.gas.gravity.y, run.gas.gravity.z});
  for (const auto& source : run.sources) add(source->parameters());
  if (run.kicks) add(run.kicks->parameters());
  if (const auto& growth = scene.driving.growth) {
    add({growth->rate, growth->until_packing.value_or(absent),
         growth->until_pressure.value_or(absent), growth->cool_every.value_or(absent),
         growth->from});
  }
  if (run.sliding)
    out.insert(out.end(), {run.sliding->below(), run.sliding->strikes_are_elastic() ? 1. : 0.});
  if (composition.has_width()) {
    for (const Species& each : composition.species()) {
      out.push_back(each.diameter);
      if (!each.has_axis()) out.push_back(each.q);
    }
  }
  for (const Species& each : composition.species()) {
    if (!each.sizes) continue;
    out.insert(out.end(), {each.sizes->least_extent, each.sizes->greatest_extent,
                           each.sizes->product, each.sizes->square});
  }
  if (!composition.all_meet()) {
    for (std::size_t a = 0; a < composition.size(); ++a) {
      for (std::size_t b = a; b < composition.size(); ++b) out.push_back(composition.meets(a, b));
    }
  }
  if (!composition.is_mixture()) return out;
  for (const Species& each : composition.species()) {
    out.insert(out.end(), {static_cast<double>(each.count), each.length, each.mass, each.k});
  }
  for (const Restitution& rule : composition.rules()) {
    out.insert(out.end(), {rule.epsilon, rule.beta});
  }
  return out;
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
  archive(gas.ids[i].value, gas.images[i], record.time, record.flight, record.serial,
          record.species);
  if (gas.has_own_bodies()) {
    BodyNumbers& body = gas.own_bodies[i];
    archive(body.length, body.diameter, body.mass, body.inertia);
  }
  std::vector<RecordedTouch> touches;
  if (!archive.reads()) touches = touches_of(gas, i);
  archive(touches);
  if (!archive.reads()) return;
  const kernels::Flight& f = record.flight;
  require(record.species < gas.composition.size());
  const Body body = gas.body(i);
  set_rotation(record.flight, body);
  require_flight(f, body);
  if (gas.has_own_bodies()) require_body(gas.own_bodies[i], gas.composition[record.species]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int32_t boxes = gas.images[i][axis];
    require((gas.shear && axis == 0) || (boxes >= -most_boxes && boxes <= most_boxes));
  }
  require(is_time(gas.clock, record.time) && record.time.epoch >= 0);
  record.renewal = renewal_time(gas, record, body.extent());
  require(touches.size() <= most_touches);
  require(gas.box_at(record.time).wrap(to_array(f.r)).place == to_array(f.r));
  record.touch_count = 0;
  for (const RecordedTouch& touch : touches) {
    const bool may_slide = gas.slides && &touch == &touches.front();
    require(std::abs(touch.side) <= 1 && std::isfinite(touch.gap) &&
            (may_slide || touch.kind != TouchKind::bond));
    gas.add_touch(i, touch);
  }
}

// A step of a contact follows from both records, which say how much faster each needle may become.
// Only where another event has replaced one of them at this instant is it saved.
void transfer_slides(Archive& archive, Gas& gas, const std::vector<Needle>& by_id) {
  const auto id_of = [&](Needle i) { return gas.ids[i]; };
  for (const Needle i : by_id) {
    const Record& mine = gas.records[i];
    if (!mine.is_sliding()) continue;
    const RecordedTouch& touch = mine.first_touch;
    const auto place = std::ranges::lower_bound(by_id, touch.partner, {}, id_of);
    require(place != by_id.end() && id_of(*place) == touch.partner);
    const Needle j = *place;
    const Record& other = gas.records[j];
    const RecordedTouch& back = other.first_touch;
    const Shift shift{touch.shift[0], touch.shift[1], touch.shift[2]};
    const bool is_first = id_of(i) < touch.partner;
    const bool is_whole = other.is_sliding() && touch.partner_serial == other.serial &&
                          back.is_with(id_of(i), mine.serial, -shift);
    if (!is_whole) {
      Slide slide;
      if (!archive.reads()) slide = *gas.slides->of(id_of(i), mine);
      archive(slide);
      if (!archive.reads()) continue;
      require(slide.faster[is_first ? 0 : 1] == touch.gap &&
              slide.step.span <= gas.motion(mine).lasts(gas.body(i).extent()));
      gas.slides->put(is_first ? id_of(i) : touch.partner,
                      is_first ? mine.serial : touch.partner_serial, slide);
    } else if (archive.reads() && is_first) {
      require(mine.time == other.time && touch.side == back.side);
      const Slide slide = make_slide(gas, i, j, shift, touch.side);
      require(slide.faster[0] == touch.gap && slide.faster[1] == back.gap);
      gas.slides->put(id_of(i), mine.serial, slide);
    }
  }
}

}  // namespace

// Damaged numbers could keep a run from ever ending. Speeds are bounded by the energy, which is
// known twice.
void Run::require_consistent() const {
  require(is_time(gas.clock, now) && is_time(gas.clock, windows.end()) && now.epoch >= 0);
  // A needle may be below the edge from which heights count, where its wall moves.
  const auto is_energy = [&](double x) { return std::isfinite(x) && (gas.falls || x >= 0); };
  require(is_energy(initial_energy) && is_energy(energy.at_opening()) && energy.is_sound());
  const auto fits = [](const auto& counts, std::size_t kinds) {
    return counts.empty() || counts.size() == kinds;
  };
  require(fits(tally.by_pair, gas.composition.pairs()));
  require(fits(tally.by_source, sources.size()) && fits(tally.by_object, objects));
  std::uint64_t happenings = tally.collisions;
  for (const SourceTally& source : tally.by_source) happenings += source.events;
  require(tally.tc_collisions <= tally.collisions && tally.at_instant <= happenings &&
          tally.collisions < std::uint64_t{1} << 63);
  const auto is_past = [&](Time time) { return is_time(gas.clock, time) && time <= now; };
  require(std::ranges::all_of(gas.records, is_past, &Record::time));
  if (contact_time_rule) {
    require(std::ranges::all_of(contact_time_rule->last_collisions(), is_past));
  }
  if (gas.slides)
    require(std::ranges::all_of(gas.records, [&](const Record& record) {
      if (!record.is_sliding()) return true;
      const Slide* slide =
          gas.slides->of(gas.ids[static_cast<std::size_t>(&record - &gas.records[0])], record);
      return now <= gas.clock.add(record.time, slide->step.duration * (1 + 0x1p-40));
    }));
  // Where nothing can happen, time passes without windows.
  if (!nothing_can_happen()) {
    require(now <= windows.end() && windows.end() <= gas.clock.add(now, windows.span()));
    const auto is_to_come = [&](Time time) { return time >= now; };
    require(std::ranges::all_of(gas.records, is_to_come, &Record::renewal));
  }
  // Files hold the images of needles in flight.
  for (Needle i{0}; i < gas.size(); ++i) {
    StopRequest::check_in_turn(i);
    const Record& record = gas.records[i];
    const Vec3d centre = gas.slides ? gas.present(i, now).r : gas.motion_from(record, now).centre();
    const Boxes boxes = gas.box_at(now).wrap(to_array(centre)).boxes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      constexpr double most = std::numeric_limits<std::int32_t>::max();
      require((gas.shear && axis == 0) || std::abs(gas.images[i][axis] + boxes[axis]) <= most);
    }
  }
  StopRequest::check();
  GasNumbers present = numbers();
  StopRequest::check();
  present.has_cooled = true;
  require(out_of_range(present).empty());
  const std::vector<SumsOfSquares> sums = sums_now();
  require(std::isfinite(work_at_start) && std::isfinite(work_at_opening));
  require(std::abs(energy_of(gas, sums) - energy_by_account(sums)) <= 1e-6 * energy.at_opening());
}

void Run::transfer_growth(Archive& archive) {
  gas.growth->transfer(archive);
  growing->transfer(archive);
  archive(tally.growth);
  const double scale = gas.scale_at(now);
  require(scale > 0 && scale <= 1 + 1e-12 && gas.growth->rate() > 0 && now <= next_instant());
}

// Needles are saved in order of id, whatever their order in storage.
void Run::transfer(Archive& archive, const std::vector<Needle>& by_id) {
  double epoch_length = gas.clock.epoch_length();
  archive(epoch_length);
  if (archive.reads()) {
    require(std::isfinite(epoch_length) && epoch_length > 0);
    gas.set_clock(Clock(epoch_length));
    require(gas.clock.epoch_length() == epoch_length);
  }
  for (const Needle i : by_id) {
    if (archive.reads()) StopRequest::check_in_turn(i);
    transfer_needle(archive, gas, i);
    gas.columns.transfer(archive, i);
  }
  const auto increases = [](Id a, Id b) { return a < b; };
  require(!archive.reads() || std::ranges::is_sorted(gas.ids, increases));
  require(!archive.reads() ||
          std::ranges::adjacent_find(gas.ids, std::ranges::equal_to{}) == gas.ids.end());
  if (gas.slides) transfer_slides(archive, gas, by_id);
  archive(now);
  windows.transfer(archive);
  if (!sources.empty() || kicks || effects.growth) windows.transfer_measured(archive);
  archive(initial_energy);
  expect_energy();
  energy.transfer(archive);
  if (archive.reads()) {
    require(energy.is_sound() && windows.mean_free_time() > 0);
    set_contact_time();
  }
  archive(tally.collisions, tally.tc_collisions, tally.energy, tally.hash, tally.counters,
          tally.instant, tally.at_instant);
  if (gas.composition.is_mixture()) archive(tally.by_pair);
  if (!sources.empty()) archive(tally.by_source, tally.by_object);
  if (effects.width) {
    archive(tally.virial);
    require(tally.virial.empty() || tally.virial.size() == (effects.mixed ? 2u : 1u));
  }
  if (sliding) archive(tally.sliding);
  if (kicks) {
    archive(kicks_done);
    // A gas of no needles is not kicked.
    require(kicks_done < std::uint64_t{1} << 53 && (gas.size() == 0 || now <= next_instant()));
  }
  if (effects.growth) transfer_growth(archive);
  if (gas.moving_edges) {
    for (JamLook* look : {&looked_for_jam_, &looked_long_for_jam_})
      archive(look->time, look->collisions);
    require(looked_for_jam_.collisions <= tally.collisions && looked_for_jam_.time <= now &&
            looked_long_for_jam_.collisions <= tally.collisions &&
            looked_long_for_jam_.time <= now);
  }
  find_next_instant();
  energy_shares.transfer(archive, sources.size(), objects, effects.shear, effects.growth);
  if (effects.stress) {
    archive(tally.stress, tally.flow);
    require(tally.stress.size() <= 1);
    stress_batches.transfer(archive);
  }
  if (effects.shear) archive(work_at_opening);
  if (!(gas.pull == Vec3d{})) archive(work_at_start, work_at_opening);
  temperature_integral.transfer(archive);
  archive.require(temperature_integral.is_sound());
  if (archive.reads()) require_consistent();
}

Checkpoint Run::save(const Scene& scene, const std::vector<Needle>& by_id) {
  Checkpoint out;
  // Growing would take twice the memory.
  out.bytes.reserve(4096 + (least_bytes_of_a_needle + usual_further_bytes) * by_id.size());
  Archive archive = Archive::to(out.bytes);
  std::vector<double> physics = physics_of(*this, scene);
  std::uint64_t count = gas.size();
  archive(physics, count);
  if (gas.shear) {
    double slide = gas.shear->start();
    archive(slide);
  }
  transfer(archive, by_id);
  return out;
}

Run::Run(const Scene& scene, const Checkpoint& saved) : Run(scene) {
  Archive archive = Archive::from(saved.bytes);
  std::vector<double> physics;
  std::uint64_t count;
  archive(physics, count);
  gas.box = box_of(scene);
  gas.moving_edges = moving_edges_of(scene, gas.box.edges());
  set_gravity(gas, scene);
  if (scene.shear) {
    double slide;
    archive(slide);
    require(slide >= 0 && slide <= gas.box.edge(0));
    set_shear(gas, scene, slide);
  }
  add_effects(scene);
  if (physics != physics_of(*this, scene)) {
    throw InputError(
        "the saved state is of another box, or of other needles, collisions or accuracy than those "
        "of the scene: expected the same");
  }
  const std::uint64_t of_scene = scene.composition().count();
  if (of_scene != 0 && of_scene != count) {
    throw InputError(fmt::format("the saved state has {} needles, the scene {}: expected the same",
                                 count, of_scene));
  }
  require(count <= saved.bytes.size() / least_bytes_of_a_needle);
  require(Room(scene).holds(gas.box.edges()));
  // A scene need not say how many needles there are of its only species.
  if (!gas.composition.is_mixture()) gas.composition.set_count(0, count);
  gas.resize(count);
  if (effects.growth) {
    gas.growth.emplace(1, 1);  // until it is read
    growing.emplace(parameters_of_growing(scene));
  }
  std::vector<Needle> by_id(count);
  for (Needle i{0}; i < count; ++i) by_id[i] = i;
  transfer(archive, by_id);
  archive.require_end();
  find_last_time(scene);
  if (!sorted) return;
  const std::vector<Needle> order = order_in_space(gas, now);
  StopRequest::check();
  reorder(gas, order);
  StopRequest::check();
  sorted_at_ = tally.counters.crossings;
}

}  // namespace needlework
