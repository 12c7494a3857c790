#include "src/search/sliding_rows.h"

#include <algorithm>
#include <cmath>

#include "src/physics/vectors.h"

namespace needlework {

SlidingRows::SlidingRows(const Gas& gas, const CellGrid& grid)
    : gas_(gas), grid_(grid), rows_(grid.counts()[1]), places_(grid.counts()[1]) {
  begin_again({});
}

void SlidingRows::begin_again(Time now) {
  std::ranges::fill(places_, 0);
  base_ = now;
  set_now(now);
}

void SlidingRows::set_now(Time now) {
  now_ = now;
  box_ = gas_.box_at(now);
}

std::vector<std::int32_t> SlidingRows::carry(Time now) {
  set_now(now);
  const double edge = gas_.box.edge(0);
  std::vector<std::int32_t> out;
  for (std::int32_t row = 0; row < grid_.counts()[1]; ++row) {
    const double place = place_of(row), boxes = std::floor(place / edge);
    out.push_back(static_cast<std::int32_t>(boxes));
    places_[row] = place - boxes * edge;
  }
  base_ = now;
  return out;
}

double SlidingRows::place_of(std::int32_t row) const {
  return places_[row] + velocity_of(row + 0.5) * gas_.clock.difference(now_, base_);
}

SlidingRows::Seen SlidingRows::see(const Record& record, double elapsed, double ahead) const {
  const auto motion = gas_.motion(record);
  const Vec3d centre = motion.centre(elapsed);
  // A body is in the row into whose cells it is placed.
  const double forward = std::copysign(ahead, motion.velocity(elapsed).y);
  const Wrapped inside = box_.wrap({centre.x, centre.y + forward, centre.z});
  std::int32_t row =
      std::clamp(grid_.cell_of(vector_of(inside.place))[1], 0, grid_.counts()[1] - 1);
  const double beyond = std::floor((inside.place[0] - place_of(row)) / gas_.box.edge(0));
  Seen out;
  out.boxes = shift_of(inside.boxes) + Shift{static_cast<std::int32_t>(beyond), 0, 0};
  out.flight = see_from(row, out.boxes, record, elapsed);
  // Rounding may have put it beyond the border of this row, by far less than searches allow for.
  const double step = grid_.sides()[1] * 0x1p-40;
  for (;;) {
    const Vec3d seen = FreeFlight(out.flight).centre(elapsed);
    const std::int32_t entered = grid_.cell_of({seen.x, seen.y + forward, seen.z})[1];
    if (entered == row) return out;
    out.flight.r.y += entered < row ? step : -step;
  }
}

kernels::Flight SlidingRows::see_from(std::int32_t row, const Shift& boxes, const Record& record,
                                      double elapsed) const {
  const Image<DoubleDouble> image = box_.image<DoubleDouble>(boxes);
  kernels::Flight out = record.flight;
  out.v.x -= image.velocity.x + velocity_of(row + 0.5);
  const double x = to_double(DoubleDouble(gas_.motion(record).centre(elapsed).x) - image.place.x) -
                   place_of(row);
  out.r.x = x - out.v.x * elapsed;
  out.r.y -= to_double(image.place.y);
  out.r.z -= to_double(image.place.z);
  return out;
}

SlidingRows::Beside SlidingRows::beside(std::int32_t row, std::int32_t other) const {
  const std::int32_t in_box = grid_.wrap(other, 1), up = (other - in_box) / grid_.counts()[1];
  const RowSlide& above = box_.row_above();
  const double edge = gas_.box.edge(0);
  const double place = (place_of(in_box) + up * above.offset.hi) - place_of(row);
  const double boxes = std::nearbyint(place / edge);
  // In the frame of the row, images by whole boxes of its place lie on each other; those of the row
  // of boxes count from where that has slid to.
  const std::uint32_t slid = static_cast<std::uint32_t>(up) * above.boxes;
  return {place - boxes * edge, velocity_of(other - row),
          static_cast<std::int32_t>(0u - slid -
                                    static_cast<std::uint32_t>(static_cast<std::int32_t>(boxes)))};
}

}  // namespace needlework
