#include "tests/support/sliding_oracle.h"

#include <algorithm>
#include <vector>

namespace needlework::test {
namespace {

using kernels::SlidingEnd;
using Needles = std::array<SlidingNeedle, 2>;

Vec<Quad> quad(const Vec3d& a) { return {Quad(a.x), Quad(a.y), Quad(a.z)}; }

struct Touch {
  Vec<Quad> n, relative;
  Quad sine, s1, s2, inverse, speed, gap, force;
};

Touch touch_of(const Needles& needles) {
  const SlidingNeedle &a = needles[0], &b = needles[1];
  Touch t;
  const Vec<Quad> x = cross(a.u, b.u), r = a.r - b.r;
  t.sine = norm(x);
  t.n = (1 / t.sine) * x;
  t.s1 = dot(cross(b.u, r), x) / dot(x, x);
  t.s2 = dot(cross(a.u, r), x) / dot(x, x);
  t.relative = (a.v + t.s1 * cross(a.w, a.u)) - (b.v + t.s2 * cross(b.w, b.u));
  t.speed = dot(t.relative, t.n);
  t.gap = dot(r, t.n);
  t.inverse = 1 / a.mass + 1 / b.mass + t.s1 * t.s1 / a.inertia + t.s2 * t.s2 / b.inertia;
  const Quad rate1 = dot(cross(b.u, t.relative), t.n) / t.sine;
  const Quad rate2 = dot(cross(a.u, t.relative), t.n) / t.sine;
  t.force = -2 * dot(rate1 * cross(a.w, a.u) - rate2 * cross(b.w, b.u), t.n) / t.inverse;
  return t;
}

// The rates of change of r, u, v, w, in the places of these.
Needles rates(const Needles& y) {
  const Touch t = touch_of(y);
  Needles out = y;
  for (int i = 0; i < 2; ++i) {
    const Quad push = i == 0 ? t.force : Quad(-t.force);
    const Quad arm = i == 0 ? t.s1 : t.s2;
    out[i].r = y[i].v;
    out[i].u = cross(y[i].w, y[i].u);
    out[i].v = (push / y[i].mass) * t.n;
    out[i].w = (arm * push / y[i].inertia) * cross(y[i].u, t.n);
  }
  return out;
}

// a + factor b, of r, u, v, w.
Needles sum(const Needles& a, const Quad& factor, const Needles& b) {
  Needles out = a;
  for (int i = 0; i < 2; ++i) {
    out[i].r = a[i].r + factor * b[i].r;
    out[i].u = a[i].u + factor * b[i].u;
    out[i].v = a[i].v + factor * b[i].v;
    out[i].w = a[i].w + factor * b[i].w;
  }
  return out;
}

Needles midpoint(const Needles& begin, const Quad& time, int steps) {
  const Quad h = time / steps;
  Needles last = begin, now = sum(begin, h, rates(begin));
  for (int n = 1; n < steps; ++n) {
    const Needles next = sum(last, 2 * h, rates(now));
    last = now;
    now = next;
  }
  // Gragg's smoothing.
  const Needles beyond = sum(last, h, rates(now));
  return sum(sum(now, Quad(-0.5), now), Quad(0.5), beyond);
}

Needles extrapolated(const Needles& begin, const Quad& time) {
  constexpr int columns = 9;
  std::vector<Needles> row;
  for (int j = 0; j < columns; ++j) {
    Needles value = midpoint(begin, time, 2 * (j + 1));
    for (int k = 1; k <= j; ++k) {
      const Quad ratio = Quad(j + 1) / (j + 1 - k);
      const Needles before = row[k - 1];
      row[k - 1] = value;
      value = sum(value, 1 / (ratio * ratio - 1), sum(value, Quad(-1), before));
    }
    row.push_back(value);
  }
  return row.back();
}

Quad rate_of(const Needles& y) {
  const Touch t = touch_of(y);
  const Quad spin = abs(dot(y[0].w, t.n)) + abs(dot(y[1].w, t.n));
  const Quad slip = norm(t.relative) / t.sine;
  return norm(y[0].w) + norm(y[1].w) + slip / y[0].half + slip / y[1].half + spin / t.sine;
}

Needles advanced(Needles y, Quad time) {
  if (time < 0) return extrapolated(y, time);
  while (time > 0) {
    const Quad most = Quad(0.3) / rate_of(y);
    const Quad step = time < most ? time : most;
    y = extrapolated(y, step);
    time -= step;
  }
  return y;
}

}  // namespace

SlidingOracle::SlidingOracle(const kernels::SlidingBodies& bodies,
                             const kernels::SlidingState& state, int side)
    : side_(side) {
  const Quad zero = 0;
  for (int i = 0; i < 2; ++i) {
    const kernels::SlidingBody& body = i == 0 ? bodies.first : bodies.second;
    SlidingNeedle& needle = needles_[i];
    needle.half = body.half, needle.mass = body.mass, needle.inertia = body.inertia;
    needle.r = needle.v = {zero, zero, zero};
    needle.u = quad(i == 0 ? state.u_first : state.u_second);
    needle.u = (1 / norm(needle.u)) * needle.u;
    needle.w = quad(i == 0 ? state.w_first : state.w_second);
    needle.w = needle.w - dot(needle.w, needle.u) * needle.u;
  }
  needles_[0].r = quad(state.r), needles_[0].v = quad(state.v);
  const Touch apart = touch_of(needles_);
  needles_[0].r = needles_[0].r - apart.gap * apart.n;
  const Touch t = touch_of(needles_);
  const Quad push = -t.speed / t.inverse;
  for (int i = 0; i < 2; ++i) {
    SlidingNeedle& needle = needles_[i];
    const Quad own = i == 0 ? push : Quad(-push);
    needle.v = needle.v + (own / needle.mass) * t.n;
    needle.w = needle.w + ((i == 0 ? t.s1 : t.s2) * own / needle.inertia) * cross(needle.u, t.n);
  }
}

void SlidingOracle::advance(const Quad& time) { needles_ = advanced(needles_, time); }

bool SlidingOracle::has_ended() const {
  const Touch t = touch_of(needles_);
  return side_ * t.force < 0 || abs(t.s1) > needles_[0].half || abs(t.s2) > needles_[1].half;
}

SlidingOracle::End SlidingOracle::end_near(double guess, SlidingEnd kind) const {
  Needles at = advanced(needles_, Quad(guess));
  const auto value = [&](const Needles& y) {
    const Touch t = touch_of(y);
    if (kind == SlidingEnd::Force) return Quad(side_ * t.force);
    const Quad first = y[0].half - abs(t.s1), second = y[1].half - abs(t.s2);
    return first < second ? first : second;
  };
  // Secants from the guess; one whose value is not near 0 goes far, which the caller sees.
  Quad time = guess, change = Quad(1e-7) / rate_of(at);
  Quad here = value(at);
  for (int n = 0; n < 5; ++n) {
    const Needles next = advanced(at, change);
    const Quad there = value(next);
    time += change;
    at = next;
    if (there == here) break;
    const Quad step = -there * change / (there - here);
    here = there;
    change = step;
    if (abs(change * rate_of(at)) < Quad(1e-26)) break;
  }
  return {time, kind};
}

Quad SlidingOracle::energy() const {
  Quad out = 0;
  for (const SlidingNeedle& a : needles_)
    out += (a.mass * dot(a.v, a.v) + a.inertia * dot(a.w, a.w)) / 2;
  const Vec<Quad> p = momentum();
  return out - dot(p, p) / (2 * (needles_[0].mass + needles_[1].mass));
}

Vec<Quad> SlidingOracle::momentum() const {
  return needles_[0].mass * needles_[0].v + needles_[1].mass * needles_[1].v;
}

Quad SlidingOracle::gap() const { return touch_of(needles_).gap; }
Quad SlidingOracle::speed() const { return touch_of(needles_).speed; }
Quad SlidingOracle::force() const { return touch_of(needles_).force; }

Quad SlidingOracle::force_by_curvature() const {
  const SlidingNeedle &a = needles_[0], &b = needles_[1];
  const Touch t = touch_of(needles_);
  const Vec<Quad> turn1 = cross(a.w, a.u), turn2 = cross(b.w, b.u), x = cross(a.u, b.u);
  const Quad squares = dot(a.w, a.w) + dot(b.w, b.w);
  const Quad bent = 2 * dot(a.v - b.v, cross(turn1, b.u) + cross(a.u, turn2)) +
                    dot(a.r - b.r, Quad(2) * cross(turn1, turn2) - squares * x);
  return -bent / (t.sine * t.inverse);
}

SlidingOracle::Difference SlidingOracle::difference(const kernels::SlidingState& state) const {
  const auto largest = [](const Vec<Quad>& a, const Vec3d& b) {
    const Vec<Quad> apart = a - quad(b);
    return static_cast<double>(
        std::max({Quad(abs(apart[0])), Quad(abs(apart[1])), Quad(abs(apart[2]))}));
  };
  const SlidingNeedle &a = needles_[0], &b = needles_[1];
  return {std::max({largest(a.r - b.r, state.r), largest(a.u, state.u_first),
                    largest(b.u, state.u_second)}),
          std::max({largest(a.v - b.v, state.v), largest(a.w, state.w_first),
                    largest(b.w, state.w_second)})};
}

}  // namespace needlework::test
