// Sliding contact as an effect of the engine: against the kernels of its motion, whose truth is in
// quad precision (tests/kernels/sliding_test.cpp), and against what must be conserved.
#include "src/effects/sliding/sliding.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "kernels/sliding_entry.h"
#include "needlework/error.h"
#include "src/engine/initial_gas.h"
#include "src/physics/slides.h"
#include "src/physics/vectors.h"
#include "tests/support/message_of.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

using kernels::SlidingBodies;
using kernels::SlidingBody;
using kernels::SlidingDecision;
using kernels::SlidingEnd;
using kernels::SlidingEntry;
using kernels::SlidingState;
using kernels::SlidingStep;

Scene sliding_scene(std::uint64_t count, double side, double epsilon, std::uint64_t seed = 1) {
  Scene scene = test::scene_of(count, side, seed);
  scene.collisions.epsilon = epsilon;
  scene.collisions.sliding = true;
  return scene;
}

double energy_per_needle(const Simulation& simulation) { return simulation.totals().energy; }

// Where nothing enters, the trajectory is the usual one, although searches and events are others.
TEST(Sliding, ChangesNothingForElasticNeedles) {
  Scene scene = sliding_scene(200, 6, 1);
  Simulation with(scene);
  scene.collisions.sliding = false;
  Simulation without(scene);
  with.advance(test::until_collisions(20));
  without.advance(test::until_collisions(20));
  EXPECT_EQ(with.trajectory_hash(), without.trajectory_hash());
  EXPECT_EQ(with.sliding_contacts()->entered, 0u);
  EXPECT_FALSE(without.sliding_contacts());
}

// Random pairs just before a collision that begins a contact, in free space.
class Pairs {
 public:
  explicit Pairs(const SlidingBodies& bodies) : bodies_(bodies) {}

  SlidingState draw() {
    for (;;) {
      SlidingState s;
      s.u_first = direction(), s.u_second = direction();
      s.v = normal(), s.w_first = spin(s.u_first), s.w_second = spin(s.u_second);
      s.r = s.u_second * arm(bodies_.second) - s.u_first * arm(bodies_.first);
      if (sliding_entry(bodies_, s, 0, 0).decision == SlidingDecision::Enters) return s;
    }
  }

 private:
  Vec3d normal() {
    const double x = gauss_(source_), y = gauss_(source_), z = gauss_(source_);
    return {x, y, z};
  }
  Vec3d direction() {
    const Vec3d a = normal();
    return a * (1 / std::sqrt(dot(a, a)));
  }
  Vec3d spin(const Vec3d& u) {
    const Vec3d w = normal() * 3;
    return w - dot(w, u) * u;
  }
  double arm(const SlidingBody& body) { return body.half * (2 * uniform_(source_) - 1); }

  SlidingBodies bodies_;
  std::mt19937_64 source_{7};
  std::normal_distribution<double> gauss_;
  std::uniform_real_distribution<double> uniform_;
};

// The state a time before.
State flown_back(const SlidingState& s, const SlidingBodies& bodies, double time,
                 const std::array<double, 3>& box) {
  State out;
  out.box = box;
  out.resize(2);
  const double share = bodies.second.mass / (bodies.first.mass + bodies.second.mass);
  const Vec3d centre{0.01, 1.3, 2.5}, drift{-0.2, 0.1, 0.3};
  const auto put = [&](std::size_t n, const Vec3d& r, const Vec3d& v, const Vec3d& u,
                       const Vec3d& w) {
    const double omega = std::sqrt(dot(w, w));
    const Vec3d before =
        u * std::cos(omega * time) - cross(w * (1 / omega), u) * std::sin(omega * time);
    Vec3d at = r - v * time;
    for (double Vec3d::*axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
      if (at.*axis < 0) at.*axis += box[0];
      if (at.*axis >= box[0]) at.*axis -= box[0];
    }
    out.position[n] = to_array(at);
    out.velocity[n] = to_array(v);
    out.orientation[n] = to_array(before);
    out.angular_velocity[n] = to_array(w);
    out.id[n] = static_cast<std::uint32_t>(n);
  };
  put(0, centre + s.r * share, drift + s.v * share, s.u_first, s.w_first);
  put(1, centre - s.r * (1 - share), drift - s.v * (1 - share), s.u_second, s.w_second);
  return out;
}

// Largest difference of directors and velocities.
double difference(const State& state, const SlidingState& s) {
  double out = 0;
  const auto compare = [&](const std::array<double, 3>& a, const Vec3d& b) {
    const Vec3d apart = vector_of(a) - b;
    out = std::max({out, std::abs(apart.x), std::abs(apart.y), std::abs(apart.z)});
  };
  compare(state.orientation[0], s.u_first);
  compare(state.orientation[1], s.u_second);
  compare(state.angular_velocity[0], s.w_first);
  compare(state.angular_velocity[1], s.w_second);
  compare(to_array(vector_of(state.velocity[0]) - vector_of(state.velocity[1])), s.v);
  return out;
}

