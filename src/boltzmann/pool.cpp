#include "src/boltzmann/pool.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "src/physics/director.h"

namespace needlework::boltzmann {
namespace {

constexpr std::size_t longest_counted = 32;  // encounters of more collisions are counted together
// Covers rounding of a needle's fastest point.
constexpr double roundup = 1 + 0x1p-40;

double size_of(const Vec3d& a) { return std::sqrt(dot(a, a)); }
Vec3d vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

}  // namespace

Pool::Pool(const Settings& settings, std::uint64_t number, std::size_t needles)
    : settings_(settings),
      random_(settings.seed, number, RandomFor::boltzmann, 0),
      needles_(needles),
      encounters_of_(longest_counted) {
  const double inverse_inertia = 2 * settings.gas.k;
  Vec3d momentum{};
  for (Needle& needle : needles_) {
    needle.u = vector(random_.direction());
    needle.v = vector(random_.normal());
    needle.w = project_out(vector(random_.normal()), needle.u);
    momentum = momentum + needle.v;
  }
  double v_squared = 0, w_squared = 0;
  for (Needle& needle : needles_) {
    needle.v = needle.v - momentum * (1 / static_cast<double>(needles));
    v_squared += dot(needle.v, needle.v);
    w_squared += dot(needle.w, needle.w);
  }
  // Exactly the temperatures asked for.
  const auto count = static_cast<double>(needles);
  const double v_scale = std::sqrt(3 * count * settings.initial.t_tr / v_squared),
               w_scale =
                   std::sqrt(2 * count * settings.initial.t_rot * inverse_inertia / w_squared);
  for (Needle& needle : needles_) {
    needle.v = needle.v * v_scale;
    needle.w = needle.w * w_scale;
    set_fastest(needle);
  }
  find_fastest();
}

void Pool::set_fastest(Needle& needle) {
  needle.fastest = (size_of(needle.v) + 0.5 * size_of(needle.w)) * roundup;
  fastest_ = std::max(fastest_, needle.fastest);
}

void Pool::find_fastest() {
  fastest_ = 0;
  double squares = 0;
  for (const Needle& needle : needles_) {
    fastest_ = std::max(fastest_, needle.fastest);
    squares += dot(needle.v, needle.v);
  }
  t_tr_ = squares / (3 * static_cast<double>(needles_.size()));
  until_looked_ = needles_.size() / 8;
}

// At a random phase of its rotation.
Vec3d Pool::director(const Needle& needle) {
  if (needle.w == Vec3d{}) return needle.u;
  for (;;) {
    const Vec3d any = vector(random_.direction());
    const Vec3d out = project_out(any, normalised(needle.w));
    // Not of rounding errors.
    if (dot(out, out) > 0x1p-20) return normalised(out);
  }
}

void Pool::meet(Needle& a, Needle& b, const Touching& touching) {
  // The contact time follows the temperature, as it would follow the mean free time.
  const Encounter encounter(settings_.gas, settings_.contact_time / std::sqrt(t_tr_));
  Touching pair = touching;
  Course course{.collisions = 1};
  if (settings_.pairs == Pairs::single) {
    encounter.collide(pair);
  } else if (encounter.is_first(pair)) {
    course = encounter.follow(pair);
  } else {
    ++met_before_;
    return;
  }
  a.v = pair.needle[0].v, a.w = pair.needle[0].w;
  b.v = pair.needle[1].v, b.w = pair.needle[1].w;
  a.u = pair.needle[0].u, b.u = pair.needle[1].u;
  set_fastest(a);
  set_fastest(b);
  collisions_ += course.collisions;
  tc_collisions_ += course.tc_collisions;
  unfinished_ += !course.finished;
  ++encounters_of_[std::min<std::size_t>(course.collisions, longest_counted) - 1];
  if (until_looked_-- == 0) find_fastest();
}

void Pool::advance(double tau) {
  const auto count = static_cast<double>(needles_.size());
  const double end = tau / (2.0 / 3 * std::sqrt(std::numbers::pi));
  const auto any_of = [&](double n) { return static_cast<std::size_t>(random_.uniform() * n); };
  while (time_ < end) {
    // More than any pair's |u1 x u2| |V_n|.
    const double most = 2 * fastest_;
    const double rate = 0.5 * (count - 1) * most;
    time_ += rate > 0 ? random_.exponential() / rate : std::numeric_limits<double>::infinity();
    // Waiting times have no memory: the rest of this one is drawn anew.
    if (time_ >= end) break;
    const std::size_t i = any_of(count);
    std::size_t j = any_of(count - 1);
    j += j >= i;
    Needle &a = needles_[i], &b = needles_[j];
    const double drawn = most * random_.uniform();
    if (drawn >= a.fastest + b.fastest) continue;
    const std::array u{director(a), director(b)};
    const std::array arm{random_.uniform() - 0.5, random_.uniform() - 0.5};
    const Vec3d v = a.v - b.v + cross(a.w, u[0]) * arm[0] - cross(b.w, u[1]) * arm[1];
    if (drawn >= std::abs(dot(cross(u[0], u[1]), v))) continue;
    meet(a, b, touching({a.v, b.v}, u, {a.w, b.w}, arm));
  }
  time_ = end;
}

Sums Pool::sums() const {
  Sums out;
  for (const Needle& needle : needles_) {
    const double v = dot(needle.v, needle.v), w = dot(needle.w, needle.w);
    out.v2 += v, out.w2 += w, out.v4 += v * v, out.w4 += w * w, out.v2w2 += v * w;
  }
  out.needles = static_cast<double>(needles_.size());
  out.collisions = static_cast<double>(collisions_);
  return out;
}

void Pool::add_to(Result& result) const {
  result.met_before += met_before_;
  result.tc_collisions += tc_collisions_;
  result.unfinished += unfinished_;
  result.encounters_of.resize(longest_counted);
  for (std::size_t n = 0; n < longest_counted; ++n) {
    result.encounters_of[n] += encounters_of_[n];
    result.encounters += encounters_of_[n];
  }
}

}  // namespace needlework::boltzmann
