// Every event of small gases with walls and gravity, against a program of its own that steps
// through time: it shares no code with the engine but vectors, and looks at all pairs, images and
// walls in small steps of long double.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "kernels/vec3.h"
#include "needlework/initial_state.h"
#include "needlework/simulation.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

using Real = long double;
using V = Vec3<Real>;
using std::numbers::pi_v;

V vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

struct Stepped {
  V r, v, u, w;
  Real length, mass, inertia, last = -1e9L;  // the time of its last collision

  Stepped after(Real t, const V& g) const {
    Stepped out = *this;
    out.r = r + v * t + g * (t * t / 2);
    out.v = v + g * t;
    const Real omega = std::sqrt(dot(w, w));
    if (omega > 0) {
      out.u = u * std::cos(omega * t) + cross(w, u) * (std::sin(omega * t) / omega);
    }
    return out;
  }
};

struct SteppedWall {
  int axis;
  Real normal, place, epsilon, amplitude = 0, frequency = 0, phase = 0;

  Real angle(Real time) const { return 2 * pi_v<Real> * frequency * time + phase; }
  Real surface(Real time) const { return place + amplitude * std::sin(angle(time)); }
  Real speed(Real time) const {
    return amplitude * 2 * pi_v<Real> * frequency * std::cos(angle(time));
  }
};

struct SteppedEvent {
  Real time;
  bool hit;
  std::uint32_t first, second;
  Real normal_velocity, arm;
};

class SteppedGas {
 public:
  SteppedGas(const Scene& scene, const State& state)
      : gravity_(vector(scene.forces.gravity)), collisions_(scene.collisions) {
    const Composition composition = scene.composition();
    std::size_t n = 0;
    for (const Species& species : composition.species()) {
      for (std::uint64_t k = 0; k < species.count; ++k, ++n) {
        needles_.push_back({vector(state.position[n]), vector(state.velocity[n]),
                            vector(state.orientation[n]), vector(state.angular_velocity[n]),
                            species.length, species.mass, species.inertia()});
      }
    }
    for (int axis = 0; axis < 3; ++axis) box_[axis] = scene.needles.box[axis];
    for (const Scene::Wall& given : scene.walls) {
      const int axis = given.axis[0] - 'x';
      images_[axis] = 0;
      for (const bool low : {true, false}) {
        if (given.side == (low ? "high" : "low")) continue;
        SteppedWall wall{axis, low ? 1.0L : -1.0L, low ? 0 : box_[axis], given.epsilon};
        if (given.motion) {
          wall.amplitude = given.motion->amplitude;
          wall.frequency = given.motion->frequency;
          wall.phase = given.motion->phase;
        }
        walls_.push_back(wall);
      }
    }
  }

  SteppedEvent next() {
    found_ = {std::numeric_limits<Real>::infinity(), false, 0, 0, 0, 0};
    for (Real from = 0; std::isinf(found_.time); from += step) look(from);
    for (Stepped& needle : needles_) needle = needle.after(found_.time, gravity_);
    time_ += found_.time;
    found_.time = time_;
    if (found_.hit) {
      hit(needles_[found_.first], walls_[found_.second]);
    } else {
      collide(needles_[found_.first], needles_[found_.second]);
    }
    for (Stepped& needle : needles_) {
      for (int axis = 0; axis < 3; ++axis) {
        Real& x = axis == 0 ? needle.r.x : axis == 1 ? needle.r.y : needle.r.z;
        if (images_[axis] > 0) x -= std::floor(x / box_[axis]) * box_[axis];
      }
    }
    return found_;
  }

 private:
  static constexpr Real step = 2e-4L;
  // What has just touched is apart by then, and has not come back.
  static constexpr Real moment = 1e-8L;

  template <class Function>
  static Real bisected(Real from, Real to, const Function& has_changed) {
    for (int k = 0; k < 70; ++k) {
      const Real middle = (from + to) / 2;
      (has_changed(middle) ? to : from) = middle;
    }
    return to;
  }

  Real height(const Stepped& needle, const SteppedWall& wall, Real arm, Real t) const {
    const Stepped then = needle.after(t, gravity_);
    return wall.normal * (component(then.r, wall.axis) + arm * component(then.u, wall.axis) -
                          wall.surface(time_ + t));
  }

