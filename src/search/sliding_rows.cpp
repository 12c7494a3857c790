#include "src/search/sliding_rows.h"

#include <algorithm>
#include <cmath>

#include "src/physics/vectors.h"

namespace needlework {

SlidingRows::SlidingRows(const Gas& gas, const CellGrid& grid)
    : gas_(gas), grid_(grid), rows_(grid.counts()[1]), places_(grid.counts()[1]) {}

void SlidingRows::begin_again(Time now) {
  std::ranges::fill(places_, 0);
  base_ = now;
}

std::vector<std::int32_t> SlidingRows::carry(Time now) {
  const double edge = gas_.box.edge(0), elapsed = since_base(now);
  std::vector<std::int32_t> out;
  for (std::int32_t row = 0; row < grid_.counts()[1]; ++row) {
    const double place = place_of(row, elapsed), boxes = std::floor(place / edge);
    out.push_back(static_cast<std::int32_t>(boxes));
    places_[row] = place - boxes * edge;
  }
  base_ = now;
  return out;
}

SlidingRows::Seen SlidingRows::Present::see(const Record& record, double elapsed,
                                            double ahead) const {
  const CellGrid& grid = rows_.grid_;
  const Vec3d centre = rows_.gas_.motion(record).centre(elapsed);
  const Wrapped inside = box_.wrap({centre.x, centre.y + ahead, centre.z});
  const std::int32_t row =
      std::clamp(grid.cell_of(vector_of(inside.place))[1], 0, grid.counts()[1] - 1);
  const double beyond =
      std::floor((inside.place[0] - rows_.place_of(row, elapsed_)) / box_.edge(0));
  Seen out;
  out.row = row;
  out.boxes = shift_of(inside.boxes) + Shift{static_cast<std::int32_t>(beyond), 0, 0};
  out.flight = see_from(row, out.boxes, record, elapsed);
  // Rounding may have put it beyond the border of this row, by far less than searches allow for.
  const double step = grid.sides()[1] * 0x1p-40;
  for (;;) {
    const Vec3d seen = FreeFlight(out.flight).centre(elapsed);
    const std::int32_t entered = grid.cell_of({seen.x, seen.y + ahead, seen.z})[1];
    if (entered == row) return out;
    out.flight.r.y += entered < row ? step : -step;
  }
}

kernels::Flight SlidingRows::Present::see_from(std::int32_t row, const Shift& boxes,
                                               const Record& record, double elapsed) const {
  const Image<double> image = box_.image(boxes);
  kernels::Flight out = record.flight;
  out.v.x -= image.velocity.x + rows_.velocity_of(row + 0.5);
  const double x =
      (rows_.gas_.motion(record).centre(elapsed).x - image.place.x) - rows_.place_of(row, elapsed_);
  out.r.x = x - out.v.x * elapsed;
  out.r.y -= image.place.y;
  out.r.z -= image.place.z;
  return out;
}

SlidingRows::Beside SlidingRows::Present::beside(std::int32_t row, const SlidingRows& there,
                                                 std::int32_t other) const {
  const std::int32_t count = there.grid_.counts()[1], in_box = there.grid_.wrap(other, 1),
                     up = (other - in_box) / count;
  const RowSlide& above = box_.row_above();
  const double edge = box_.edge(0);
  const double place =
      (there.place_of(in_box, elapsed_) + up * above.offset.hi) - rows_.place_of(row, elapsed_);
  const auto boxes = static_cast<double>(static_cast<std::int64_t>(place / edge));
  // In the frame of the row, images by whole boxes of its place lie on each other; those of the row
  // of boxes count from where that has slid to.
  const std::uint32_t slid = static_cast<std::uint32_t>(up) * above.boxes;
  return {place - boxes * edge, there.velocity_of(other + 0.5) - rows_.velocity_of(row + 0.5),
          static_cast<std::int32_t>(0u - slid -
                                    static_cast<std::uint32_t>(static_cast<std::int32_t>(boxes)))};
}

}  // namespace needlework
