// Uniform shear: the row of boxes above slides along x over the one below.
#pragma once

#include <cstdint>

#include "kernels/double_double.h"
#include "src/box/vector.h"

namespace needlework {

/// How far the row of boxes above has slid at one instant, and how fast it does: by
/// `boxes` edges along x, modulo 2^32, and `offset` more.
struct RowSlide {
  double velocity = 0;  ///< [L / time]
  DoubleDouble offset;  ///< at least 0 and less than the edge, but for rounding [L]
  std::uint32_t boxes = 0;
};

/// Images that slide (Lees and Edwards): the row of boxes n rows up flies along x with n times the
/// velocity rate * (edge along y), which is rounded once and from then on stands for the rate. So
/// the needles of all boxes flow, on average, with rate * y.
///
/// The slide is known to 2^-100 of an edge at any age of a run. It is never added up: the share of
/// the edge by which rows slide in one epoch of the clock is a fraction of 128 bits, and so many
/// epochs are a multiple of it.
class Shear {
 public:
  /// `offset` is the slide at time 0, at least 0 and less than the edge along x.
  Shear(double rate, const Vector& edges, double offset);

  /// To be called when the length of an epoch is known: a power of two. [time]
  void set_epoch(double length);

  /// The velocity of the row above, and its rate: that velocity over the edge along y.
  double velocity() const { return velocity_; }
  double rate() const { return rate_; }
  /// The slide at time 0. [L]
  double start() const { return start_; }
  /// At the time `offset` after the begin of an epoch: as double, with a slide that is rounded to
  /// one.
  template <class Real = DoubleDouble>
  RowSlide at(std::int64_t epoch, double offset) const;
  /// Rows slide by fewer than 2^31 boxes in an epoch.
  bool is_followable() const { return boxes_per_epoch_ < 0x1p31; }

 private:
  double velocity_, rate_, edge_, start_;
  double boxes_per_epoch_ = 0;        ///< whole ones, of the speed
  std::uint64_t high_ = 0, low_ = 0;  ///< the rest, in 2^-64 and 2^-128 of an edge
};

/// A slide with the offset brought into the box, of any number of edges.
RowSlide reduced(double velocity, const DoubleDouble& offset, std::uint32_t boxes, double edge);

}  // namespace needlework