  void look(Real from) {
    const Real begin = from == 0 ? moment : from, end = from + step;
    for (std::uint32_t i = 0; i < needles_.size(); ++i) {
      for (std::uint32_t w = 0; w < walls_.size(); ++w) {
        for (const Real arm : {needles_[i].length / 2, -needles_[i].length / 2}) {
          const auto below = [&](Real t) { return height(needles_[i], walls_[w], arm, t) < 0; };
          if (!below(end)) continue;
          const Real at = bisected(begin, end, below);
          if (at < found_.time) found_ = {at, true, i, w, 0, arm};
        }
      }
      for (std::uint32_t j = i + 1; j < needles_.size(); ++j) look_at_pair(i, j, begin, end);
    }
  }

  void look_at_pair(std::uint32_t i, std::uint32_t j, Real begin, Real end) {
    for (int x = -images_[0]; x <= images_[0]; ++x) {
      for (int y = -images_[1]; y <= images_[1]; ++y) {
        for (int z = -images_[2]; z <= images_[2]; ++z) {
          const V shift{x * box_[0], y * box_[1], z * box_[2]};
          const auto side = [&](Real t) {
            const Stepped a = needles_[i].after(t, gravity_), b = needles_[j].after(t, gravity_);
            return dot(a.r - b.r - shift, cross(a.u, b.u)) > 0;
          };
          const bool before = side(begin);
          if (side(end) == before) continue;
          const Real at = bisected(begin, end, [&](Real t) { return side(t) != before; });
          const Stepped a = needles_[i].after(at, gravity_), b = needles_[j].after(at, gravity_);
          const V r = a.r - b.r - shift, normal = cross(a.u, b.u);
          const Real square = dot(normal, normal);
          const Real first = dot(cross(b.u, r), normal) / square,
                     second = dot(cross(a.u, r), normal) / square;
          if (std::abs(first) >= a.length / 2 || std::abs(second) >= b.length / 2) continue;
          if (at >= found_.time) continue;
          found_ = {at, false, i, j, 0, first};
          other_arm_ = second;
        }
      }
    }
  }

  bool by_contact_time(const Stepped& needle) const {
    return time_ - needle.last < collisions_.tc.value_or(0);
  }

  void hit(Stepped& needle, const SteppedWall& wall) {
    const V normal{wall.axis == 0 ? wall.normal : 0, wall.axis == 1 ? wall.normal : 0,
                   wall.axis == 2 ? wall.normal : 0};
    const Real arm = found_.arm, share = dot(needle.u, normal);
    const Real speed =
        dot(needle.v + cross(needle.w, needle.u) * arm, normal) - wall.normal * wall.speed(time_);
    const Real epsilon = by_contact_time(needle) ? 1 : wall.epsilon;
    const Real impulse = -(1 + epsilon) * speed /
                         (1 / needle.mass + arm * arm / needle.inertia * (1 - share * share));
    needle.v = needle.v + normal * (impulse / needle.mass);
    needle.w = needle.w + cross(needle.u, normal) * (arm * impulse / needle.inertia);
    needle.last = time_;
    found_.normal_velocity = speed;
  }

  void collide(Stepped& a, Stepped& b) {
    V normal = cross(a.u, b.u);
    normal = normal * (1 / std::sqrt(dot(normal, normal)));
    const Real s1 = found_.arm, s2 = other_arm_;
    const V v = a.v - b.v + cross(a.w, a.u) * s1 - cross(b.w, b.u) * s2;
    const Real speed = dot(v, normal);
    const bool elastic = by_contact_time(a) || by_contact_time(b);
    const Real epsilon = elastic ? 1 : collisions_.epsilon, beta = elastic ? -1 : collisions_.beta;
    const V change = normal * (-(1 + epsilon) * speed) - (v - normal * speed) * (1 + beta);
    // M p = change, by Cramer's rule with columns of the symmetric M.
    const Real i1 = s1 * s1 / a.inertia, i2 = s2 * s2 / b.inertia;
    const Real masses = 1 / a.mass + 1 / b.mass + i1 + i2;
    const auto column = [&](int n) {
      const V unit{n == 0 ? 1.0L : 0, n == 1 ? 1.0L : 0, n == 2 ? 1.0L : 0};
      return unit * masses - a.u * (i1 * component(a.u, n)) - b.u * (i2 * component(b.u, n));
    };
    const V x = column(0), y = column(1), z = column(2);
    const Real determinant = dot(x, cross(y, z));
    const V p{dot(change, cross(y, z)) / determinant, dot(x, cross(change, z)) / determinant,
              dot(x, cross(y, change)) / determinant};
    a.v = a.v + p * (1 / a.mass);
    b.v = b.v - p * (1 / b.mass);
    a.w = a.w + cross(a.u, p) * (s1 / a.inertia);
    b.w = b.w - cross(b.u, p) * (s2 / b.inertia);
    a.last = b.last = time_;
    found_.normal_velocity = speed;
  }

