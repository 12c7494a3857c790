#include "kernels/sliding_motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernels/sliding_frame.h"

namespace needlework::kernels {
namespace {

constexpr int stages = SlidingStep::stages, components = SlidingStep::components;
using Components = std::array<double, components>;

// Nodes and weights of Gauss and Legendre for ten points on [-1, 1], the positive half.
constexpr std::array<double, 5> half_nodes = {0.14887433898163121088, 0.43339539412924719080,
                                              0.67940956829902440623, 0.86506336668898451073,
                                              0.97390652851717172008};
constexpr std::array<double, 5> half_weights = {0.29552422471475287017, 0.26926671930999635509,
                                                0.21908636251598204400, 0.14945134915058059315,
                                                0.06667134430868813759};

// P_0 to P_10 at 2 tau - 1.
constexpr std::array<double, stages + 1> legendre(double z) {
  std::array<double, stages + 1> p{};
  p[0] = 1;
  p[1] = z;
  for (int k = 1; k < stages; ++k) p[k + 1] = ((2 * k + 1) * z * p[k] - k * p[k - 1]) / (k + 1);
  return p;
}

// Their integrals over tau from 0.
constexpr std::array<double, stages> integrals(double z) {
  const std::array<double, stages + 1> p = legendre(z);
  std::array<double, stages> out{};
  out[0] = (z + 1) / 2;
  for (int k = 1; k < stages; ++k) out[k] = (p[k + 1] - p[k - 1]) / (2 * (2 * k + 1));
  return out;
}

struct Collocation {
  std::array<double, stages> node{};  // in [0, 1]
  // From values at the nodes, [k][node]: the coefficient of P_k.
  std::array<std::array<double, stages>, stages> coefficient{};
  // From the same, [end][node]: the integral from 0 to a node.
  std::array<std::array<double, stages>, stages> integral{};
};

constexpr Collocation make_collocation() {
  Collocation out;
  for (int i = 0; i < stages; ++i) {
    const int half = i < 5 ? 4 - i : i - 5;
    const double z = i < 5 ? -half_nodes[half] : half_nodes[half];
    out.node[i] = (1 + z) / 2;
    const std::array<double, stages + 1> p = legendre(z);
    for (int k = 0; k < stages; ++k)
      out.coefficient[k][i] = (2 * k + 1) * (half_weights[half] / 2) * p[k];
  }
  for (int i = 0; i < stages; ++i) {
    const std::array<double, stages> up_to = integrals(2 * out.node[i] - 1);
    for (int j = 0; j < stages; ++j) {
      for (int k = 0; k < stages; ++k) out.integral[i][j] += up_to[k] * out.coefficient[k][j];
    }
  }
  return out;
}

constexpr Collocation collocation = make_collocation();

void put(Components& out, int first, const Vec3d& a) {
  out[first] = a.x, out[first + 1] = a.y, out[first + 2] = a.z;
}

Vec3d get(const Components& in, int first) { return {in[first], in[first + 1], in[first + 2]}; }

Components packed(const SlidingState& s) {
  Components out;
  put(out, 0, s.r), put(out, 3, s.u_first), put(out, 6, s.u_second);
  put(out, 9, s.v), put(out, 12, s.w_first), put(out, 15, s.w_second);
  return out;
}

SlidingState unpacked(const Components& in) {
  return {get(in, 0), get(in, 9), get(in, 3), get(in, 6), get(in, 12), get(in, 15)};
}

// Without roots: the force times the normal needs none.
Components derivative(const SlidingBodies& bodies, const SlidingState& s) {
  const SlidingFrame frame = sliding_frame(bodies, s);
  const Vec3d push = frame.across * (-frame.bent / (frame.square * frame.inverse));
  const double masses = 1 / bodies.first.mass + 1 / bodies.second.mass;
  const double lever1 = frame.arm_first / bodies.first.inertia;
  const double lever2 = frame.arm_second / bodies.second.inertia;
  Components out;
  put(out, 0, s.v), put(out, 3, frame.turn_first), put(out, 6, frame.turn_second);
  put(out, 9, push * masses), put(out, 12, cross(s.u_first, push) * lever1);
  put(out, 15, cross(s.u_second, push) * -lever2);
  return out;
}

// What makes a change of a slope a displacement over the span: of centres in lengths, of directors
// in radians.
Components scale_of(const SlidingStep& step, double length) {
  Components out;
  for (int c = 0; c < components; ++c) {
    const double unit = c < 3 || (c >= 9 && c < 12) ? 1 / length : 1;
    out[c] = (c < 9 ? step.span : step.span * step.span) * unit;
  }
  return out;
}

using Rows = std::array<Components, stages>;

// The sum of weighted rows. The inner loops are over components, which compilers turn into vectors
// without changing the order of a sum; over so many of them as registers hold.
Components weighted(const Rows& rows, const std::array<double, stages>& weights) {
  constexpr int block = 6;
  Components out;
  for (int first = 0; first < components; first += block) {
    double sum[block]{};
    for (int k = 0; k < stages; ++k) {
      for (int c = 0; c < block; ++c) sum[c] += rows[k][first + c] * weights[k];
    }
    for (int c = 0; c < block; ++c) out[first + c] = sum[c];
  }
  return out;
}

// Whether the series has fallen to rounding within its terms. Next to parallel needles, and where
// the rate grows during the step, it has not.
bool is_resolved(const Rows& slopes, const Components& scale) {
  for (int c = 0; c < components; ++c) {
    if (std::abs(slopes[stages - 1][c]) * scale[c] > 0x1p-39) return false;
  }
  return true;
}

// Slopes by fixed-point iteration, down to rounding. Each node takes the newest slopes of those
// before it, so that changes fall by two decades in a turn. False if it does not get there, or if
// the slopes are not resolved.
bool collocate(const SlidingBodies& bodies, double length, SlidingStep& step) {
  const Components begin = packed(step.begin);
  const Components scale = scale_of(step, length);
  Rows values;  // of the slopes, at the nodes
  values.fill(derivative(bodies, step.begin));
  ++step.evaluations;
  double last = INFINITY;
  for (int turn = 0; turn < 40; ++turn) {
    Components changes{};
    for (int i = 0; i < stages; ++i) {
      Components y = weighted(values, collocation.integral[i]);
      for (int c = 0; c < components; ++c) y[c] = begin[c] + step.span * y[c];
      const Components slope = derivative(bodies, unpacked(y));
      for (int c = 0; c < components; ++c) changes[c] += std::abs(slope[c] - values[i][c]);
      values[i] = slope;
      // Nearer to those of the nodes behind than those at the beginning are.
      if (turn == 0) std::fill(values.begin() + i + 1, values.end(), slope);
    }
    step.evaluations += stages;
    double change = 0;  // by this turn, all together
    for (int c = 0; c < components; ++c) change += changes[c] * scale[c];
    if (!(change < INFINITY)) return false;
    // The next turn would change less than rounding, or rounding is all that changes.
    const bool has_arrived = turn > 0 && change * (change / last) < 0x1p-53;
    if (has_arrived || (change < 0x1p-42 && change >= last / 2)) {
      Rows slopes;  // by degree
      for (int k = 0; k < stages; ++k) {
        slopes[k] = weighted(values, collocation.coefficient[k]);
        for (int c = 0; c < components; ++c) step.slopes[c][k] = slopes[k][c];
      }
      return is_resolved(slopes, scale);
    }
    last = change;
  }
  return false;
}

// What is above 0 while the contact lasts: the force's push, and the room of both arms.
constexpr int bounds = 3;
std::array<double, bounds> room(const SlidingBodies& bodies, const SlidingState& state, int side) {
  const SlidingContact contact = sliding_contact(bodies, state);
  return {side * contact.force + contact.noise, bodies.first.half - std::abs(contact.arm_first),
          bodies.second.half - std::abs(contact.arm_second)};
}

class End {
 public:
  End(const SlidingBodies& bodies, SlidingStep& step, int side)
      : bodies_(bodies), step_(step), side_(side) {}

