#include "src/audit/audit.h"

#include <algorithm>
#include <bit>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "needlework/error.h"
#include "src/audit/tolerances.h"

namespace needlework::audit {
namespace {

// A mixing function: the finaliser of SplitMix64.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

// The collision with times in epochs and lengths in this unit.
Collision in_units(Collision collision, double epoch_length, double unit) {
  const double speed = epoch_length / unit;
  collision.offset /= epoch_length;
  collision.arm_first /= unit;
  collision.arm_second /= unit;
  collision.normal_velocity *= speed;
  collision.energy_change *= speed * speed;
  for (double& p : collision.impulse) p *= speed;
  for (StateAfterCollision& needle : collision.after) {
    for (double& r : needle.position) r /= unit;
    for (double& v : needle.velocity) v *= speed;
    for (double& w : needle.angular_velocity) w *= epoch_length;
  }
  return collision;
}

// The least power of two that no needle is longer than, so that nothing is rounded by it.
double unit_of(const Composition& composition) {
  int exponent = 0;
  const double mantissa = std::frexp(composition.longest(), &exponent);
  return std::ldexp(1.0, mantissa == 0.5 ? exponent - 1 : exponent);
}

std::vector<AuditedBody> bodies_of(const Composition& composition, double unit) {
  std::vector<AuditedBody> out;
  for (const Species& each : composition.species()) {
    out.push_back({.species = out.size(),
                   .length = each.length / unit,
                   .mass = each.mass_or_infinity(),
                   .k = each.k,
                   .diameter = each.diameter / unit,
                   .q = each.q});
  }
  return out;
}

Space space_of(const State& state, const Setup& setup, double unit) {
  Space out;
  out.box = state.box;
  out.longest = setup.composition.longest() / unit;
  for (double& edge : out.box) edge /= unit;
  for (const Scene::Wall& wall : setup.walls) {
    out.periodic[wall.axis == "x" ? 0 : wall.axis == "y" ? 1 : 2] = false;
  }
  if (setup.shear) {
    const double velocity = setup.shear->rate * state.box[1] * (setup.epoch_length / unit);
    out.rows.emplace(velocity, state.slide / unit, out.box[0], out.box[1]);
  }
  out.gravity = vector(setup.gravity) * (setup.epoch_length * setup.epoch_length / unit);
  return out;
}

// Where those of a species differ.
AuditedBody own_body(const OwnBodies& own, std::size_t i, AuditedBody body, double unit) {
  const double length = own.length.at(i), inertia = own.inertia.at(i);
  body.length = length / unit;
  body.diameter = own.diameter.at(i) / unit;
  body.mass = own.mass.at(i);
  if (!std::isfinite(inertia)) return body;
  if (length > 0)
    body.k = body.mass * (length * length) / (2 * inertia);
  else
    body.q = 4 * inertia / (body.mass * (own.diameter.at(i) * own.diameter.at(i)));
  return body;
}

std::vector<Needle> needles_of(const State& state, const Instant& time,
                               const std::vector<AuditedBody>& bodies, double epoch_length,
                               double unit) {
  std::vector<Needle> needles;
  needles.reserve(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    const std::size_t species = bodies.size() > 1 ? state.species.at(i) : 0;
    needles.emplace_back(
        Record{time, vector(state.position[i]) * (1 / unit),
               vector(state.velocity[i]) * (epoch_length / unit), vector(state.orientation[i]),
               vector(state.angular_velocity[i]) * epoch_length},
        state.own_bodies.empty() ? bodies.at(species)
                                 : own_body(state.own_bodies, i, bodies.at(species), unit));
  }
  return needles;
}

InputError unexpected(Happening::Kind kind) {
  return InputError(std::string("event of the kind ") + name_of(kind) +
                    ": expected collisions, hits on walls, draws of a thermostat and, in a gas of "
                    "needles that slide, contacts");
}

}  // namespace

const char* name(Kind kind) {
  constexpr std::array names = {"missed",      "spurious",   "late",        "early",
                                "wrong_order", "wrong_rule", "wrong_start", "wrong_end"};
  return names[static_cast<std::size_t>(kind)];
}

double Findings::bound95(Kind kind) const {
  if (!is_of_collisions(kind)) return std::numeric_limits<double>::quiet_NaN();
  const bool of_all = kind == Kind::wrong_order || kind == Kind::wrong_rule;
  const std::uint64_t n =
      hits + ended + (of_all ? collisions : contacts + (kind == Kind::missed ? count(kind) : 0));
  if (n == 0) return std::numeric_limits<double>::quiet_NaN();
  return boost::math::gamma_q_inv(static_cast<double>(count(kind)) + 1, 0.05) /
         static_cast<double>(n);
}

Audit::Audit(const State& initial, const Setup& setup)
    : setup_(setup),
      unit_(unit_of(setup.composition)),
      bodies_(bodies_of(setup.composition, unit_)),
      space_(space_of(initial, setup, unit_)),
      ids_(initial.id),
      needles_(needles_of(initial, {}, bodies_, setup.epoch_length, unit_)),
      walls_(walls_of(setup.walls, space_.box, setup.epoch_length, unit_)),
      windows_(beside_flow(needles_, {}), bodies_, setup.composition,
               space_.box[0] * space_.box[1] * space_.box[2],
               setup.driving.kicks ? setup.driving.kicks->every / setup.epoch_length : HUGE_VAL),
      initial_energy_(energy()) {
  if (setup.shear && (!setup.walls.empty() || norm(space_.gravity) > 0 || setup.driving.kicks ||
                      setup.driving.andersen)) {
    throw InputError(
        "an audit of [shear]: expected a scene without [[walls]], [forces] and [driving] beside "
        "it");
  }
  if (setup_.tc) *setup_.tc /= setup.epoch_length;
  if (setup.driving.kicks) {
    kicks_.emplace(*setup.driving.kicks, setup.scene_seed, setup.epoch_length, unit_);
  }
  if (setup.driving.growth) let_grow(*setup.driving.growth);
  if (setup.composition.has_width()) findings_.overlaps.emplace();
  has_collided_.assign(initial.size(), false);
  joints_.resize(initial.size());
  last_touches_.resize(initial.size());
  met_.assign(initial.size(), {});
}

// An audit that was interrupted before the first collision starts from the beginning.
void Audit::resume(Checkpoint checkpoint) {
  if (checkpoint.findings.events() > 0) resumed_ = std::move(checkpoint);
}

Checkpoint Audit::checkpoint() const {
  if (resumed_) return *resumed_;
  return {findings_, fingerprint_, continuations_};
}

Audit::Index Audit::index_of(std::uint32_t id) const {
  const auto found = std::lower_bound(ids_.begin(), ids_.end(), id);
  if (found == ids_.end() || *found != id) {
    throw InputError("collision of needle " + std::to_string(id) + ": expected one of the state");
  }
  return static_cast<Index>(found - ids_.begin());
}

bool Audit::meet(Index i, Index j) const {
  return setup_.composition.meets(needles_[i].body.species, needles_[j].body.species);
}

void Audit::let_grow(const Scene::Growth& growth) {
  if (setup_.tc_relative) {
    throw InputError(
        "an audit of driving.growth: expected no collisions.tc_relative, whose mean free time is "
        "measured as bodies grow: collisions.tc can be audited");
  }
  space_.growth.emplace(growth_of(growth, needles_));
  space_.longest = std::ranges::min(space_.box);
  if (const auto collisions = Cooling::collisions_of(growth, needles_.size()))
    cooling_.emplace(*collisions, needles_);
}

// Records of all at one instant; their sizes at the start stay.
std::vector<Needle> Audit::replaced(const State& after, const Instant& now) const {
  std::vector<Needle> out = needles_of(after, now, bodies_, setup_.epoch_length, unit_);
  for (Index i = 0; i < out.size(); ++i) out[i].body = needles_[i].body;
  return out;
}

// Of pairs that pass through each other, there is nothing to check.
bool Audit::is_chosen(Index i, Index j) const {
  if (!meet(i, j)) return false;
  if (setup_.share >= 1) return true;
  const std::uint64_t pair = key_of(i, j);
  return static_cast<double>(mixed(mixed(setup_.seed) ^ pair)) < setup_.share * 0x1p64;
}

double Audit::since_start(const Instant& time) const { return elapsed<double>({}, time).middle; }

Instant Audit::begin_of(Index i, Index j) const {
  return std::max(needles_[i].record.time, needles_[j].record.time);
}

// The second needle in an image, but for whole boxes, which flights add themselves.
Needle Audit::image_of(Index second, const Shift& shift, Index first) const {
  const Needle& needle = needles_[second];
  return space_.rows ? space_.rows->image(needle, shift[1], begin_of(first, second)) : needle;
}

std::vector<Needle> Audit::beside_flow(std::vector<Needle> needles, const Instant& now) const {
  if (!space_.rows) return needles;
  for (Needle& each : needles) each = space_.rows->beside_flow(each, now);
  return needles;
}

// Counted from the later of both records.
Approach Audit::approach_of(Index i, Index j, double duration) const {
  const Record &a = needles_[i].record, &b = needles_[j].record;
  const Instant begin = std::max(a.time, b.time);
  if (setup_.sliding && (joints_[i] || joints_[j])) return chord_of(i, j, begin, duration);
  const auto age = [&](const Record& record) { return elapsed<double>(record.time, begin).middle; };
  const auto centre = [&](const Record& record) {
    return record.r + (record.v + space_.gravity * (0.5 * age(record))) * age(record);
  };
  Approach out{centre(a) - centre(b), a.v - b.v + space_.gravity * (age(a) - age(b))};
  if (space_.rows) {
    out.slide = space_.rows->at(begin).offset;
    out.row_velocity = space_.rows->velocity();
  }
  return out;
}

void Audit::report(Kind kind, Index i, Index j, const Instant& begin, double s) {
  ++findings_.differences[static_cast<std::size_t>(kind)];
  if (findings_.listed.size() >= most_listed) return;
  const double time = (since_start(begin) + s) * setup_.epoch_length;
  findings_.listed.push_back({kind, time, ids_[std::min(i, j)], ids_[std::max(i, j)]});
}

void Audit::report_at_wall(Kind kind, Index i, std::size_t wall, const Instant& begin, double s) {
  ++findings_.differences[static_cast<std::size_t>(kind)];
  if (findings_.listed.size() >= most_listed) return;
  const double time = (since_start(begin) + s) * setup_.epoch_length;
  findings_.listed.push_back({kind, time, ids_[i], static_cast<std::uint32_t>(wall), true});
}

void Audit::add(const Happening& reported) {
  Happening happening = reported;
  Collision& collision = happening.event;
  collision = in_units(collision, setup_.epoch_length, unit_);
  const Instant now{collision.epoch, collision.offset};
  for (const std::uint64_t word :
       {std::uint64_t(collision.epoch), std::bit_cast<std::uint64_t>(collision.offset),
        std::uint64_t{collision.first} << 32 | collision.second}) {
    note_in_fingerprint(word);
  }
  switch (happening.kind) {
    case Happening::pair:
      ++findings_.collisions;
      break;
    case Happening::contact_entered:
    case Happening::contact_ended:
      if (!setup_.sliding) throw unexpected(happening.kind);
      ++(happening.kind == Happening::contact_ended ? findings_.ended : findings_.entered);
      findings_.collisions += happening.kind == Happening::contact_entered;
      break;
    case Happening::wall:
      ++findings_.hits;
      if (collision.second < walls_.size()) break;
      throw InputError("hit on wall " + std::to_string(collision.second) +
                       ": expected one of the scene");
    case Happening::thermostat:
      ++findings_.draws;
      break;
    default:
      throw unexpected(happening.kind);
  }
  settle_cuts(now);
  check_owed(now, &happening);
  advance_windows(now);
  last_energy_change_ = collision.energy_change;
  std::optional<Judgement> judgement;
  if (setup_.sliding && happening.is_collision()) {
    judgement = judge(index_of(collision.first), index_of(collision.second), now, happening);
  }
  if (!resumed_) {
    check_order(now, happening);
    if (happening.is_collision()) {
      check_pair(now, collision, judgement);
    } else if (happening.kind == Happening::contact_ended) {
      check_contact_end(now, collision);
    } else {
      check_single(now, happening);
    }
  }
  follow(now, happening, judgement);
  if (!resumed_ && happening.is_collision() && findings_.overlaps) {
    const Index a = index_of(collision.first), b = index_of(collision.second);
    if (is_chosen(a, b) && have_width(a, b)) measure_overlap(a, b);
  }
  go_on_if_resumed();
}

void Audit::advance_windows(const Instant& now) {
  if (!setup_.tc_relative && !setup_.sliding) return;
  windows_.advance(now, [&](const Instant& end) { return beside_flow(present(end), end); });
}

void Audit::note_in_fingerprint(std::uint64_t word) { fingerprint_ = mixed(fingerprint_ ^ word); }

// Where the interrupted audit stopped, checking begins.
void Audit::go_on_if_resumed() {
  if (resumed_ && findings_.events() == resumed_->findings.events()) {
    if (fingerprint_ != resumed_->fingerprint) {
      throw InputError(
          "the collisions are not those of the interrupted audit: expected the same "
          "scene and engine");
    }
    findings_ = std::move(resumed_->findings);
    continuations_ = std::move(resumed_->continuations);
    resumed_.reset();
  }
}

// The flights of a needle that end now, with all others but one.
void Audit::check_partners(Index mine, Index besides, const Instant& now) {
  for (Index other = 0; other < needles_.size(); ++other) {
    if (other == mine || other == besides) continue;
    check_flight(mine, other, now);
    go_on_from_contact(mine, other, now);
  }
}

void Audit::check_pair(const Instant& now, const Collision& collision,
                       const std::optional<Judgement>& judgement) {
  const Index a = index_of(collision.first), b = index_of(collision.second);
  if (now < needles_[a].record.time || now < needles_[b].record.time) return;
  check_rule(a, b, now, collision, judgement);
  if (joint_of(a, b)) report(Kind::spurious, a, b, now);  // which f = 0 leaves open
  if (!meet(a, b)) report(Kind::spurious, a, b, now);
  for (const Index i : {a, b}) check_held(i, now);
  check_partners(a, b, now);
  check_partners(b, a, now);
  for (const Index i : {a, b}) check_walls(i, now, nullptr);
  if (is_chosen(a, b)) check_contact(a, b, now);
}

void Audit::check_single(const Instant& now, const Happening& happening) {
  const Collision& event = happening.event;
  const Index i = index_of(event.first);
  if (now < needles_[i].record.time) return;
  if (happening.kind == Happening::wall) {
    check_hit(i, now, event);
  } else if (excess_over_flight(present(i, now), space_.gravity, now, event.after[0], space_) > 1) {
    report(Kind::wrong_rule, i, i, now);
  }
  check_held(i, now);
  check_partners(i, i, now);
  check_walls(i, now, happening.kind == Happening::wall ? &event : nullptr);
}

// Rule and place of a hit: its tip is at the wall, and comes nearer.
void Audit::check_hit(Index i, const Instant& now, const Collision& hit) {
  const Needle needle = present(i, now);
  const Wall& wall = walls_[hit.second];
  const bool by_contact_time = hit.contact_time_rule;
  const double time = since_start(now) * setup_.epoch_length;
  if (excess_over_wall_rule(needle, wall, now, hit, space_) > 1 ||
      by_contact_time != (!wall.draws && hit_is_elastic(i, now, by_contact_time)) ||
      std::abs(hit.time - time) > 0x1p-50 * time) {
    report_at_wall(Kind::wrong_rule, i, hit.second, now, 0);
  }
  // Of a needle in contact, from the present on.
  const double duration = elapsed<double>(needle.record.time, now).middle;
  const double flown = elapsed<double>(needles_[i].record.time, now).middle;
  const TipFlight tip(needle, space_, wall, hit.arm_first > 0 ? 1 : -1);
  const double height = tip.height(duration), rate = tip.rate(duration);
  const double off =
      tip_tolerance(needle) + std::abs(rate) * (relative_tolerance * flown + 2 * resolution);
  if (height <= off) return;  // one that is too low is found as one that crossed the wall
  const bool soon = rate < 0 && height < -rate * early_reach;
  report_at_wall(soon ? Kind::early : Kind::spurious, i, hit.second, now, 0);
}

// Neither tip has been in a wall since the record. The hit that ends the flight, if there is one,
// is late if its own tip has.
void Audit::check_walls(Index i, const Instant& now, const Collision* hit) {
  if (walls_.empty()) return;
  const Needle& needle = needles_[i];
  const double duration = elapsed<double>(needle.record.time, now).middle;
  if (!(duration > 0)) return;
  ++findings_.at_walls;
  const Guide guide = guide_of(i, 0);
  if (guide.joint && !guide.joint->follow(duration)) {
    ++findings_.undecided;
    return;
  }
  const double tolerance = tip_tolerance(present(i, now));
  for (std::size_t wall = 0; wall < walls_.size(); ++wall) {
    for (const int tip : {1, -1}) {
      if (tip > 0 && needle.body.length == 0) continue;  // a sphere has both in one place
      const TipFlight flight(guide, duration, space_, walls_[wall], tip);
      const auto crossing = flight.crossing(0, duration, tolerance);
      if (!crossing) continue;
      const bool is_of_hit = hit && hit->second == wall && (hit->arm_first > 0) == (tip > 0);
      report_at_wall(is_of_hit ? Kind::late : Kind::missed, i, wall, needle.record.time, *crossing);
    }
  }
}

void Audit::follow(const Instant& now, const Happening& happening,
                   const std::optional<Judgement>& judgement) {
  const Collision& event = happening.event;
  const bool ends = happening.kind == Happening::contact_ended;
  if (ends) follow_contact_end(now, event);
  const int needles = happening.has_two_needles() ? 2 : 1;
  for (int i = 0; i < needles && !ends; ++i) {
    const Index index = index_of(i == 0 ? event.first : event.second);
    const StateAfterCollision& after = event.after[static_cast<std::size_t>(i)];
    if (setup_.sliding) cut_contact(index, now);
    if (cooling_) cooling_->add_flight(needles_[index], space_.gravity, now);
    needles_[index] = Needle(Record{now, vector(after.position), vector(after.velocity),
                                    vector(after.orientation), vector(after.angular_velocity)},
                             needles_[index].body);
    if (happening.kind == Happening::thermostat) continue;  // which does not count for t_c
    has_collided_[index] = true;
    met_[index] = now;
    if (happening.kind == Happening::wall) last_touches_[index].note(LastTouches::wall, now);
  }
  if (cooling_ && happening.is_collision()) {
    const Needle &a = needles_[index_of(event.first)], &b = needles_[index_of(event.second)];
    cooling_->add_collision(dot(nearest_separation(a, b), vector(event.impulse)));
  }
  if (judgement) {
    note_meeting(index_of(event.first), index_of(event.second), now, judgement->crowded);
    owed_.reset();
    if (happening.kind == Happening::contact_entered) enter_contact(now, event);
  }
  last_ = {now,
           {happening.source, event.first, happening.has_two_needles() ? event.second : event.first,
            event.shift[0], event.shift[1], event.shift[2]}};
}

bool Audit::finish(double time, const std::function<bool()>& stop) {
  if (resumed_) {
    throw InputError("the run ended after " + std::to_string(findings_.collisions) +
                     " collisions: expected at least the " +
                     std::to_string(resumed_->findings.collisions) + " of the interrupted audit");
  }
  const Instant end = instant_at(time / setup_.epoch_length);
  Checkpoint before = checkpoint();
  bool stopped = false;
  settle_cuts(end, true);
  check_owed(end, nullptr);
  slack_ = 0x1p-51 * time / setup_.epoch_length;
  for (Index i = 0; i < needles_.size() && !stopped; ++i) {
    check_walls(i, end, nullptr);
    if (joints_[i] && joints_[i]->first == i) check_held(i, end);
    for (Index j = i + 1; j < needles_.size() && !stopped; ++j) {
      stopped = stop && stop();
      if (!stopped) check_flight(i, j, end);
    }
  }
  slack_ = 0;
  if (stopped) {
    findings_ = std::move(before.findings);
    continuations_ = std::move(before.continuations);
  }
  return !stopped;
}

void Audit::check_order(const Instant& now, const Happening& happening) {
  const Collision& collision = happening.event;
  const bool two = happening.has_two_needles();
  // Of one needle, the wall that it hits has no place in the order.
  const std::pair<Instant, std::array<std::int64_t, 6>> key = {
      now,
      {happening.source, collision.first, two ? collision.second : collision.first,
       collision.shift[0], collision.shift[1], collision.shift[2]}};
  // A collision may cause another one at the same instant, with lower ids.
  const auto just_had = [&](std::uint32_t id) {
    const Index i = index_of(id);
    return has_collided_[i] && needles_[i].record.time == now;
  };
  const bool follows =
      !last_ || *last_ < key ||
      (last_->first == now && (just_had(collision.first) || (two && just_had(collision.second))));
  if (two ? !(collision.first < collision.second && follows) : !follows) {
    const Index i = index_of(collision.first);
    report(Kind::wrong_order, i, two ? index_of(collision.second) : i, now);
  }
}

void Audit::check_rule(Index a, Index b, const Instant& now, const Collision& collision,
                       const std::optional<Judgement>& judgement) {
  const Restitution& of_pair =
      setup_.composition.restitution(needles_[a].body.species, needles_[b].body.species);
  const double excess = judgement ? judgement->excess
                                  : excess_over_rule(needles_[a], needles_[b], now, collision,
                                                     {of_pair.epsilon, of_pair.beta}, space_);
  const bool by_contact_time = collision.contact_time_rule;
  const double time = since_start(now) * setup_.epoch_length;
  if (excess > 1 || by_contact_time != contact_time_is_due(a, b, now, by_contact_time) ||
      std::abs(collision.time - time) > 0x1p-50 * time) {
    report(Kind::wrong_rule, a, b, now);
  }
}

// Those of gases with walls, gravity, a thermostat or growth are not.
bool Audit::follows_windows() const {
  return walls_.empty() && norm(space_.gravity) == 0 && !setup_.driving.andersen && !space_.growth;
}

// Beside walls the threshold of needles that slide, which is the contact time of hits, is what the
// reports say; an age of 0 is below it, and needles that have not collided have none.
bool Audit::hit_is_elastic(Index i, const Instant& now, bool reported) const {
  if (!setup_.sliding) return contact_time_is_due(i, i, now, reported);
  if (setup_.sliding->elastic_strikes && joints_[i]) return true;
  return has_collided_[i] && (met_[i] == now || reported);
}

bool Audit::contact_time_is_due(Index a, Index b, const Instant& now, bool reported) const {
  if (!setup_.tc && !setup_.tc_relative) return false;
  if (!setup_.tc && !(follows_windows() && windows_.are_certain())) return reported;
  const double tc = setup_.tc ? *setup_.tc : *setup_.tc_relative * windows_.mean_free_time();
  const double tolerance = setup_.tc ? 0x1p-50 : Windows::tolerance;
  bool undecided = false;
  for (const Index i : {a, b}) {
    if (!has_collided_[i]) continue;
    const double age = elapsed<double>(met_[i], now).middle;
    const bool near = std::abs(age - tc) <= tolerance * tc;
    undecided |= near;
    if (!near && age < tc) return true;
  }
  if (undecided) return reported;
  return false;
}

}  // namespace needlework::audit
