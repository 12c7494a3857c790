#include "tests/support/pair_families.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "tests/support/contact_state.h"

namespace needlework::test {
namespace {

constexpr double rod_spin = 3.4641016151377544;  // sqrt(2k), k = 6: thermal at T = 1

/// Where on each needle the contact is.
std::array<double, 2> any_arms(Random& random, const Lengths& lengths) {
  const double first = lengths[0] * random.uniform(-0.5, 0.5);
  return {first, lengths[1] * random.uniform(-0.5, 0.5)};
}

/// A time for the built contact, and a horizon that sometimes ends before it.
NeedlePair before(const PairState& state, Random& random, double longest) {
  const double time = longest * random.uniform(0.05, 1);
  return before_contact(state, time, time * random.uniform(0.9, 3));
}

NeedlePair thermal(Random& random, const Lengths& lengths, double k) {
  const Vec<double> entry = random.direction();
  // Flux through the sphere: the normal component is Rayleigh distributed.
  const Vec<double> free = random.normal_vector(std::sqrt(2.0));
  const double inwards = 2 * std::sqrt(random.exponential());
  const Vec<double> velocity = free - (dot(free, entry) + inwards) * entry;
  const Vec<double> centre = random.normal_vector(std::sqrt(0.5));
  const double delay = random.uniform(0, 0.3);
  const double reach = 0.5 * (lengths[0] + lengths[1]);  // of the bounding spheres
  const double crossing = -2 * reach * dot(entry, velocity) / dot(velocity, velocity);
  const Vec<double> place = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  NeedlePair pair;
  pair.first.position = place + (reach * entry - delay * velocity);
  pair.second.position = place;
  pair.first.velocity = centre + 0.5 * velocity;
  pair.second.velocity = centre - 0.5 * velocity;
  for (FreeNeedle* needle : {&pair.first, &pair.second}) {
    const Vec<double> u = random.direction();
    const Vec<double> w = random.normal_vector(std::sqrt(2 * k));
    needle->orientation = u;
    needle->angular_velocity = w - dot(w, u) * u;
  }
  pair.horizon = 1.05 * (delay + crossing);
  return pair;
}

NeedlePair draw_rods(Random& random, const Lengths& lengths) { return thermal(random, lengths, 6); }
NeedlePair draw_dumbbells(Random& random, const Lengths& lengths) {
  return thermal(random, lengths, 2);
}

NeedlePair parallel(Random& random, const Lengths& lengths, double least, double most) {
  // Slow rotation keeps the pair nearly parallel all the time, fast one leads through it.
  const double spin = random.coin() ? rod_spin : random.log_uniform(1e-4, 1);
  const PairState state = draw_contact(random, {.angle_sine = random.log_uniform(least, most),
                                                .arms = any_arms(random, lengths),
                                                .spin = {spin, spin}});
  return before(state, random, 1);
}

NeedlePair draw_parallel(Random& random, const Lengths& lengths) {
  return parallel(random, lengths, 1e-7, 1e-1);
}
NeedlePair draw_parallel_to_rounding(Random& random, const Lengths& lengths) {
  return parallel(random, lengths, 1e-16, 1e-7);
}

NeedlePair tip(Random& random, const Lengths& lengths, double least, double most) {
  const double offset = random.log_uniform(least, most);
  const bool outside = random.coin();
  const double tip = (random.coin() ? 1 : -1) * (outside ? 0.5 + offset : 0.5 - offset);
  const double other = random.uniform(-0.5, 0.5);
  const bool first = random.coin();
  const std::array<double, 2> arms = {lengths[0] * (first ? tip : other),
                                      lengths[1] * (first ? other : tip)};
  const PairState state = draw_contact(random, {.arms = arms, .spin = {rod_spin, rod_spin}});
  NeedlePair pair = before(state, random, 1);
  if (outside) pair.contact_time.reset();
  return pair;
}
NeedlePair draw_tip(Random& random, const Lengths& lengths) {
  return tip(random, lengths, 1e-13, 1e-3);
}
NeedlePair draw_tip_to_rounding(Random& random, const Lengths& lengths) {
  return tip(random, lengths, 1e-16, 1e-13);
}

NeedlePair draw_tip_to_tip(Random& random, const Lengths& lengths) {
  std::array<double, 2> arms = lengths;
  bool inside = true;
  for (double& arm : arms) {
    const double offset = random.log_uniform(1e-13, 1e-2);
    const bool out = random.below(4) == 0;
    inside &= !out;
    arm *= (random.coin() ? 1 : -1) * (out ? 0.5 + offset : 0.5 - offset);
  }
  const PairState state = draw_contact(random, {.arms = arms, .spin = {rod_spin, rod_spin}});
  NeedlePair pair = before(state, random, 1);
  if (!inside) pair.contact_time.reset();
  return pair;
}

NeedlePair grazing(Random& random, const Lengths& lengths, double low, double high) {
  PairState state =
      draw_contact(random, {.arms = any_arms(random, lengths), .spin = {rod_spin, rod_spin}});
  const Real sine = norm(cross(state.first.orientation, state.second.orientation));
  const double apart = random.log_uniform(low, high);
  const bool miss = random.coin();
  // f = f2 ((t - t*)^2 - apart^2 / 4) / 2, or with a plus: no velocity along f, and a gap.
  push(state, -slopes(state).f1 / sine);
  const Real gap = slopes(state).f2 * Real(apart) * Real(apart) / 8 * (miss ? 1 : -1);
  state.first.position = state.first.position + Real(gap / sine) * contact_normal(state);
  push(state, -slopes(state).f1 / sine);
  NeedlePair pair = before(state, random, 1);
  if (miss) {
    pair.contact_time.reset();
  } else {
    *pair.contact_time -= apart / 2;
  }
  return pair;
}

NeedlePair draw_grazing(Random& random, const Lengths& lengths) {
  return grazing(random, lengths, 1e-10, 1e-2);
}
NeedlePair draw_grazing_to_rounding(Random& random, const Lengths& lengths) {
  return grazing(random, lengths, 1e-12, 1e-10);
}

NeedlePair just_collided(Random& random, const Lengths& lengths, double soonest, double latest) {
  PairState state =
      draw_contact(random, {.arms = any_arms(random, lengths), .spin = {rod_spin, rod_spin}});
  const bool comes_back = random.below(4) > 0;
  const double after = random.log_uniform(soonest, latest);
  if (comes_back) {
    // f1 + f2 after / 2 = 0; both are linear in the normal velocity.
    PairState other = state;
    push(other, Real(1));
    const auto value = [&](const PairState& at) {
      const Slopes s = slopes(at);
      return Real(s.f1 + s.f2 * Real(after) / 2);
    };
    const Real here = value(state), slope = value(other) - here;
    push(state, -here / slope);
  }
  NeedlePair pair = before_contact(state, 0, random.uniform(1.5, 3) * (comes_back ? after : 1));
  pair.just_collided = true;
  if (comes_back) pair.contact_time = after;
  return pair;
}
NeedlePair draw_just_collided(Random& random, const Lengths& lengths) {
  return just_collided(random, lengths, 1e-6, 1);
}
NeedlePair draw_back_to_rounding(Random& random, const Lengths& lengths) {
  return just_collided(random, lengths, 1e-12, 1e-6);
}

NeedlePair draw_fast_spin(Random& random, const Lengths& lengths) {
  const double fast = random.log_uniform(1, 1e4);
  const double other = random.coin() ? fast : random.log_uniform(1, 1e4);
  const PairState state =
      draw_contact(random, {.arms = any_arms(random, lengths), .spin = {fast, other}});
  // |w| t stays below about 1e3 up to the horizon.
  return before(state, random, std::min(1.0, 100 / std::max(fast, other)));
}

NeedlePair draw_still(Random& random, const Lengths& lengths) {
  const int which = random.below(3);
  const double reach = random.uniform(0.3, 0.6);
  const double first = reach * random.uniform(-1, 1), second = reach * random.uniform(-1, 1);
  const std::array<double, 2> arms = {lengths[0] * first, lengths[1] * second};
  const PairState state = draw_contact(
      random, {.arms = arms, .spin = {which == 0 ? rod_spin : 0, which == 1 ? rod_spin : 0}});
  NeedlePair pair = before(state, random, 1);
  if (std::abs(first) >= 0.5 || std::abs(second) >= 0.5) pair.contact_time.reset();
  return pair;
}

NeedlePair draw_slow(Random& random, const Lengths& lengths) {
  NeedlePair pair = thermal(random, lengths, 6);
  if (random.coin()) return slowed(pair, 600);
  const double factor = random.log_uniform(1e-12, 1e-1);
  for (FreeNeedle* needle : {&pair.first, &pair.second}) {
    needle->velocity = factor * needle->velocity;
    needle->angular_velocity = factor * needle->angular_velocity;
  }
  pair.horizon /= factor;
  return pair;
}

NeedlePair draw_planar(Random& random, const Lengths& lengths) {
  PairState state = draw_contact(random, {.spin = {0, 0}});
  // Half of the planes are normal to an axis, where the directors stay in them exactly.
  Vec<Real> e1 = {Real(0), Real(0), Real(0)}, e2 = e1, e3 = e1;
  if (random.coin()) {
    const int axis = random.below(3);
    e1[axis] = 1;
    e2[(axis + 1) % 3] = 1;
    e3[(axis + 2) % 3] = 1;
  } else {
    e1 = Real(1 / norm(state.first.orientation)) * state.first.orientation;
    e3 = cross(e1, state.second.orientation);
    e3 = Real(1 / norm(e3)) * e3;
    e2 = cross(e3, e1);
  }
  const double angle = random.uniform(0, 6);
  const double between = random.coin() ? random.uniform(0, 6) : random.log_uniform(1e-8, 1);
  const auto director = [&](double a) { return Real(cos(Real(a))) * e1 + Real(sin(Real(a))) * e2; };
  const double spin = rod_spin * random.normal();
  const double other = random.below(4) > 0 ? rod_spin * random.normal() : spin;
  const Vec<Real> point = state.first.position;
  state.first.orientation = director(angle);
  state.second.orientation = director(angle + between);
  state.first.angular_velocity = Real(spin) * e3;
  state.second.angular_velocity = Real(other) * e3;
  const std::array<double, 2> arms = any_arms(random, lengths);
  state.first.position = point - Real(arms[0]) * state.first.orientation;
  state.second.position = point - Real(arms[1]) * state.second.orientation;
  return before(state, random, 1);
}

NeedlePair draw_mixed_scales(Random& random, const Lengths& lengths) {
  const bool fast = random.coin();
  const double spin = fast ? 1e6 : 1e-6;
  const PairState state =
      draw_contact(random, {.arms = any_arms(random, lengths), .spin = {spin, spin}});
  return before(state, random, fast ? 1e-4 : 1);
}

/// FNV-1a, so that different families with the same seed are unrelated.
std::uint64_t hash(std::string_view text) {
  std::uint64_t value = 0xcbf29ce484222325u;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return value;
}

template <class Change>
NeedlePair changed(NeedlePair pair, Change change) {
  change(pair.first);
  change(pair.second);
  return pair;
}

}  // namespace

const std::vector<PairFamily>& pair_families() {
  static const std::vector<PairFamily> families = {
      {"thermal-k6", true, false, draw_rods},
      {"thermal-k2", true, false, draw_dumbbells},
      {"parallel", false, false, draw_parallel},
      {"tip", false, false, draw_tip},
      {"grazing", false, true, draw_grazing},
      {"just-collided", false, false, draw_just_collided},
      {"fast-spin", false, false, draw_fast_spin},
      {"still", false, false, draw_still},
      {"slow", false, false, draw_slow},
      {"planar", false, false, draw_planar},
      {"mixed-scales", false, false, draw_mixed_scales},
      {"parallel-to-rounding", false, true, draw_parallel_to_rounding},
      {"tip-to-rounding", false, true, draw_tip_to_rounding},
      {"back-to-rounding", false, true, draw_back_to_rounding},
      {"tip-to-tip", false, false, draw_tip_to_tip},
      {"grazing-to-rounding", false, true, draw_grazing_to_rounding},
  };
  return families;
}

std::vector<NeedlePair> draw_pairs(std::string_view family, std::size_t count, std::uint64_t seed,
                                   const Lengths& lengths) {
  for (const PairFamily& candidate : pair_families()) {
    if (candidate.name != family) continue;
    Random random(seed ^ hash(family));
    std::vector<NeedlePair> pairs;
    pairs.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      NeedlePair& pair = pairs.emplace_back(candidate.draw(random, lengths));
      pair.family = candidate.name;
      pair.first.length = lengths[0];
      pair.second.length = lengths[1];
    }
    return pairs;
  }
  throw std::invalid_argument("no family of pairs is named " + std::string(family));
}