  // The step is cut into parts. A bound may pass 0 between two of them, or fall below 0 and return
  // around a smallest value.
  void find() {
    constexpr int parts = 16;
    std::array<std::array<double, bounds>, parts + 1> value;
    for (int n = 0; n <= parts; ++n) value[n] = room_at(step_.span * n / parts);
    step_.duration = step_.span;
    for (int b = 0; b < bounds; ++b) {
      for (int n = 0; n <= parts; ++n) {
        const double here = step_.span * n / parts;
        // The part in which another bound ends the step may hold an earlier end.
        if (n > 0 && step_.span * (n - 1) / parts >= step_.duration) break;
        if (value[n][b] < 0) {
          end_at(b, n == 0 ? 0 : root(b, step_.span * (n - 1) / parts, here));
          break;
        }
        if (n == 0 || n == parts || value[n - 1][b] < value[n][b] || value[n + 1][b] < value[n][b])
          continue;
        const double low = step_.span * (n - 1) / parts;
        const double lowest = least(b, low, step_.span * (n + 1) / parts);
        if (room_at(lowest)[b] < 0) {
          end_at(b, root(b, low, lowest));
          break;
        }
      }
    }
  }

 private:
  std::array<double, bounds> room_at(double elapsed) {
    ++step_.evaluations;
    return room(bodies_, step_.at(elapsed), side_);
  }