  V gravity_;
  Scene::Collisions collisions_;
  std::vector<Stepped> needles_;
  std::vector<SteppedWall> walls_;
  std::array<Real, 3> box_{};
  std::array<int, 3> images_{1, 1, 1};
  Real time_ = 0, other_arm_ = 0;
  SteppedEvent found_{};
};

// Errors grow about tenfold in ten events of such a gas.
void expect_same_events(const Scene& scene, std::size_t count) {
  const State state = draw_initial_state(scene);
  Simulation run(scene, state);
  std::vector<Happening> events;
  run.on_happening([&](const Happening& h) { events.push_back(h); });
  for (int n = 1; events.size() < count; ++n) run.advance(test::until_time(0.2 * n));
  SteppedGas stepped(scene, state);
  std::size_t hits = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const SteppedEvent event = stepped.next();
    const Collision& engine = events[n].event;
    ASSERT_EQ(!events[n].is_collision(), event.hit) << n;
    ASSERT_EQ(engine.first, event.first) << n;
    ASSERT_EQ(engine.second, event.second) << n;
    ASSERT_NEAR(engine.time, static_cast<double>(event.time), 1e-7) << n;
    ASSERT_NEAR(engine.normal_velocity, static_cast<double>(event.normal_velocity), 1e-5) << n;
    ASSERT_NEAR(engine.arm_first, static_cast<double>(event.arm), 1e-5) << n;
    hits += event.hit;
  }
  EXPECT_GT(hits, count / 4);
  EXPECT_LT(hits, count);
}

TEST(WallsStepByStep, OfNeedlesBetweenTwoWalls_long) {
  for (const std::uint64_t seed : {1u, 2u}) {
    Scene scene = test::scene_of(6, 3, seed);
    scene.needles.box[2] = 2;
    scene.walls = {{.axis = "z", .side = "both"}};
    expect_same_events(scene, 40);
  }
}

TEST(WallsStepByStep, OfRoughNeedlesOnAFloor_long) {
  for (const std::uint64_t seed : {1u, 2u}) {
    Scene scene = test::scene_of(6, 3, seed);
    scene.collisions.epsilon = 0.9;
    scene.collisions.beta = 0.3;
    scene.collisions.tc = 1e-2;
    scene.walls = {{.axis = "z", .side = "low", .epsilon = 0.8}};
    scene.forces.gravity = {0, 0, -1.5};
    expect_same_events(scene, 40);
  }
}

TEST(WallsStepByStep, OfAMixtureInAShakenBox) {
  for (const std::uint64_t seed : {1u, 2u}) {
    Scene scene = test::scene_of(7, 2, seed);
    scene.needles.box = {2.5, 1.6, 2};
    scene.species = {{.name = "a", .count = 3, .length = 1, .mass = 1, .k = 6},
                     {.name = "b", .count = 4, .length = 0.6, .mass = 2.5, .k = 3}};
    scene.collisions.epsilon = 0.8;
    scene.collisions.tc = 5e-3;
    const auto moving = [](const char* side, double amplitude, double frequency, double phase) {
      return Scene::Wall{.axis = "z",
                         .side = side,
                         .epsilon = 0.9,
                         .motion = Scene::WallMotion{amplitude, frequency, phase}};
    };
    scene.walls = {{.axis = "y", .side = "both", .epsilon = 0.95},
                   moving("high", 0.15, 1.3, 0.7),
                   moving("low", 0.1, 2, 2),
                   {.axis = "x", .side = "both"}};
    scene.forces.gravity = {0.3, -0.5, 1};
    expect_same_events(scene, 40);
  }
}

}  // namespace
}  // namespace needlework