NeedlePair exchanged(const NeedlePair& pair) {
  NeedlePair other = pair;
  std::swap(other.first, other.second);
  return other;
}

NeedlePair mirrored(const NeedlePair& pair) {
  return changed(pair, [](FreeNeedle& needle) {
    needle.position = -1.0 * needle.position;
    needle.orientation = -1.0 * needle.orientation;
    needle.velocity = -1.0 * needle.velocity;
  });
}

NeedlePair slowed(const NeedlePair& pair, int power) {
  NeedlePair other = changed(pair, [&](FreeNeedle& needle) {
    for (int i = 0; i < 3; ++i) {
      needle.velocity[i] = std::ldexp(needle.velocity[i], -power);
      needle.angular_velocity[i] = std::ldexp(needle.angular_velocity[i], -power);
    }
  });
  other.horizon = std::ldexp(pair.horizon, power);
  if (pair.contact_time) other.contact_time = std::ldexp(*pair.contact_time, power);
  return other;
}

NeedlePair advanced(const NeedlePair& pair, double time) {
  NeedlePair other = changed(pair, [&](FreeNeedle& needle) {
    const double length = needle.length;
    needle = rounded(flown(read(needle), Real(time)));
    needle.length = length;
  });
  other.horizon = pair.horizon - time;
  other.just_collided = false;
  other.contact_time.reset();
  return other;
}

NeedlePair reversed(const NeedlePair& pair) {
  NeedlePair other = changed(advanced(pair, pair.horizon), [](FreeNeedle& needle) {
    needle.velocity = -1.0 * needle.velocity;
    needle.angular_velocity = -1.0 * needle.angular_velocity;
  });
  other.horizon = pair.horizon;
  return other;
}

}  // namespace needlework::test
