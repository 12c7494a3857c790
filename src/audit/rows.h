// Uniform shear as the audit knows it: rows of images that slide, computed in 113 bits.
#pragma once

#include <cstdint>

#include "src/audit/flight.h"
#include "src/audit/quad.h"

namespace needlework::audit {

/// The row of boxes above slides along x by velocity * t from its start. Lengths and times are in
/// the units of the audit.
class Rows {
 public:
  /// How far the row above has slid: `boxes` edges, modulo 2^32, and `offset`.
  struct Slide {
    double offset = 0;
    std::uint32_t boxes = 0;
  };

  Rows(double velocity, double start, double edge, double height)
      : velocity_(velocity), start_(start), edge_(edge), height_(height) {}

  double velocity() const { return velocity_; }
  Slide at(const Instant& time) const {
    using std::floor;
    const Quad slid = Quad(start_) + Quad(velocity_) * (Quad(time.epoch) + Quad(time.offset));
    const Quad boxes = floor(slid / edge_);
    return {static_cast<double>(slid - boxes * edge_),
            static_cast<std::uint32_t>(static_cast<std::int64_t>(boxes))};
  }
  /// The velocity of the flow along x at a height y.
  double flow(double y) const { return velocity_ / height_ * y; }
  /// The image of a needle so many rows up, as if it were another needle; `begin` is the time in
  /// whose slide boxes along x are counted.
  template <class Needle>
  Needle image(const Needle& needle, std::int32_t rows, const Instant& begin) const {
    if (rows == 0) return needle;
    auto record = needle.record;
    const double age = elapsed<double>(record.time, begin).middle;
    record.r[0] += rows * (at(begin).offset - velocity_ * age);
    record.v[0] += rows * velocity_;
    Needle out(record, needle.body);
    out.worn = needle.worn;
    return out;
  }
  /// The same needle, with the velocity that it has beside the flow then.
  template <class Needle>
  Needle beside_flow(const Needle& needle, const Instant& now) const {
    auto record = needle.record;
    record.v[0] -= flow(record.r[1] + record.v[1] * elapsed<double>(record.time, now).middle);
    return Needle(record, needle.body);
  }

 private:
  double velocity_, start_, edge_, height_;
};

}  // namespace needlework::audit
