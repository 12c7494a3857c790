// The box: how long its edges are, along which axes it is periodic, and so where the images of a
// needle are and how they move.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kernels/double_double.h"
#include "needlework/state.h"
#include "src/box/shear.h"
#include "src/box/vector.h"

namespace needlework {

/// Number of boxes added to a needle's recorded centre along each axis; along x modulo 2^32 where
/// rows of boxes slide, as there are more the longer they have slid.
using Shift = std::array<std::int32_t, 3>;
/// a == b, without a call of memcmp.
inline bool same(const Shift& a, const Shift& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}
inline Shift operator-(const Shift& a, const Shift& b) {
  const auto less = [&](std::size_t axis) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a[axis]) -
                                     static_cast<std::uint32_t>(b[axis]));
  };
  return {less(0), less(1), less(2)};
}
inline Shift operator-(const Shift& a) { return Shift{} - a; }
inline Shift operator+(const Shift& a, const Shift& b) { return a - (-b); }

/// The same where there is no bound on it: whole numbers.
using Boxes = std::array<double, 3>;
/// Of numbers that fit.
inline Shift shift_of(const Boxes& boxes) {
  return {static_cast<std::int32_t>(boxes[0]), static_cast<std::int32_t>(boxes[1]),
          static_cast<std::int32_t>(boxes[2])};
}

/// By how much the centre of an image and its velocity differ from those of the needle.
template <class Real>
struct Image {
  Vec3<Real> place;  ///< [L]
  Vec3d velocity;    ///< [L / time]
};

/// A centre in the box, and the number of boxes subtracted from it. A needle that is wrapped is one
/// of its images from then on: its velocity, too, is less by that of the image of these boxes.
struct Wrapped {
  std::array<double, 3> place;
  Boxes boxes;
};

/// The box at one instant, such as that of a state; of a gas it is Gas::box_at(). Along an axis
/// that is not periodic there are no images, and centres may be beyond the edges. Where rows of
/// boxes slide, the box above is RowSlide beside this one, and flies past it.
class Box {
 public:
  Box() = default;
  Box(const Vector& edges, const std::array<bool, 3>& periodic = {true, true, true})
      : edges_(edges), periodic_(periodic) {}

  /// The same at an instant at which the row above has slid so far.
  Box with_rows(const RowSlide& above) const {
    Box out = *this;
    out.slides_ = true;
    out.above_ = above;
    return out;
  }

  const Vector& edges() const { return edges_; }  ///< [L]
  const RowSlide& row_above() const { return above_; }
  double edge(std::size_t axis) const { return edges_[axis]; }
  double longest_edge() const { return std::max({edges_[0], edges_[1], edges_[2]}); }
  double sum_of_edges() const { return (edges_[0] + edges_[1]) + edges_[2]; }
  double volume() const { return edges_[0] * edges_[1] * edges_[2]; }
  /// The vectors by which images are apart, one for each axis. [L]
  std::array<Vector, 3> vectors() const {
    return {Vector{edges_[0], 0, 0}, Vector{to_double(above_.offset), edges_[1], 0},
            Vector{0, 0, edges_[2]}};
  }

  const std::array<bool, 3>& periodic() const { return periodic_; }
  bool is_periodic(std::size_t axis) const { return periodic_[axis]; }
  bool is_periodic() const { return periodic_[0] && periodic_[1] && periodic_[2]; }

  bool has_image(const Shift& shift) const {
    return (periodic_[0] || shift[0] == 0) && (periodic_[1] || shift[1] == 0) &&
           (periodic_[2] || shift[2] == 0);
  }
  /// The image that is a whole number of boxes away: a Shift, or Boxes. Exact as DoubleDouble.
  template <class Real = double, class Number>
  Image<Real> image(const std::array<Number, 3>& boxes) const {
    Image<Real> out{{product<Real>(boxes[0], edges_[0]), product<Real>(boxes[1], edges_[1]),
                     product<Real>(boxes[2], edges_[2])},
                    {}};
    if (slides_ && boxes[1] != 0) slide(boxes[0], boxes[1], out);
    return out;
  }
  /// Boxes as files count them: along x as if the row above had slid by row_above().offset alone.
  Shift counted_now(const Shift& shift) const {
    if (!slides_) return shift;
    return {static_cast<std::int32_t>(boxes_now(shift[0], shift[1])), shift[1], shift[2]};
  }
  /// A centre less so many boxes, with one rounding.
  Vector less(const Vector& centre, const Boxes& boxes) const {
    const Vec3dd image = this->image<DoubleDouble>(boxes).place;
    return {to_double(DoubleDouble(centre[0]) - image.x),
            to_double(DoubleDouble(centre[1]) - image.y),
            to_double(DoubleDouble(centre[2]) - image.z)};
  }

