#include "src/picture/camera.h"

#include <gtest/gtest.h>

#include <cmath>

namespace needlework::picture {
namespace {

constexpr Frame frame{10, 20, 410, 320};

Region box_of(const Vector& edges) { return {{0, 0, 0}, edges}; }

CameraSettings looking(double azimuth, double elevation, bool orthographic = false) {
  return {azimuth, elevation, orthographic};
}

TEST(Camera, ShowsTheWholeBoxInItsFrame) {
  for (const Vector& box : {Vector{1, 1, 1}, Vector{30, 2.1, 2.1}, Vector{3, 3, 50}}) {
    for (const bool orthographic : {false, true}) {
      for (const double azimuth : {0.0, 33.0, 120.0, 271.0}) {
        for (const double elevation : {-90.0, -20.0, 0.0, 24.0, 90.0}) {
          const Camera camera(box_of(box), 0, looking(azimuth, elevation, orthographic), frame);
          double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
          for (const auto& [from, to] : edges_of(box_of(box), camera)) {
            for (const Vector& corner : {from, to}) {
              const Seen seen = camera.see(corner);
              left = std::min(left, seen.place.x);
              right = std::max(right, seen.place.x);
              top = std::min(top, seen.place.y);
              bottom = std::max(bottom, seen.place.y);
              EXPECT_GT(seen.scale, 0);
              EXPECT_GE(seen.nearness, -1e-9);
              EXPECT_LE(seen.nearness, 1 + 1e-9);
            }
          }
          EXPECT_GE(left, frame.left - 1e-6);
          EXPECT_LE(right, frame.right + 1e-6);
          EXPECT_GE(top, frame.top - 1e-6);
          EXPECT_LE(bottom, frame.bottom + 1e-6);
          // It fills the frame in one direction.
          EXPECT_TRUE(std::abs(right - left - 400) < 1e-6 || std::abs(bottom - top - 300) < 1e-6);
        }
      }
    }
  }
}

TEST(Camera, LooksAlongXAtNoAngles) {
  const Camera camera(box_of({10, 10, 10}), 0, looking(0, 0, true), frame);
  const Seen middle = camera.see({5, 5, 5});
  EXPECT_NEAR(middle.place.x, 210, 1e-9);
  EXPECT_NEAR(middle.place.y, 170, 1e-9);
  EXPECT_NEAR(middle.scale, 30, 1e-9);
  const Seen along_y = camera.see({5, 6, 5}), along_z = camera.see({5, 5, 6});
  EXPECT_NEAR(along_y.place.x, 240, 1e-9);  // to the right
  EXPECT_NEAR(along_z.place.y, 140, 1e-9);  // upwards
  EXPECT_NEAR(camera.see({10, 5, 5}).nearness, 1, 1e-9);
  EXPECT_NEAR(camera.see({0, 5, 5}).nearness, 0, 1e-9);
}

TEST(Camera, ShowsNearThingsLargerInPerspectiveOnly) {
  const Camera perspective(box_of({10, 10, 10}), 0, looking(0, 0), frame);
  EXPECT_GT(perspective.see({10, 5, 5}).scale, 1.5 * perspective.see({0, 5, 5}).scale);
  const Camera orthographic(box_of({10, 10, 10}), 0, looking(0, 0, true), frame);
  EXPECT_EQ(orthographic.see({10, 5, 5}).scale, orthographic.see({0, 5, 5}).scale);
}

TEST(Camera, ListsTheEdgesOfTheNearestCornerLast) {
  const Vector box{4, 5, 6};
  const Camera camera(box_of(box), 0, looking(30, 20), frame);
  const auto edges = edges_of(box_of(box), camera);
  ASSERT_EQ(edges.size(), 12);
  for (std::size_t i = 0; i < 12; ++i) {
    const bool at_nearest = edges[i].first == box || edges[i].second == box;
    EXPECT_EQ(at_nearest, i >= 9);
    double length = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      length += edges[i].second[axis] - edges[i].first[axis];
    }
    EXPECT_TRUE(length == 4 || length == 5 || length == 6);
  }
}

TEST(Camera, LooksAtTheMiddleOfTheRegion) {
  const Region region{{-1, 2, 3}, {9, 12, 23}};
  const Seen seen = Camera(region, 0, looking(0, 0, true), frame).see({4, 7, 13});
  EXPECT_NEAR(seen.place.x, 210, 1e-9);
  EXPECT_NEAR(seen.place.y, 170, 1e-9);
}

TEST(Camera, SeesPlanesFromTheSideWhereItIs) {
  const Region region = box_of({10, 10, 10});
  for (const bool orthographic : {false, true}) {
    const Camera above(region, 0, looking(30, 20, orthographic), frame);
    const Camera below(region, 0, looking(30, -20, orthographic), frame);
    EXPECT_TRUE(above.is_above(2, 0));
    EXPECT_FALSE(below.is_above(2, 0));
    EXPECT_FALSE(below.is_above(2, 10));
  }
  // Level with the middle, the ceiling is seen from below and the floor from above.
  const Camera level(region, 0, looking(30, 0), frame);
  EXPECT_TRUE(level.is_above(2, 0));
  EXPECT_FALSE(level.is_above(2, 10));
}

}  // namespace
}  // namespace needlework::picture