  void end_at(int bound, double elapsed) {
    if (step_.end != SlidingEnd::None && elapsed >= step_.duration) return;
    step_.duration = elapsed;
    step_.end = bound == 0 ? SlidingEnd::Force : SlidingEnd::Tip;
  }

  double root(int bound, double low, double high) {
    for (;;) {
      const double middle = low + (high - low) / 2;
      if (!(low < middle && middle < high)) return high;
      (room_at(middle)[bound] < 0 ? high : low) = middle;
    }
  }

  // Of a bound with one minimum, well enough: next to it the bound is flat.
  double least(int bound, double low, double high) {
    for (int n = 0; n < 40; ++n) {
      const double third = (high - low) / 3;
      const double left = low + third, right = high - third;
      if (room_at(left)[bound] < room_at(right)[bound])
        high = right;
      else
        low = left;
    }
    return low + (high - low) / 2;
  }

  const SlidingBodies& bodies_;
  SlidingStep& step_;
  int side_;
};

}  // namespace

// No polynomial of Legendre exceeds 1.
SlidingStep::Most SlidingStep::most() const {
  const auto of_slopes = [&](int first) {
    double square = 0;
    for (int c = first; c < first + 3; ++c) {
      double sum = 0;
      for (int k = 0; k < stages; ++k) sum += std::abs(slopes[c][k]);
      square += sum * sum;
    }
    return std::sqrt(square) * (1 + 0x1p-30);
  };
  const auto reached = [&](const Vec3d& from, double rate) {
    return (std::sqrt(dot(from, from)) + rate * span) * (1 + 0x1p-30);
  };
  Most out;
  out.acceleration = of_slopes(9);
  out.turned_faster_first = of_slopes(12);
  out.turned_faster_second = of_slopes(15);
  out.speed = reached(begin.v, out.acceleration);
  out.turning_first = reached(begin.w_first, out.turned_faster_first);
  out.turning_second = reached(begin.w_second, out.turned_faster_second);
  return out;
}

SlidingState SlidingStep::at(double elapsed) const {
  if (elapsed == 0) return begin;
  const std::array<double, stages> integral = integrals(2 * (elapsed / span) - 1);
  Components y = packed(begin);
  for (int c = 0; c < components; ++c) {
    double sum = 0;
    for (int k = 0; k < stages; ++k) sum += slopes[c][k] * integral[k];
    y[c] += span * sum;
  }
  return unpacked(y);
}

SlidingStep sliding_step(const SlidingBodies& bodies, const SlidingState& begin, int side,
                         double limit) {
  SlidingStep step;
  step.begin = begin;
  step.span = std::min(limit, 0.5 / sliding_contact(bodies, begin).rate);
  const double length = bodies.first.half + bodies.second.half;
  for (int halvings = 0; !collocate(bodies, length, step); ++halvings) {
    if (halvings == 60) {
      step.span = 0;
      step.end = SlidingEnd::Unresolvable;
      return step;
    }
    step.span /= 2;
  }
  End(bodies, step, side).find();
  return step;
}

SlidingState in_contact(const SlidingBodies& bodies, const SlidingState& state) {
  SlidingState out = state;
  out.u_first = out.u_first * (1 / std::sqrt(dot(out.u_first, out.u_first)));
  out.u_second = out.u_second * (1 / std::sqrt(dot(out.u_second, out.u_second)));
  out.w_first -= dot(out.w_first, out.u_first) * out.u_first;
  out.w_second -= dot(out.w_second, out.u_second) * out.u_second;
  const SlidingContact contact = sliding_contact(bodies, out);
  out.r -= contact.gap * contact.normal;
  return after_impulse(bodies, out, contact, -contact.speed / contact.inverse);
}

SlidingState state_after(const SlidingBodies& bodies, const SlidingStep& step) {
  return in_contact(bodies, step.at(step.duration));
}

}  // namespace needlework::kernels