TEST(Sliding, OfTwoNeedlesIsThatOfTheKernels) {
  const SlidingBody body{.half = 0.5, .mass = 1, .inertia = 1. / 12};
  const SlidingBodies bodies{body, body};
  Pairs pairs(bodies);
  Scene scene = sliding_scene(2, 8, 0);
  int forces = 0, tips = 0;
  for (int n = 0; n < 100; ++n) {
    const SlidingState before = pairs.draw();
    const SlidingEntry entry = kernels::sliding_entry(bodies, before, 0, 0);
    SlidingState state = entry.after;
    SlidingStep step = kernels::sliding_step(bodies, state, entry.side, INFINITY);
    double lasts = step.duration;
    while (step.end == SlidingEnd::None) {
      state = state_after(bodies, step);
      step = kernels::sliding_step(bodies, state, entry.side, INFINITY);
      lasts += step.duration;
    }
    const double flown = 1e-3;
    Simulation simulation(scene, flown_back(before, bodies, flown, scene.needles.box));
    // In contact, in the middle of the first step.
    const SlidingStep first = kernels::sliding_step(bodies, entry.after, entry.side, INFINITY);
    simulation.advance(test::until_time(flown + 0.5 * first.duration));
    EXPECT_LT(difference(simulation.copy(), first.at(0.5 * first.duration)), 1e-10) << n;
    const double energy = energy_per_needle(simulation);
    EXPECT_EQ(simulation.sliding_contacts()->entered, 1u) << n;
    // Just before the end, and after it.
    simulation.advance(test::until_time(flown + lasts * (1 - 1e-9)));
    EXPECT_LT(difference(simulation.copy(), step.at(step.duration)), 1e-7) << n;
    EXPECT_NEAR(energy_per_needle(simulation), energy, 1e-13 * energy) << n;
    const SlidingContacts held = *simulation.sliding_contacts();
    EXPECT_EQ(held.ended_by_force + held.ended_by_tip, 0u);
    simulation.advance(test::until_time(flown + lasts * (1 + 1e-9)));
    EXPECT_LT(difference(simulation.copy(), step.at(step.duration)), 1e-7) << n;
    EXPECT_NEAR(energy_per_needle(simulation), energy, 1e-13 * energy) << n;
    const SlidingContacts ended = *simulation.sliding_contacts();
    EXPECT_EQ(ended.ended_by_force, step.end == SlidingEnd::Force ? 1u : 0u) << n;
    EXPECT_EQ(ended.ended_by_tip, step.end == SlidingEnd::Tip ? 1u : 0u) << n;
    EXPECT_NEAR(ended.time, lasts, 1e-9) << n;
    forces += step.end == SlidingEnd::Force;
    tips += step.end == SlidingEnd::Tip;
  }
  EXPECT_GT(forces, 10);
  EXPECT_GT(tips, 10);
}

// Collisions and hits on walls of a needle in contact, and what follows at the same instant: how
// many there are, and how much energy they have lost.
struct Strikes {
  int pairs = 0, walls = 0;
  double lost = 0, lost_elsewhere = 0;
};

Strikes strikes_of(const Scene& scene, double collisions) {
  Strikes out;
  std::map<std::uint32_t, std::uint32_t> partners;  // of needles in contact
  std::map<std::uint32_t, double> last;             // time of each needle's last event
  Simulation simulation(scene);
  simulation.on_happening([&](const Happening& what) {
    const Collision& event = what.event;
    const auto touches = [&](std::uint32_t id) {
      return partners.contains(id) || (last.contains(id) && last[id] == event.time);
    };
    const bool is_wall = what.kind == Happening::wall;
    const bool strikes = touches(event.first) || (!is_wall && touches(event.second));
    if (what.kind == Happening::contact_ended) {
      partners.erase(event.first), partners.erase(event.second);
    } else {
      (strikes ? out.lost : out.lost_elsewhere) -= event.energy_change;
      if (strikes) ++(is_wall ? out.walls : out.pairs);
      EXPECT_FALSE(strikes && what.kind == Happening::contact_entered &&
                   scene.collisions.elastic_strikes);
    }
    if (what.kind == Happening::contact_entered)
      partners[event.first] = event.second, partners[event.second] = event.first;
    last[event.first] = event.time;
    if (!is_wall) last[event.second] = event.time;
  });
  simulation.advance(test::until_collisions(collisions));
  EXPECT_LT(std::abs(simulation.energy_drift()), 1e-11);
  return out;
}

