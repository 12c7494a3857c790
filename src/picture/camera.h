// How a box is seen from outside.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "src/picture/point.h"

namespace needlework::picture {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b);

struct CameraSettings {
  double azimuth = 33;    ///< from where one looks: from the x axis towards the y axis [degrees]
  double elevation = 24;  ///< above the plane of x and y [degrees]
  bool orthographic = false;
};

/// A part of the picture that the box has to fit into [pixels].
struct Frame {
  double left, top, right, bottom;
};

/// A point as it is seen.
struct Seen {
  Point place;          ///< in the picture [pixels]
  double scale = 1;     ///< pixels per unit of length at its distance
  double nearness = 0;  ///< 0 and 1 in the farthest and the nearest corner of the box
};

/// Looks at the middle of a box; z points upwards.
class Camera {
 public:
  /// The box with a margin of this width around it fills the frame in one direction.
  Camera(const Vector& box, double margin, const CameraSettings& settings, const Frame& frame);

  Seen see(const Vector& point) const;

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

/// The twelve edges of the box; those of its corner nearest to the camera are the last three.
std::vector<std::pair<Vector, Vector>> edges_of(const Vector& box, const Camera& camera);

}  // namespace needlework::picture
