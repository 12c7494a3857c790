// Needles that slide on each other: their entry, their motion, strikes and ends.
//
// A contact is followed by the audit itself from the records with which it begins. Wherever one of
// its needles is met, or the contact ends, that motion is where the needle must be.
#include <algorithm>
#include <cmath>

#include "src/audit/audit.h"
#include "src/audit/excess.h"
#include "src/audit/tolerances.h"

namespace needlework::audit {
namespace {

/// Relative uncertainty of the threshold, which is in mean free times, and of what is compared with
/// it.
constexpr double threshold_tolerance = 2 * Windows::tolerance;
/// After so many crowded collisions in a row the next ones are elastic.
constexpr int most_in_crowd = 8;
/// Needles part at this fraction of their speeds at least.
constexpr double least_parting = 0x1p-43;
/// An epsilon that is raised follows from the threshold to this.
constexpr double raised_tolerance = 2e-5;

Record record_of(const BodyState& stance, const Instant& now) {
  return {now, to<double>(stance.r), to<double>(stance.v), to<double>(stance.u),
          to<double>(cross(stance.u, stance.du))};
}

/// By what a needle in contact may be off from its motion, of lengths, angles and velocities.
double noise_of(const JointMotion& motion, int needle, double s) {
  return contact_noise * motion.grown(s) + motion.spread(needle, s);
}

/// The same of the velocity of two needles at their contact.
Extended normal_noise(const Needle& first, const Needle& second, const Touch& touch) {
  return 8 * std::max({contact_noise, first.worn * 0x1p-50, second.worn * 0x1p-50}) * touch.speeds;
}

// What gravity makes of it in this time.
BodyState fallen(BodyState stance, const Vector<double>& gravity, Extended time) {
  const Vector<Extended> gained = to<Extended>(gravity) * time;
  stance.r = stance.r + gained * (time / 2);
  stance.v = stance.v + gained;
  return stance;
}

// A needle in free flight, as if it had an event now.
Needle flown_to(const Needle& needle, const Vector<double>& gravity, const Instant& now) {
  const Flight<Extended> flight(needle.record);
  const Extended age = static_cast<Extended>(elapsed<double>(needle.record.time, now).middle);
  const Pose<Extended> pose = flight.at(age);
  return Needle(record_of(fallen({pose.r, flight.v, pose.u, pose.du}, gravity, age), now),
                needle.body);
}

}  // namespace

const Audit::Joint* Audit::joint_of(Index i, Index j) const {
  return joints_[i] && joints_[i] == joints_[j] ? joints_[i].get() : nullptr;
}

Guide Audit::guide_of(Index i, double delay) const {
  Joint* joint = joints_[i].get();
  return {needles_[i], joint ? &joint->motion : nullptr, joint ? joint->index(i) : 0, delay};
}

// As if it had an event now.
Needle Audit::present(Index i, const Instant& now) const {
  if (!joints_[i]) return needles_[i];
  Joint& joint = *joints_[i];
  const double s = elapsed<double>(joint.begin, now).middle;
  joint.motion.follow(s);
  const BodyState stance = fallen(joint.motion.at(joint.index(i), s), space_.gravity, s);
  Needle out(record_of(stance, now), needles_[i].body);
  out.worn = noise_of(joint.motion, joint.index(i), s) * 0x1p50;
  return out;
}

std::vector<Needle> Audit::present(const Instant& now) const {
  std::vector<Needle> out;
  out.reserve(needles_.size());
  for (Index i = 0; i < needles_.size(); ++i) out.push_back(present(i, now));
  return out;
}

// r12 of the nearest image, of records of one time.
Vector<double> Audit::nearest_separation(const Needle& a, const Needle& b) const {
  Vector<double> out;
  for (int axis = 0; axis < 3; ++axis) {
    const Extended r = Extended(a.record.r[axis]) - b.record.r[axis];
    const Extended edge = space_.box[static_cast<std::size_t>(axis)];
    out[axis] = static_cast<double>(r - edge * space_.boxes_along<Extended>(axis, r));
  }
  return out;
}

Approach Audit::chord_of(Index i, Index j, const Instant& begin, double duration) const {
  double acceleration = 0;
  const auto centre = [&](Index n, double s) {
    const Needle& needle = needles_[n];
    const double delay = elapsed<double>(needle.record.time, begin).middle;
    // What gravity does to both alike is left out.
    const Vector<double> fall = space_.gravity * (delay * (0.5 * delay + s));
    if (!joints_[n]) return needle.record.r + needle.record.v * (delay + s) + fall;
    Joint& joint = *joints_[n];
    joint.motion.follow(delay + duration);
    if (s > 0) {
      acceleration += joint.motion.most(joint.index(n), delay, delay + duration).acceleration;
    }
    return to<double>(joint.motion.at(joint.index(n), delay + s).r) + fall;
  };
  const Vector<double> r = centre(i, 0) - centre(j, 0);
  const Vector<double> moved = centre(i, duration) - centre(j, duration) - r;
  return {r, moved * (1 / duration), acceleration * duration * duration / 8 * upward};
}

// --- Collisions of needles that may slide.

// For flights to the next bounce, if the mean free time is known. [epochs]
std::optional<double> Audit::threshold() const {
  if (!follows_windows() || !windows_.are_certain()) return std::nullopt;
  return setup_.sliding->below * windows_.mean_free_time();
}

Audit::Answer Audit::is_crowded(Index a, Index b, const Instant& now) const {
  const std::optional<double> below = threshold();
  Answer out = Answer::no;
  for (const auto& [mine, other] : {std::pair(a, b), std::pair(b, a)}) {
    if (joints_[mine] && joints_[mine]->other(mine) != other) return Answer::yes;
    const LastTouches& touches = last_touches_[mine];
    const auto& before = touches.last == other ? touches.others : touches.with_last;
    if (!before) continue;
    const double age = elapsed<double>(*before, now).middle;
    if (age == 0 || (below && age < 2 * *below * (1 - threshold_tolerance))) return Answer::yes;
    if (!below || age < 2 * *below * (1 + threshold_tolerance)) out = Answer::open;
  }
  return out;
}

// Whether one of the two is in contact, or has touched anything at this instant.
bool Audit::is_strike(Index a, Index b, const Instant& now) const {
  return std::ranges::any_of(
      std::array{a, b}, [&](Index i) { return joints_[i] || last_touches_[i].with_last == now; });
}

// Whether a collision begins a contact, where neither needle has just touched a third one: the
// needles press on each other, the next bounce would come soon, and the contact lasts for at least
// twice the time in which all bounces would have ended.
Audit::Answer Audit::may_enter(const RelativeState& before,
                               const std::array<AuditedBody, 2>& bodies, int side,
                               double epsilon) const {
  if (epsilon == 1) return Answer::no;
  Answer out = Answer::yes;
  const Touch touch(before, bodies);
  const Extended speed = touch.normal_velocity;
  const RelativeState plastic = after_change(before, bodies, touch, -speed);
  const Touch rebound(after_change(before, bodies, touch, -(1 + Extended(epsilon)) * speed),
                      bodies);
  const Touch stay(plastic, bodies);
  for (const Touch* each : {&rebound, &stay}) {
    if (each->pressing(side) < -each->noise) return Answer::no;
    if (each->pressing(side) < each->noise) out = Answer::open;
  }
  if (out == Answer::open) return out;
  const double flight =
      static_cast<double>(2 * Extended(epsilon) * std::abs(speed) / rebound.pressing(side));
  if (epsilon > 0) {
    const std::optional<double> below = threshold();
    if (below && flight > *below * (1 + threshold_tolerance)) return Answer::no;
    if (!below || flight > *below * (1 - threshold_tolerance)) out = Answer::open;
  }
  const double train = 2 * flight / (1 - epsilon);
  JointMotion motion(plastic, bodies, side);
  const double longest = train * (1 + threshold_tolerance);
  if (!motion.follow(longest)) return Answer::open;
  if (motion.first_below(-1, 0, train * (1 - threshold_tolerance))) return Answer::no;
  return motion.first_below(1, 0, longest) ? Answer::open : out;
}

Audit::Judgement Audit::judge(Index a, Index b, const Instant& now,
                              const Happening& happening) const {
  const Collision& collision = happening.event;
  const Needle first = present(a, now), second = present(b, now);
  const std::array<AuditedBody, 2> bodies = {first.body, second.body};
  const double given =
      setup_.composition.restitution(first.body.species, second.body.species).epsilon;
  const auto at = [&](const Needle& needle) {
    return needle.record.time == now ? needle : flown_to(needle, space_.gravity, now);
  };
  const Needle here = at(first), there = at(second);
  const RelativeState before =
      relative_state(here.record, there.record, nearest_separation(here, there));
  const Touch touch(before, bodies);
  const Extended speed = touch.normal_velocity, size = std::abs(speed);
  const auto excess = [&](double epsilon) {
    return excess_over_rule(first, second, now, collision,
                            {.epsilon = epsilon, .beta = -1, .parting = least_parting}, space_);
  };
  Extended impulse = 0;
  for (int axis = 0; axis < 3; ++axis) impulse += touch.n[axis] * collision.impulse[axis];
  const double reported =
      std::clamp(static_cast<double>(-1 - impulse * touch.inverse_mass / speed), 0.0, 1.0);
  Judgement best{HUGE_VAL, false};
  const auto may_be = [&](double epsilon, bool crowded) {
    const double with = excess(epsilon);
    if (with < best.excess) best = {with, crowded};
  };
  const bool entered = happening.kind == Happening::contact_entered;
  const bool elastic = setup_.sliding->elastic_strikes && is_strike(a, b, now);
  const Answer crowded = is_crowded(a, b, now);
  Answer enters = Answer::no;
  if (!elastic && crowded != Answer::yes && (entered || threshold())) {
    enters = may_enter(before, bodies, speed > 0 ? -1 : 1, given);
    if (enters == Answer::yes && crowded == Answer::open) enters = Answer::open;
  }
  const bool is_noise = size <= normal_noise(first, second, touch);
  if (entered) {
    if (enters != Answer::no || is_noise) may_be(0, false);
    return best;
  }
  if (enters == Answer::yes && !is_noise) return best;
  if (elastic) {
    may_be(1, crowded == Answer::yes);
    return best;
  }
  if (crowded != Answer::yes || is_noise) may_be(given, crowded == Answer::yes);
  if (crowded != Answer::no) {
    const std::optional<double> below = threshold();
    const int in_a_row = std::max(last_touches_[a].in_crowd, last_touches_[b].in_crowd);
    const double needed =
        in_a_row >= most_in_crowd
            ? 1
            : static_cast<double>(touch.rate * touch.speeds * below.value_or(0) / (2 * size));
    const double due = given == 1 ? 1 : std::clamp(needed, given, 1.0);
    may_be(due, true);
    if (!below || std::abs(reported - due) <= raised_tolerance) {
      may_be(std::max(given, reported), true);
    }
  }
  return best;
}

void Audit::note_meeting(Index a, Index b, const Instant& now, bool crowded) {
  for (const auto& [mine, other] : {std::pair(a, b), std::pair(b, a)}) {
    LastTouches& touches = last_touches_[mine];
    touches.in_crowd = crowded ? touches.in_crowd + 1 : 0;
    touches.note(other, now);
  }
}

// --- The course of a contact.

void Audit::enter_contact(const Instant& now, const Collision& event) {
  const Index a = index_of(event.first), b = index_of(event.second);
  const int side = event.normal_velocity < 0 ? 1 : -1;
  JointMotion motion(needles_[a], needles_[b], nearest_separation(needles_[a], needles_[b]), side,
                     space_.around(needles_[a].record.r).rounding());
  joints_[a] = joints_[b] = std::make_shared<Joint>(Joint{a, b, now, std::move(motion)});
  take_continuation(a, b);  // f stays 0 until the contact ends
}

void Audit::cut_contact(Index i, const Instant& now) {
  if (!joints_[i]) return;
  cuts_.push_back({joints_[i], now});
  joints_[i] = nullptr;
}

// As all needles are kicked, contacts end without a report, on their sides.
void Audit::part_all(const Instant& now) {
  for (Index i = 0; i < joints_.size(); ++i) {
    if (!joints_[i]) continue;
    const Joint& joint = *joints_[i];
    if (setup_.sliding->elastic_strikes) last_touches_[i].note(joint.other(i), now);
    if (joint.first == i && is_chosen(joint.first, joint.second)) {
      continuations_[key_of(joint.first, joint.second)] = {
          nearest_separation(needles_[joint.first], needles_[joint.second]),
          {Start::touching, joint.motion.side(), 0.0}};
    }
  }
  joints_.assign(joints_.size(), nullptr);
}

// A contact that has been cut before, of which no end is reported, goes on.
void Audit::settle_cuts(const Instant& now, bool at_end) {
  std::vector<Cut> settled;
  std::erase_if(cuts_, [&](const Cut& cut) {
    const bool is_over = at_end || cut.time < now;
    if (is_over) settled.push_back(cut);
    return is_over;
  });
  for (const Cut& cut : settled) go_on_sliding(cut);
}

void Audit::go_on_sliding(const Cut& cut) {
  const Joint& joint = *cut.joint;
  const Index a = joint.first, b = joint.second;
  const int side = joint.motion.side();
  const bool still_joined = joints_[a] == cut.joint || joints_[b] == cut.joint;
  if (!still_joined) {  // both have been struck: they are free, on their side
    if (is_chosen(a, b)) {
      continuations_[key_of(a, b)] = {nearest_separation(needles_[a], needles_[b]),
                                      {Start::touching, side, 0.0}};
    }
    return;
  }
  const Index rest = joints_[a] == cut.joint ? a : b;
  Needle renewed = present(rest, cut.time);
  if (!resumed_) {
    check_partners(rest, joint.other(rest), cut.time);
    check_walls(rest, cut.time, nullptr);
  }
  needles_[rest] = renewed;
  needles_[rest].worn = 0;
  const Vector<double> r12 = nearest_separation(needles_[a], needles_[b]);
  const std::array<AuditedBody, 2> bodies = {needles_[a].body, needles_[b].body};
  const Touch touch(relative_state(needles_[a].record, needles_[b].record, r12), bodies);
  const bool may_stay = std::abs(touch.normal_velocity) <= normal_noise(renewed, renewed, touch) &&
                        touch.pressing(side) > -touch.noise;
  if (!may_stay && !resumed_) report(Kind::missed, a, b, cut.time);
  JointMotion motion(needles_[a], needles_[b], r12, side,
                     space_.around(needles_[a].record.r).rounding());
  joints_[a] = joints_[b] = std::make_shared<Joint>(Joint{a, b, cut.time, std::move(motion)});
}

// Needles that approach as their contact has been cut collide next.
void Audit::check_owed(const Instant& now, const Happening* happening) {
  if (!owed_) return;
  const auto& [a, b] = *owed_;
  const bool is_paid = happening && happening->is_collision() && needles_[a].record.time == now &&
                       index_of(happening->event.first) == a &&
                       index_of(happening->event.second) == b;
  if (is_paid) return;
  if (!resumed_) report(Kind::wrong_rule, a, b, needles_[a].record.time);
  owed_.reset();
}

// The contact of a needle, if it is in one, should not have ended before.
void Audit::check_held(Index i, const Instant& now) {
  if (!joints_[i]) return;
  Joint& joint = *joints_[i];
  const double s = elapsed<double>(joint.begin, now).middle;
  if (!joint.motion.follow(s)) {
    ++findings_.undecided;
    return;
  }
  const double off = relative_tolerance * s + 2 * resolution + slack_;
  const auto end = joint.motion.first_below(-1, 0, s - off);
  if (end) report(Kind::missed, joint.first, joint.second, joint.begin, *end);
}

// --- The end of a contact.

namespace {

bool may_be_over(const JointMotion::Room& room, double off) {
  return room.value - std::abs(room.rate) * off <= room.noise;
}

double uncertain_end(double s) { return relative_tolerance * s + 2 * resolution; }

}  // namespace

void Audit::check_end_time(const Joint& at, const Instant& now) {
  Joint& joint = *joints_[at.first];
  const double s = elapsed<double>(joint.begin, now).middle, off = uncertain_end(s);
  if (!joint.motion.follow(s)) {
    ++findings_.undecided;
    return;
  }
  if (joint.motion.first_below(-1, 0, s - off)) {
    report(Kind::late, joint.first, joint.second, now);
    return;
  }
  const auto rooms = joint.motion.rooms_at(s);
  if (std::ranges::any_of(rooms, [&](const auto& room) { return may_be_over(room, off); })) return;
  const double soon = s + early_reach / static_cast<double>(joint.motion.touch_at(s).rate);
  const bool is_early = joint.motion.follow(soon) && joint.motion.first_below(-1, s, soon);
  report(is_early ? Kind::early : Kind::spurious, joint.first, joint.second, now);
}

// By force they part on their side, at a tip they pass each other; 0 if both may be.
int Audit::side_after_end(Joint& joint, const Instant& now) const {
  const double s = elapsed<double>(joint.begin, now).middle, off = uncertain_end(s);
  joint.motion.follow(s);
  bool by_force = false, by_tip = false;
  double least = HUGE_VAL;
  bool least_is_force = false;
  for (const JointMotion::Room& room : joint.motion.rooms_at(s)) {
    if (may_be_over(room, off)) (room.is_of_force ? by_force : by_tip) = true;
    const double relative = room.value / room.noise;
    if (relative < least) least_is_force = room.is_of_force, least = relative;
  }
  if (by_force && by_tip) return 0;
  const bool force = by_force || (!by_tip && least_is_force);
  return force ? joint.motion.side() : -joint.motion.side();
}

// How far the report of an end is from needles that go on as they were.
double Audit::excess_over_contact(const Joint& joint, const Instant& now,
                                  const Collision& event) const {
  const Needle a = present(joint.first, now), b = present(joint.second, now);
  const std::array needles = {&a, &b};
  const Touch touch(relative_state(a.record, b.record, nearest_separation(a, b)), {a.body, b.body});
  Excess excess;
  const auto add = [&](double off, double explained) { excess.add(std::abs(off), explained); };
  for (const double p : event.impulse) add(p, 0x1p-1000);
  add(event.energy_change, 0x1p-1000);
  const double sine = static_cast<double>(touch.sine);
  const double speeds = static_cast<double>(touch.speeds);
  const double length = std::min(a.body.length, b.body.length);
  const double s = elapsed<double>(joint.begin, now).middle;
  const double rounding = space_.around(a.record.r).rounding();
  const std::array noises = {noise_of(joint.motion, 0, s), noise_of(joint.motion, 1, s)};
  const std::array arms = {event.arm_first, event.arm_second};
  for (std::size_t i = 0; i < 2; ++i) {
    const Record& record = needles[i]->record;
    const AuditedBody& body = needles[i]->body;
    const StateAfterCollision& after = event.after[i];
    const double noise = noises[i];
    add(static_cast<double>(touch.arms[i] - arms[i]),
        (4 * std::max(noises[0], noises[1]) * length + rounding) / sine);
    for (int axis = 0; axis < 3; ++axis) {
      double moved = after.position[axis] - record.r[axis];
      moved -= space_.box[axis] * space_.boxes_along<double>(axis, moved);
      add(moved, noise * length + rounding);
      add(after.orientation[axis] - record.u[axis], noise);
      const double off = 4 * noise * speeds;
      add(after.velocity[axis] - record.v[axis], off + 0x1p-50 * norm(record.v));
      add(after.angular_velocity[axis] - record.w[axis], off * (2 + body.k) / body.length);
    }
  }
  return excess.most();
}

void Audit::check_contact_end(const Instant& now, const Collision& event) {
  const Index a = index_of(event.first), b = index_of(event.second);
  const std::shared_ptr<Joint> joint = joints_[a] ? joints_[a] : joints_[b];
  check_partners(a, b, now);
  check_partners(b, a, now);
  for (const Index i : {a, b}) check_walls(i, now, nullptr);
  if (!joint || joint->first != a || joint->second != b || now < joint->begin) {
    report(Kind::spurious, a, b, now);
    check_flight(a, b, now);
    return;
  }
  const double excess = excess_over_contact(*joint, now, event);
  if (joint_of(a, b)) {
    check_end_time(*joint, now);
    if (excess > 1) report(Kind::wrong_rule, a, b, now);
    return;
  }
  // A strike has cut it: they part if they move apart, and else they collide, which is reported
  // next.
  const Needle first = present(a, now), second = present(b, now);
  const Touch touch(relative_state(first.record, second.record, nearest_separation(first, second)),
                    {first.body, second.body});
  const Extended apart = joint->motion.side() * touch.normal_velocity;
  const Extended noise = normal_noise(first, second, touch);
  if (excess > 1 ? apart > noise : apart < -noise) report(Kind::wrong_rule, a, b, now);
}

void Audit::follow_contact_end(const Instant& now, const Collision& event) {
  const Index a = index_of(event.first), b = index_of(event.second);
  const std::shared_ptr<Joint> joint = joints_[a] ? joints_[a] : joints_[b];
  const bool is_known = joint && joint->first == a && joint->second == b;
  const bool by_itself = is_known && joint_of(a, b);
  const bool parts = !is_known || by_itself || excess_over_contact(*joint, now, event) <= 1;
  Start start{Start::collided, is_known ? joint->motion.side() : 0, {}};
  if (by_itself) start.side = side_after_end(*joint, now);
  if (by_itself && start.side == 0 && !resumed_) ++findings_.undecided;
  for (const Index i : {a, b}) {
    if (parts) {
      const StateAfterCollision& after = event.after[i == a ? 0 : 1];
      needles_[i] = Needle(Record{now, vector(after.position), vector(after.velocity),
                                  vector(after.orientation), vector(after.angular_velocity)},
                           needles_[i].body);
    } else {
      needles_[i] = present(i, now);
    }
    has_collided_[i] = true;
  }
  if (is_known) {
    std::erase_if(cuts_, [&](const Cut& cut) { return cut.joint == joint; });
    for (const Index i : {a, b}) {
      if (joints_[i] == joint) joints_[i] = nullptr;
    }
  }
  if (parts) {
    note_meeting(a, b, now, false);
  } else {
    start.kind = Start::touching;
    start.gap = 0;
    owed_ = {a, b};
  }
  if (is_chosen(a, b)) {
    continuations_[key_of(a, b)] = {nearest_separation(needles_[a], needles_[b]), start};
  }
}

}  // namespace needlework::audit
