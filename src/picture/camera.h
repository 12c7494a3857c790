// How a region with straight edges, such as the box, is seen from outside.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "src/box/vector.h"
#include "src/picture/point.h"

namespace needlework::picture {

double dot(const Vector& a, const Vector& b);

struct CameraSettings {
  double azimuth = 33;    ///< from where one looks: from the x axis towards the y axis [degrees]
  double elevation = 24;  ///< above the plane of x and y [degrees]
  bool orthographic = false;
};

/// A part of space between two corners [L]: rectangular, or tilted along x.
struct Region {
  Vector low{}, high{};
  double tilt = 0;  ///< of the upper end along y over the lower one [L]

  /// Where a point of the rectangle is in the region.
  Vector tilted(Vector point) const {
    if (tilt != 0) point[0] += tilt * (point[1] - low[1]) / (high[1] - low[1]);
    return point;
  }
};

/// A part of the picture that the region has to fit into [pixels].
struct Frame {
  double left, top, right, bottom;
};

/// A point as it is seen.
struct Seen {
  Point place;          ///< in the picture [pixels]
  double scale = 1;     ///< pixels per unit of length at its distance
  double nearness = 0;  ///< 0 and 1 in the farthest and the nearest corner of the region
};

/// Looks at the middle of a region; z points upwards.
class Camera {
 public:
  /// The region with a margin of this width around it fills the frame in one direction.
  Camera(const Region& region, double margin, const CameraSettings& settings, const Frame& frame);

  Seen see(const Vector& point) const;
  /// Whether a plane normal to this axis is seen from its side of larger coordinates.
  bool is_above(std::size_t axis, double place) const;

 private:
  /// Across, up and towards the camera, before the picture is scaled.
  Vector turned(const Vector& point) const;
  Seen unscaled(const Vector& point) const;

  Vector middle_;
  std::array<Vector, 3> axes_;
  double distance_ = 0;  ///< 0: infinite
  double nearest_ = 0;   ///< of a corner, from the middle towards the camera
  double pixels_ = 1;    ///< per unit of length in the middle
  Point shift_;
};

/// The twelve edges of the region; those of its corner nearest to the camera are the last three.
std::vector<std::pair<Vector, Vector>> edges_of(const Region& region, const Camera& camera);

}  // namespace needlework::picture
