#include "src/picture/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace needlework::picture {
namespace {

// Corner 0 to 7 of a region with a margin; bit i of the number is for axis i.
Vector corner(const Region& region, std::size_t number, double margin = 0) {
  Vector point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point[axis] =
        (number >> axis & 1) != 0 ? region.high[axis] + margin : region.low[axis] - margin;
  }
  return region.tilted(point);
}

}  // namespace

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Camera::Camera(const Region& region, double margin, const CameraSettings& settings,
               const Frame& frame) {
  const double degree = std::numbers::pi / 180;
  const double a = settings.azimuth * degree, e = settings.elevation * degree;
  axes_ = {Vector{-std::sin(a), std::cos(a), 0},
           Vector{-std::sin(e) * std::cos(a), -std::sin(e) * std::sin(a), std::cos(e)},
           Vector{std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)}};
  Vector edges;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    middle_[axis] = (region.low[axis] + region.high[axis]) / 2;
    edges[axis] = region.high[axis] - region.low[axis];
  }
  middle_ = region.tilted(middle_);
  edges[0] += std::abs(region.tilt);
  // Far enough for every corner to be in front of the camera.
  if (!settings.orthographic) distance_ = 1.4 * (std::sqrt(dot(edges, edges)) + 2 * margin);

  Point low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
  for (std::size_t i = 0; i < 8; ++i) {
    nearest_ = std::max(nearest_, turned(corner(region, i))[2]);
    const Point place = unscaled(corner(region, i, margin)).place;
    low = {std::min(low.x, place.x), std::min(low.y, place.y)};
    high = {std::max(high.x, place.x), std::max(high.y, place.y)};
  }
  pixels_ = std::min((frame.right - frame.left) / (high.x - low.x),
                     (frame.bottom - frame.top) / (high.y - low.y));
  shift_ = {(frame.left + frame.right) / 2 - pixels_ * (low.x + high.x) / 2,
            (frame.top + frame.bottom) / 2 - pixels_ * (low.y + high.y) / 2};
}

Vector Camera::turned(const Vector& point) const {
  Vector from_middle;
  for (std::size_t axis = 0; axis < 3; ++axis) from_middle[axis] = point[axis] - middle_[axis];
  return {dot(from_middle, axes_[0]), dot(from_middle, axes_[1]), dot(from_middle, axes_[2])};
}

Seen Camera::unscaled(const Vector& point) const {
  const Vector at = turned(point);
  const double scale = distance_ == 0 ? 1 : distance_ / (distance_ - at[2]);
  const double nearness = nearest_ > 0 ? (at[2] + nearest_) / (2 * nearest_) : 1;
  return {{scale * at[0], -scale * at[1]}, scale, nearness};
}

Seen Camera::see(const Vector& point) const {
  Seen seen = unscaled(point);
  seen.place = {shift_.x + pixels_ * seen.place.x, shift_.y + pixels_ * seen.place.y};
  seen.scale *= pixels_;
  return seen;
}

bool Camera::is_above(std::size_t axis, double place) const {
  const double towards = axes_[2][axis];
  return distance_ == 0 ? towards > 0 : middle_[axis] + distance_ * towards > place;
}

std::vector<std::pair<Vector, Vector>> edges_of(const Region& region, const Camera& camera) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < 8; ++i) {
    const auto nearness = [&](std::size_t n) { return camera.see(corner(region, n)).nearness; };
    if (nearness(i) > nearness(nearest)) nearest = i;
  }
  std::vector<std::pair<Vector, Vector>> edges;
  for (const bool last : {false, true}) {
    for (std::size_t i = 0; i < 8; ++i) {
      for (const std::size_t j : {i | 1, i | 2, i | 4}) {
        if (i == j || (i == nearest || j == nearest) != last) continue;
        edges.emplace_back(corner(region, i), corner(region, j));
      }
    }
  }
  return edges;
}

}  // namespace needlework::picture
