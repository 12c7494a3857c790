// Edges of the box that move along their axes with the walls on them: pistons.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "kernels/double_double.h"
#include "src/box/vector.h"

namespace needlework {

/// One that moves at constant velocity from time 0 on and may come to rest at a place. Its place is
/// never added up, so that it is as good at any age of a run. By default it is at rest.
class MovingEdge {
 public:
  MovingEdge() = default;
  /// `stop_at` is where it comes to rest, ahead of it.
  MovingEdge(double start, double velocity, std::optional<double> stop_at)
      : start_(start), velocity_(velocity) {
    if (!stop_at) return;
    stop_ = *stop_at;
    halt_ = two_sum(stop_, -start_) / DoubleDouble(velocity_);
  }

  double start() const { return start_; }                  ///< place at time 0 [L]
  double velocity() const { return velocity_; }            ///< until it comes to rest [L / time]
  double stop() const { return stop_; }                    ///< where, if it does [L]
  const DoubleDouble& halt_time() const { return halt_; }  ///< when; else infinite [time]

  bool moves() const { return velocity_ != 0; }
  bool is_at_rest(const DoubleDouble& time) const {
    return !moves() || to_double(time - halt_) >= 0;
  }
  DoubleDouble place(const DoubleDouble& time) const {
    if (!moves()) return start_;
    return is_at_rest(time) ? DoubleDouble(stop_)
                            : DoubleDouble(start_) + DoubleDouble(velocity_) * time;
  }

 private:
  double start_ = 0, velocity_ = 0, stop_ = 0;
  DoubleDouble halt_ = std::numeric_limits<double>::infinity();
};

/// The low and the high edge along each axis.
class MovingEdges {
 public:
  /// Of a box with its low edges at 0, all at rest.
  explicit MovingEdges(const Vector& edges) {
    for (std::size_t axis = 0; axis < 3; ++axis) edges_[axis][1] = MovingEdge(edges[axis], 0, {});
  }

  void set(std::size_t axis, bool is_high, const MovingEdge& edge) { edges_[axis][is_high] = edge; }
  const MovingEdge& of(std::size_t axis, bool is_high) const { return edges_[axis][is_high]; }

  Vector low(const DoubleDouble& time) const {
    return {to_double(edges_[0][0].place(time)), to_double(edges_[1][0].place(time)),
            to_double(edges_[2][0].place(time))};
  }
  /// How far the two edges along an axis are apart. [L]
  double distance(std::size_t axis, const DoubleDouble& time) const {
    return to_double(edges_[axis][1].place(time) - edges_[axis][0].place(time));
  }
  Vector distances(const DoubleDouble& time) const {
    return {distance(0, time), distance(1, time), distance(2, time)};
  }
  /// The least and the largest place of the edges along an axis up to a time. [L]
  std::array<double, 2> range(std::size_t axis, double until) const {
    const auto [low, high] = edges_[axis];
    return {std::min(low.start(), to_double(low.place(until))),
            std::max(high.start(), to_double(high.place(until)))};
  }
  /// Of the edges that move at a time, the sum of their speeds. [L / time]
  double speed(const DoubleDouble& time) const {
    double out = 0;
    for (const auto& both : edges_) {
      for (const MovingEdge& edge : both)
        out += edge.is_at_rest(time) ? 0 : std::abs(edge.velocity());
    }
    return out;
  }
  /// The times at which edges come to rest before one, in order, with 0 and that one.
  std::vector<double> pieces(double until) const {
    std::vector<double> out{0, until};
    for (const auto& both : edges_) {
      for (const MovingEdge& edge : both) {
        const double halt = to_double(edge.halt_time());
        if (halt > 0 && halt < until) out.push_back(halt);
      }
    }
    std::ranges::sort(out);
    return out;
  }
  /// The first time at which the edges along an axis are less than `least` apart; infinite if they
  /// never are.
  double time_of_distance(std::size_t axis, double least) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    const std::vector<double> pieces = this->pieces(never);
    for (std::size_t n = 0; n + 1 < pieces.size(); ++n) {
      const double begin = pieces[n], apart = distance(axis, begin) - least;
      if (apart < 0) return begin;
      double closing = 0;
      for (const MovingEdge& edge : edges_[axis]) {
        if (!edge.moves() || to_double(edge.halt_time()) <= begin) continue;
        closing += &edge == &edges_[axis][0] ? edge.velocity() : -edge.velocity();
      }
      const double at = closing > 0 ? begin + apart / closing : never;
      if (at < pieces[n + 1]) return at;
    }
    return never;
  }
  /// The mean from time 0 to another of a product of edges, such as the volume: exact, as they are
  /// polynomials of no more than the third degree between the times at which edges come to rest.
  template <class Product>
  double mean(double until, const Product& product) const {
    if (!(until > 0)) return product(distances(0.0));
    double sum = 0;
    const std::vector<double> pieces = this->pieces(until);
    for (std::size_t n = 0; n + 1 < pieces.size(); ++n) {
      const double begin = pieces[n], end = pieces[n + 1];
      sum += (end - begin) * (product(distances(begin)) + product(distances(end)) +
                              4 * product(distances(begin + (end - begin) / 2)));
    }
    return sum / (6 * until);
  }

 private:
  std::array<std::array<MovingEdge, 2>, 3> edges_;
};

}  // namespace needlework
