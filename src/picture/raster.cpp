#include "src/picture/raster.h"

#include <algorithm>
#include <cmath>

namespace needlework::picture {
namespace {

// A stroke as the set of points within a distance of a segment.
class Capsule {
 public:
  explicit Capsule(const Stroke& stroke)
      : from_(stroke.from), along_{stroke.to.x - stroke.from.x, stroke.to.y - stroke.from.y} {
    squared_length_ = along_.x * along_.x + along_.y * along_.y;
  }

  double distance(double x, double y) const {
    const double dx = x - from_.x, dy = y - from_.y;
    const double share =
        squared_length_ > 0
            ? std::clamp((dx * along_.x + dy * along_.y) / squared_length_, 0.0, 1.0)
            : 0;
    return std::hypot(dx - share * along_.x, dy - share * along_.y);
  }

  // The part of the segment in low <= y <= high, from the least to the greatest x.
  std::pair<double, double> x_range(double low, double high) const {
    double begin = 0, end = 1;
    if (along_.y != 0) {
      const auto [enter, leave] =
          std::minmax({(low - from_.y) / along_.y, (high - from_.y) / along_.y});
      begin = std::clamp(enter, 0.0, 1.0);
      end = std::clamp(leave, 0.0, 1.0);
    }
    return std::minmax({from_.x + begin * along_.x, from_.x + end * along_.x});
  }

 private:
  Point from_, along_;
  double squared_length_;
};

// The first and the last pixel whose middle could be within [low, high], of `count`.
std::pair<int, int> pixels_in(double low, double high, int count) {
  const auto pixel = [&](double x) { return static_cast<int>(std::clamp(x, -1.0, count + 1.0)); };
  return {std::max(0, pixel(std::floor(low))), std::min(count - 1, pixel(std::floor(high)))};
}

}  // namespace

Raster::Raster(int width, int height, Colour ground)
    : width_(width),
      height_(height),
      ground_(ground),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), ground) {}

void Raster::draw(const Stroke& stroke) {
  const Capsule capsule(stroke);
  // A line thinner than a pixel is as faint as it is thin.
  const double radius = std::max(stroke.width, 1.0) / 2, strength = std::min(stroke.width, 1.0);
  const double reach = radius + stroke.halo + 0.5;
  const auto [top, bottom] = pixels_in(std::min(stroke.from.y, stroke.to.y) - reach,
                                       std::max(stroke.from.y, stroke.to.y) + reach, height_);
  for (int y = top; y <= bottom; ++y) {
    const double middle = y + 0.5;
    const auto range = capsule.x_range(middle - reach, middle + reach);
    const auto [left, right] = pixels_in(range.first - reach, range.second + reach, width_);
    for (int x = left; x <= right; ++x) {
      const double distance = capsule.distance(x + 0.5, middle);
      if (distance >= reach) continue;
      // The share of the pixel that is covered, as if the edge were straight and across.
      const double covered = strength * std::clamp(radius + 0.5 - distance, 0.0, 1.0);
      const double cleared = std::clamp(reach - distance, 0.0, 1.0);
      Colour& pixel = pixels_[index(x, y)];
      if (stroke.halo > 0) pixel = mixed(ground_, pixel, cleared);
      pixel = mixed(stroke.colour, pixel, covered);
    }
  }
}

}  // namespace needlework::picture