TEST(SlidingWithElasticStrikes, LosesNothingInStrikes) {
  for (const double epsilon : {0.0, 0.3}) {
    Scene scene = sliding_scene(200, 6, epsilon, 5);
    scene.walls = {{.axis = "z", .side = "both", .epsilon = 0.7}};
    const Strikes usual = strikes_of(scene, 20);
    EXPECT_GT(usual.lost, 1);
    scene.collisions.elastic_strikes = true;
    const Strikes elastic = strikes_of(scene, 20);
    EXPECT_GT(elastic.pairs, 30);
    EXPECT_GT(elastic.walls, 0);
    EXPECT_LT(std::abs(elastic.lost), 1e-11);
    EXPECT_GT(elastic.lost_elsewhere, 100);
  }
}

// Of two needles nothing else strikes one.
TEST(SlidingWithElasticStrikes, IsTheSameWithoutStrikes) {
  std::uint64_t entered = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    Scene scene = sliding_scene(2, 2.2, 0, seed);
    const std::string usual = test::hash_of(scene, test::until_collisions(10));
    scene.collisions.elastic_strikes = true;
    Simulation simulation(scene);
    simulation.advance(test::until_collisions(10));
    EXPECT_EQ(simulation.trajectory_hash(), usual);
    entered += simulation.sliding_contacts()->entered;
  }
  EXPECT_GT(entered, 10u);
}

// Velocities that press a pair together collide at once.
TEST(SlidingWithElasticStrikes, LosesNothingWhereVelocitiesAreSet) {
  const SlidingBody body{.half = 0.5, .mass = 1, .inertia = 1. / 12};
  const SlidingBodies bodies{body, body};
  for (const bool elastic : {false, true}) {
    Pairs pairs(bodies);
    Scene scene = sliding_scene(2, 8, 0);
    scene.collisions.elastic_strikes = elastic;
    int collided = 0;
    for (int n = 0; n < 20; ++n) {
      Simulation simulation(scene, flown_back(pairs.draw(), bodies, 1e-3, scene.needles.box));
      simulation.advance(test::until_time(1e-3 + 1e-6));
      State now = simulation.copy();
      now.velocity[0][0] += n % 2 == 0 ? 3 : -3;
      simulation.set_velocities(now.velocity, now.angular_velocity);
      const Totals before = simulation.totals();
      simulation.advance(test::until_time(simulation.time() + 1e-9));
      const Totals after = simulation.totals();
      if (after.collisions == before.collisions) continue;
      ++collided;
      if (elastic) {
        EXPECT_NEAR(after.energy, before.energy, 1e-13 * before.energy) << n;
      } else {
        EXPECT_LT(after.energy, before.energy) << n;
      }
    }
    EXPECT_GT(collided, 5);
  }
}

// In the middle of the first step of a contact.
TEST(Sliding, IsCountedUntilVelocitiesAreSet) {
  const SlidingBody body{.half = 0.5, .mass = 1, .inertia = 1. / 12};
  const SlidingBodies bodies{body, body};
  Pairs pairs(bodies);
  Scene scene = sliding_scene(2, 8, 0);
  for (int n = 0; n < 20; ++n) {
    const SlidingState before = pairs.draw();
    const SlidingEntry entry = kernels::sliding_entry(bodies, before, 0, 0);
    const double half =
        0.5 * kernels::sliding_step(bodies, entry.after, entry.side, INFINITY).duration;
    const double flown = 1e-3;
    Simulation simulation(scene, flown_back(before, bodies, flown, scene.needles.box));
    simulation.advance(test::until_time(flown + half));
    EXPECT_EQ(simulation.sliding_contacts()->time, 0) << n;
    for (int calls = 0; calls < 2; ++calls) {
      const State now = simulation.copy();
      simulation.set_velocities(now.velocity, now.angular_velocity);
      EXPECT_EQ(simulation.sliding_contacts()->ended_by_strike, 1u) << n;
      EXPECT_NEAR(simulation.sliding_contacts()->time, half, 1e-10) << n;
    }
  }
}

// A caller that sets velocities so often that no window ends.
TEST(Sliding, NeedsNoMoreMemoryWhileVelocitiesAreSet) {
  Simulation simulation(sliding_scene(200, 4.8, 0));
  const auto allocated = [&](int calls) {
    for (int n = 0; n < calls; ++n) {
      simulation.advance(test::until_time(simulation.time() + 0.01));
      State now = simulation.copy();
      const double scale = std::sqrt(2.5 / energy_per_needle(simulation));
      for (auto* all : {&now.velocity, &now.angular_velocity}) {
        for (auto& each : *all) each = {each[0] * scale, each[1] * scale, each[2] * scale};
      }
      simulation.set_velocities(now.velocity, now.angular_velocity);
    }
    return static_cast<double>(mallinfo2().uordblks);
  };
  const double early = allocated(50);
  EXPECT_LT(allocated(200), early + 1e6);
}