  /// A centre, at least 0 and less than the edge along each periodic axis.
  Wrapped wrap(const Vector& centre) const {
    return slides_ ? wrap_in_rows(centre) : wrap_at_rest(centre);
  }
  /// The same where rows do not slide.
  Wrapped wrap_at_rest(const Vector& centre) const {
    const Along x = wrap_along(0, centre[0]), y = wrap_along(1, centre[1]),
                z = wrap_along(2, centre[2]);
    return {{x.place, y.place, z.place}, {x.boxes, y.boxes, z.boxes}};
  }
  /// The place of a centre in the box around it, in shares of the edges, also along axes that are
  /// not periodic.
  Vector share(const Vector& centre) const {
    Vector out = wrap(centre).place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out[axis] /= edges_[axis];
      out[axis] -= std::floor(out[axis]);
    }
    return out;
  }

  /// The boxes by which the second of two centres must be shifted to be nearest to the first;
  /// `apart` is the first less the second. [L]
  Boxes nearest(const Vec3d& apart) const {
    if (slides_) return nearest_in_rows(apart);
    return {nearest_along(0, apart.x), nearest_along(1, apart.y), nearest_along(2, apart.z)};
  }
  /// From the nearest image of the second centre to the first. [L]
  Vec3d shortest(const Vec3d& apart) const { return apart - image(nearest(apart)).place; }

  /// Calls visit(shift) for each image of the second of two needles whose centre comes within
  /// `reach` of that of the first in the time to come, and for some others; r and v are the centre
  /// and the velocity of the first less those of the second. [L, L / time, L, time]
  template <class Visit>
  void for_each_image_near(const Vec3d& r, const Vec3d& v, double reach, double time,
                           Visit&& visit) const {
    if (slides_) return for_each_image_in_rows(r, v, reach, time, visit);
    const Range x = images_along(0, r.x, v.x, reach, time);
    const Range y = images_along(1, r.y, v.y, reach, time);
    const Range z = images_along(2, r.z, v.z, reach, time);
    for (std::int32_t nx = x.first; nx <= x.last; ++nx) {
      for (std::int32_t ny = y.first; ny <= y.last; ++ny) {
        for (std::int32_t nz = z.first; nz <= z.last; ++nz) visit(Shift{nx, ny, nz});
      }
    }
  }

 private:
  struct Along {
    double place, boxes;
  };
  struct Range {
    std::int32_t first, last;
  };

  template <class Real>
  static Real product(double boxes, double edge) {
    if constexpr (std::is_same_v<Real, DoubleDouble>)
      return two_prod(boxes, edge);
    else
      return boxes * edge;
  }
  Along wrap_along(std::size_t axis, double x) const {
    return !periodic_[axis] || (x >= 0 && x < edges_[axis]) ? Along{x, 0}
                                                            : wrap_from_outside(axis, x);
  }
  Along wrap_from_outside(std::size_t axis, double x) const;
  double nearest_along(std::size_t axis, double apart) const {
    const double edge = edges_[axis];
    // A division is slow.
    if (!periodic_[axis] || std::abs(apart) <= 0.5 * edge) return 0;
    return std::nearbyint(apart / edge);
  }
  // The images m for which |r + v s - m edge| <= reach somewhere in [0, time], with a margin.
  Range images_along(std::size_t axis, double r, double v, double reach, double time) const {
    if (!periodic_[axis]) return {0, 0};
    const double edge = edges_[axis];
    const double wide = reach * (1 + 0x1p-10), travel = v == 0 ? 0 : v * time;
    return {static_cast<std::int32_t>(std::ceil((r + std::fmin(0, travel) - wide) / edge)),
            static_cast<std::int32_t>(std::floor((r + std::fmax(0, travel) + wide) / edge))};
  }

  // Adds to an image what the row is beside this one. In whole boxes of the present slide there are
  // few, however long rows have slid.
  template <class Real>
  void slide(double boxes, double rows, Image<Real>& image) const {
    image.place.x = product<Real>(boxes_now(boxes, rows), edges_[0]);
    if constexpr (std::is_same_v<Real, DoubleDouble>)
      image.place.x = image.place.x + above_.offset * DoubleDouble(rows);
    else
      image.place.x += above_.offset.hi * rows;
    image.velocity.x = above_.velocity * rows;
  }
  // Of an image so many rows up: those by which the reduced slide is less than what has been slid
  // are added, and taken away by boxes_ever().
  double boxes_now(double boxes, double rows) const {
    return modulo_32(modulo(boxes) + modulo(rows) * above_.boxes);
  }
  double boxes_ever(double boxes, double rows) const {
    return modulo_32(modulo(boxes) - modulo(rows) * above_.boxes);
  }
  static std::uint32_t modulo(double boxes) {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(boxes));
  }
  static double modulo_32(std::uint32_t boxes) { return static_cast<std::int32_t>(boxes); }
  Wrapped wrap_in_rows(const Vector& centre) const;
  // In which row an image is comes first: where it is along x depends on that.
  Boxes nearest_in_rows(const Vec3d& apart) const {
    const double y = nearest_along(1, apart.y);
    const double x = nearest_along(0, apart.x - y * above_.offset.hi);
    return {boxes_ever(x, y), y, nearest_along(2, apart.z)};
  }
  template <class Visit>
  void for_each_image_in_rows(const Vec3d& r, const Vec3d& v, double reach, double time,
                              Visit&& visit) const {
    const Range y = images_along(1, r.y, v.y, reach, time);
    const Range z = images_along(2, r.z, v.z, reach, time);
    for (std::int32_t ny = y.first; ny <= y.last; ++ny) {
      const Range x =
          images_along(0, r.x - ny * above_.offset.hi, v.x - ny * above_.velocity, reach, time);
      for (std::int32_t nx = x.first; nx <= x.last; ++nx) {
        const auto ever = static_cast<std::int32_t>(boxes_ever(nx, ny));
        for (std::int32_t nz = z.first; nz <= z.last; ++nz) visit(Shift{ever, ny, nz});
      }
    }
  }

  Vector edges_{};
  std::array<bool, 3> periodic_{true, true, true};
  bool slides_ = false;
  RowSlide above_;
};

/// The box at the instant of the state.
inline Box box_of(const State& state) {
  const Box box(state.box, state.periodic);
  if (state.slide == 0 && state.shear_rate == 0) return box;
  return box.with_rows({state.shear_rate * state.box[1], DoubleDouble(state.slide), 0});
}

}  // namespace needlework
