#include "kernels/trajectory_contact.h"

#include <cmath>
#include <limits>
#include <utility>

#include "kernels/closest_approach.h"
#include "kernels/root_between.h"

namespace needlework::kernels {
namespace {

// Needles farther apart, by the sum of their half lengths, do not touch, however small f is.
constexpr double touching_within = 0x1p-18;
constexpr int last_depth = 60;

int sign_of_number(double a) { return a > 0 ? 1 : a < 0 ? -1 : 0; }
double size(const Vec3d& a) { return std::sqrt(dot(a, a)); }

struct Relation {
  Vec3d r, u1, u2, x;
  double f, df;
};

class TrajectorySearch {
 public:
  TrajectorySearch(const TrajectoryPair& pair, EvaluationCounters& counters)
      : pair_(pair),
        counters_(counters),
        reach_(pair.half_first + pair.half_second),
        speed_(pair.first.speed + pair.second.speed),
        turning_(pair.first.turning + pair.second.turning) {
    if (pair.touch.touching) offset_ = pair.touch.gap - at(0).f;
  }

  Relation at(double s) {
    ++counters_.evaluated;
    const BodyState a = pair_.first.at(s), b = pair_.second.at(s);
    Relation out;
    out.r = (a.r - b.r) - pair_.shift;
    out.u1 = a.u;
    out.u2 = b.u;
    out.x = cross(a.u, b.u);
    const Vec3d turned = cross(cross(a.w, a.u), b.u) + cross(a.u, cross(b.w, b.u));
    out.f = dot(out.r, out.x) + offset_;
    out.df = dot(a.v - b.v, out.x) + dot(out.r, turned);
    return out;
  }

  Contact run(double from, double until) {
    const double last = std::min(pair_.first.lasts, pair_.second.lasts);
    from_ = from;
    until_ = until;
    const Relation start = at(0);
    if (pair_.touch_within > 0 && from == 0 && !pair_.touch.touching &&
        std::abs(start.f) <= pair_.touch_within && are_touching(start)) {
      Contact unknown;
      unknown.side_unknown = true;
      return unknown;
    }
    const int before = pair_.touch.touching ? pair_.touch.side : sign_of_number(start.f);
    Contact out;
    if (last > 0) search({0, last, before, sign_of_number(at(last).f)}, 0, out);
    return out;
  }

 private:
  struct Stretch {
    double begin, end;
    int before, after;  // signs of f at its ends
  };

  bool are_touching(const Relation& p) const {
    const HalfLengths<double> half = half_lengths(pair_.half_first, pair_.half_second);
    const double near = touching_within * reach_;
    return segment_distance_squared(p.r, p.u1, p.u2, p.x, dot(p.x, p.x), half) < near * near;
  }

  // Bound on |f''| for needles that are no farther apart than this.
  double most_bend(double distance) const {
    const double faster = pair_.first.turning_faster + pair_.second.turning_faster;
    return (pair_.first.acceleration + pair_.second.acceleration) + 2 * speed_ * turning_ +
           distance * (turning_ * turning_ + faster);
  }

  // The first contact of the stretch. False if there is none.
  bool search(const Stretch& stretch, int depth, Contact& out) {
    if (stretch.end < from_ || stretch.begin > until_) return false;
    // f(0) = 0 to the last digit. Of needles that merely touch f is continued, and its root ahead.
    const bool starts = pair_.touch.touching && pair_.touch.gap == 0 && stretch.begin == 0;
    const double half = 0.5 * (stretch.end - stretch.begin), middle = stretch.begin + half;
    if (depth == last_depth || !(stretch.begin < middle && middle < stretch.end)) {
      // Not at a touch that leads to no other side, nor where f cannot be told from 0.
      if (stretch.before == 0 || stretch.before != -stretch.after) return false;
      return accept(starts ? 0 : stretch.end, stretch.before, out);
    }
    const Relation here = at(middle);
    const double moved = speed_ * half, distance = size(here.r);
    if (distance > (reach_ + moved) * roundup) return false;
    const double bend = most_bend(reach_ + 2 * moved) * roundup;
    const double f = std::abs(here.f), slope = std::abs(here.df);
    if (f > (slope + 0.5 * bend * half) * half * roundup) return false;
    if (slope > bend * half) {
      // f is monotone.
      const int falls_to = sign_of_number(here.df);
      if (starts) return falls_to == -pair_.touch.side && accept(0, pair_.touch.side, out);
      if (stretch.before == falls_to || stretch.after != falls_to) return false;
      return accept(root(stretch, falls_to), -falls_to, out);
    }
    const int sign = sign_of_number(here.f);
    return search({stretch.begin, middle, stretch.before, sign}, depth + 1, out) ||
           search({middle, stretch.end, sign, stretch.after}, depth + 1, out);
  }

  // Of f that grows towards the sign `after`.
  double root(const Stretch& stretch, int after) {
    const auto value = [&](double s) {
      const Relation here = at(s);
      return std::pair(here.f, here.df);
    };
    return root_between(stretch.begin, stretch.end, RootSide::past, value,
                        [&](double f) { return sign_of_number(f) == after; });
  }

  bool accept(double s, int side, Contact& out) {
    if (s > until_) return false;
    if (!(pair_.touch.touching && s == 0)) {
      const Relation here = at(s);
      const double square = dot(here.x, here.x);
      if (!(std::abs(dot(cross(here.u2, here.r), here.x)) < pair_.half_first * square &&
            std::abs(dot(cross(here.u1, here.r), here.x)) < pair_.half_second * square))
        return false;
    }
    out.found = true;
    out.elapsed = DoubleDouble(s);
    out.side = side;
    return true;
  }

  const TrajectoryPair& pair_;
  EvaluationCounters& counters_;
  double reach_, speed_, turning_, offset_ = 0, from_ = 0, until_ = 0;
};

}  // namespace

Contact trajectory_contact(const TrajectoryPair& pair, double from, double until,
                           EvaluationCounters& counters) {
  return TrajectorySearch(pair, counters).run(from, until);
}

double trajectory_gap(const TrajectoryPair& pair, double s) {
  EvaluationCounters ignored;
  return TrajectorySearch(pair, ignored).at(s).f;
}

int trajectory_side_after(const TrajectoryPair& pair) {
  EvaluationCounters ignored;
  return sign_of_number(TrajectorySearch(pair, ignored).at(0).df);
}

ContactGeometry trajectory_geometry(const TrajectoryPair& pair, double s) {
  EvaluationCounters ignored;
  const Relation here = TrajectorySearch(pair, ignored).at(s);
  const double square = dot(here.x, here.x);
  ContactGeometry out;
  out.u_first = here.u1;
  out.u_second = here.u2;
  out.sin_angle = std::sqrt(square);
  out.normal = here.x * (1 / out.sin_angle);
  const auto within = [&](double arm, double half) { return std::clamp(arm, -half, half); };
  out.arm_first = within(dot(cross(here.u2, here.r), here.x) / square, pair.half_first);
  out.arm_second = within(dot(cross(here.u1, here.r), here.x) / square, pair.half_second);
  return out;
}

}  // namespace needlework::kernels