// Needles pressed together by third ones: no time is stopped by ever smaller bounces.
TEST(Sliding, LetsDenseGasesCool) {
  for (const double epsilon : {0.0, 0.3}) {
    Scene scene = sliding_scene(60, 2.4, epsilon, 2);
    Simulation simulation(scene);
    Scene::Until until;
    until.energy_ratio = 0.5;
    until.collisions_per_needle = 1e4;
    EXPECT_EQ(simulation.advance(until), Stop::energy);
    EXPECT_LT(std::abs(simulation.energy_drift()), 1e-11);
    const SlidingContacts contacts = *simulation.sliding_contacts();
    EXPECT_GT(contacts.crowded, 0u);
    const std::uint64_t ended =
        contacts.ended_by_force + contacts.ended_by_tip + contacts.ended_by_strike;
    EXPECT_LE(ended, contacts.entered);
    EXPECT_LE(contacts.entered, ended + 30);
  }
}

// Searches look for needles in contact where the flights of their records lead, and a margin
// beside.
TEST(Slides, DepartFromTheFlightsOfRecordsByTheMarginAtMost) {
  const SlidingBody body{.half = 0.5, .mass = 1, .inertia = 1. / 12};
  const SlidingBodies bodies{body, body};
  Pairs pairs(bodies);
  const Scene scene = sliding_scene(2, 8, 0);
  double most = 0;
  for (int n = 0; n < 300; ++n) {
    const SlidingEntry entry = kernels::sliding_entry(bodies, pairs.draw(), 0, 0);
    Gas gas = make_gas(scene, flown_back(entry.after, bodies, 0, scene.needles.box));
    gas.let_slide();
    for (const std::size_t i : {0, 1}) {
      const kernels::Flight flight = gas.records[i].flight;
      renew_record(gas, Needle(i), {}, {flight.r, flight.v, flight.u, flight.w},
                   gas.body(Needle(i)));
    }
    const Record &first = gas.records[0], &second = gas.records[1];
    // The image in which they touch.
    Shift shift{};
    const Vec3d apart = (first.flight.r - second.flight.r) - entry.after.r;
    shift[0] = static_cast<std::int32_t>(std::lround(apart.x / 8));
    Sliding::join(gas, Needle{0}, Needle{1}, shift, entry.side);
    const Slide& slide = *gas.slides->of(gas.ids[0], first);
    for (int part = 0; part <= 8; ++part) {
      const double time = slide.step.duration * part / 8;
      for (const int i : {0, 1}) {
        const Record& record = i == 0 ? first : second;
        const kernels::BodyState there = slide.at(i, record.flight, {}, time);
        const FreeFlight flight = gas.motion(record);
        for (const double arm : {-0.5, 0.5}) {
          const Vec3d off =
              (there.r - flight.centre(time)) + (there.u - flight.director(time)) * arm;
          most = std::max(most, std::sqrt(dot(off, off)));
        }
        EXPECT_LE(std::sqrt(dot(there.v, there.v)), gas.fastest_of(record));
      }
    }
  }
  EXPECT_LE(most, most_departure);
  EXPECT_GT(most, most_departure / 4);
}

TEST(Sliding, SaysWhatItIsNotOfferedFor) {
  const auto expect = [](const char* reason, auto&& change) {
    Scene scene = sliding_scene(10, 5, 0.5);
    change(scene);
    const std::string message = test::message_of<InputError>([&] { Simulation simulation(scene); });
    EXPECT_NE(message.find(reason), std::string::npos) << message;
    EXPECT_NE(message.find("collisions.sliding"), std::string::npos) << message;
  };
  expect("without friction", [](Scene& s) { s.collisions.beta = 0.5; });
  expect("finite width", [](Scene& s) { s.needles.diameter = 0.1; });
  expect("a contact time", [](Scene& s) { s.collisions.tc_relative = 1e-3; });
  expect("only needles in contact are struck", [](Scene& s) {
    s.collisions.sliding = false;
    s.collisions.elastic_strikes = true;
  });
  Scene scene = sliding_scene(2, 2.1, 0.5);
  const std::string message = test::message_of<InputError>([&] { Simulation simulation(scene); });
  EXPECT_NE(message.find("edges of at least 2.135625 (2.135625 needle lengths)"), std::string::npos)
      << message;
}

}  // namespace
}  // namespace needlework
