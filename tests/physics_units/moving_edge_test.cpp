// Edges of the box that move with walls, against numbers of 113 bits and sums of small steps.
#include "src/box/moving_edge.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "src/audit/quad.h"
#include "tests/support/random.h"

namespace needlework {
namespace {

using audit::Quad;

constexpr double never = std::numeric_limits<double>::infinity();

Quad quad(const DoubleDouble& a) { return Quad(a.hi) + Quad(a.lo); }

// Late in a run too, and just before it comes to rest.
TEST(MovingEdge, IsWhereItsVelocityHasBroughtItAtAnyAge) {
  test::Random random(5);
  for (int n = 0; n < 1000; ++n) {
    const double start = random.uniform(-20, 20), age = std::pow(10, random.uniform(-3, 9));
    const double velocity = random.uniform(-2, 2);
    const DoubleDouble time = two_sum(age, random.uniform(0, 1e-9));
    const Quad exact = Quad(start) + Quad(velocity) * quad(time);
    const double place = to_double(MovingEdge(start, velocity, {}).place(time));
    EXPECT_EQ(place, static_cast<double>(exact)) << n;
    // It stops a little later, and has stopped a little earlier.
    for (const double later : {1e-7, -1e-7}) {
      const double stop = static_cast<double>(exact + Quad(velocity * later));
      if (!((stop - start) / velocity > 0)) continue;
      const MovingEdge edge(start, velocity, stop);
      const bool at_rest = quad(time) >= (Quad(stop) - Quad(start)) / Quad(velocity);
      EXPECT_EQ(edge.is_at_rest(time), at_rest) << n;
      EXPECT_EQ(to_double(edge.place(time)), at_rest ? stop : place) << n;
      EXPECT_EQ(to_double(edge.halt_time()),
                static_cast<double>((Quad(stop) - Quad(start)) / Quad(velocity)));
    }
  }
}

TEST(MovingEdge, RestsExactlyWhereItStops) {
  // Neither a tenth nor a third of the way is a double.
  const MovingEdge edge(5.1, -0.3, 2.2);
  const double halt = to_double(edge.halt_time());
  EXPECT_NEAR(halt, 2.9 / 0.3, 1e-14);
  for (const double time : {std::nextafter(halt, never), 10.0, 1e8, 1e300})
    EXPECT_EQ(to_double(edge.place(time)), 2.2) << time;
  EXPECT_GT(to_double(edge.place(halt * (1 - 1e-14))), 2.2);
  EXPECT_TRUE(edge.is_at_rest(edge.halt_time()));
  const MovingEdge resting;
  EXPECT_FALSE(resting.moves());
  EXPECT_TRUE(resting.is_at_rest(0.0));
  EXPECT_EQ(to_double(resting.place(1e9)), 0);
  EXPECT_EQ(to_double(MovingEdge(3, 0, {}).place(7.0)), 3);
}

// Along z both edges move and stop at different times, the low one last; along x one comes nearer;
// y rests.
MovingEdges edges_of_three_kinds() {
  MovingEdges out({4, 5, 6});
  out.set(0, true, MovingEdge(4, -0.125, {}));
  out.set(2, false, MovingEdge(0, 0.25, 1.5));  // until 6
  out.set(2, true, MovingEdge(6, -0.5, 4.5));   // until 3
  return out;
}

TEST(MovingEdges, AreAsFarApartAsTheirSurfaces) {
  const MovingEdges edges = edges_of_three_kinds();
  const auto at = [&](double time) { return edges.distances(time); };
  EXPECT_EQ(at(0), (Vector{4, 5, 6}));
  EXPECT_EQ(at(2), (Vector{3.75, 5, 4.5}));
  EXPECT_EQ(at(4), (Vector{3.5, 5, 3.5}));
  EXPECT_EQ(at(8), (Vector{3, 5, 3}));
  EXPECT_EQ(edges.low(2), (Vector{0, 0, 0.5}));
  EXPECT_EQ(edges.low(100), (Vector{0, 0, 1.5}));
  EXPECT_EQ(edges.speed(1), 0.875);
  EXPECT_EQ(edges.speed(4), 0.375);
  EXPECT_EQ(edges.speed(6), 0.125);
  EXPECT_EQ(edges.range(2, 1), (std::array{0.0, 6.0}));
  EXPECT_EQ(edges.pieces(5), (std::vector{0.0, 3.0, 5.0}));
  EXPECT_EQ(edges.pieces(never), (std::vector{0.0, 3.0, 6.0, never}));
  MovingEdges apart({4, 5, 6});
  apart.set(1, false, MovingEdge(0, -1, -2.0));
  apart.set(1, true, MovingEdge(5, 1, {}));
  EXPECT_EQ(apart.range(1, 10), (std::array{-2.0, 15.0}));
  EXPECT_EQ(apart.range(1, 0), (std::array{0.0, 5.0}));
}

TEST(MovingEdges, ComeAsNearAsAskedForAtTheTimeTheyTell) {
  const MovingEdges edges = edges_of_three_kinds();
  EXPECT_EQ(edges.time_of_distance(0, 1), 24);
  EXPECT_EQ(edges.time_of_distance(0, 4), 0);
  EXPECT_EQ(edges.time_of_distance(0, 4.5), 0);  // nearer from the start
  EXPECT_EQ(edges.time_of_distance(1, 1), never);
  EXPECT_EQ(edges.time_of_distance(2, 4.5), 2);
  EXPECT_EQ(edges.time_of_distance(2, 3.5), 4);    // after one has stopped
  EXPECT_EQ(edges.time_of_distance(2, 3), never);  // they stop just there, with room
  EXPECT_EQ(edges.time_of_distance(2, 3.25), 5);
  EXPECT_EQ(edges.time_of_distance(2, 2.9), never);
  // One pursues the other, which stops before it.
  MovingEdges pursued({4, 4, 4});
  pursued.set(2, false, MovingEdge(0, 1, {}));
  pursued.set(2, true, MovingEdge(4, 1, 6.0));
  EXPECT_EQ(pursued.time_of_distance(2, 1), 5);
  pursued.set(2, true, MovingEdge(4, 1, {}));
  EXPECT_EQ(pursued.time_of_distance(2, 1), never);
  // Apart first, and then less far.
  MovingEdges back({4, 4, 4});
  back.set(2, false, MovingEdge(0, 0.5, {}));
  back.set(2, true, MovingEdge(4, 1, 6.0));
  EXPECT_EQ(back.time_of_distance(2, 4.5), 0);
  EXPECT_EQ(back.time_of_distance(2, 4), 4);
}

TEST(MovingEdges, HaveTheMeanOfTheirVolume) {
  const MovingEdges edges = edges_of_three_kinds();
  const auto volume = [](const Vector& edge) { return edge[0] * edge[1] * edge[2]; };
  for (const double until : {1.0, 3.0, 4.5, 20.0}) {
    double sum = 0;
    constexpr int steps = 200000;
    for (int n = 0; n < steps; ++n) sum += volume(edges.distances(until * (n + 0.5) / steps));
    EXPECT_NEAR(edges.mean(until, volume), sum / steps, 1e-8 * sum / steps) << until;
  }
  EXPECT_EQ(edges.mean(0, volume), 120);
  EXPECT_NEAR(edges.mean(1e-300, volume), 120, 1e-12);
}

}  // namespace
}  // namespace needlework
