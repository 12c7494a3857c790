#include "tests/hard_cases/hard_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "tests/support/audit_setup.h"
#include "tests/support/scenes.h"
#include "tests/support/searches.h"

namespace needlework::test {
namespace {

// Runs with more collisions are not repeated at `rigorous`, which would take minutes.
constexpr std::size_t most_rigorous = 2000;

bool is_finite(const std::array<double, 3>& a) {
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

// Checks a run by its collisions.
class Chronicle {
 public:
  Chronicle(const Scene& scene, const Simulation& simulation, const Scene::Until& until)
      : elastic_(scene.collisions.epsilon == 1 && std::abs(scene.collisions.beta) == 1),
        epoch_(simulation.epoch_length()),
        end_(until.time.value_or(INFINITY)) {
    const State state = simulation.copy();
    const double k = scene.needles.k;
    for (std::size_t i = 0; i < state.size(); ++i) {
      double energy = 0;
      for (int axis = 0; axis < 3; ++axis) {
        energy += 0.5 * std::pow(state.velocity[i][axis], 2) +
                  0.25 / k * std::pow(state.angular_velocity[i][axis], 2);
      }
      energy_ += energy;
    }
  }

  // Whether a collision is valid.
  testing::AssertionResult take(const Collision& c) {
    const bool finite = std::isfinite(c.offset) && std::isfinite(c.time) &&
                        std::isfinite(c.sin_angle) && std::isfinite(c.normal_velocity) &&
                        std::isfinite(c.energy_change) && is_finite(c.impulse);
    if (!finite) return testing::AssertionFailure() << "not finite";
    for (const StateAfterCollision& a : c.after) {
      if (!is_finite(a.position) || !is_finite(a.velocity) || !is_finite(a.orientation) ||
          !is_finite(a.angular_velocity)) {
        return testing::AssertionFailure() << "a record is not finite";
      }
    }
    if (!(std::abs(c.arm_first) <= 0.5 && std::abs(c.arm_second) <= 0.5)) {
      return testing::AssertionFailure() << "arms " << c.arm_first << " " << c.arm_second;
    }
    if (c.offset < 0 || c.offset >= epoch_) {
      return testing::AssertionFailure() << "offset " << c.offset << " in epoch of " << epoch_;
    }
    const std::pair now(c.epoch, c.offset);
    if (now < last_) return testing::AssertionFailure() << "the clock goes back at " << c.time;
    last_ = now;
    if (!(c.time <= end_)) return testing::AssertionFailure() << "the clock leaps to " << c.time;
    if (c.energy_change > 0 && c.energy_change > 1e-14 * energy_) {
      return testing::AssertionFailure() << "energy grows by " << c.energy_change;
    }
    if (elastic_ && std::abs(c.energy_change) > 1e-14 * energy_) {
      return testing::AssertionFailure() << "energy changes by " << c.energy_change;
    }
    energy_ += c.energy_change;
    return testing::AssertionSuccess();
  }

  double energy() const { return energy_; }

 private:
  bool elastic_;
  double epoch_, end_, energy_ = 0;
  std::pair<std::int64_t, double> last_{0, 0};
};

HardRun run_once(const Scene& scene, const State& state, const Scene::Until& until,
                 const Watch* watch) {
  Simulation simulation(scene, state);
  HardRun run;
  run.initial = simulation.copy();
  run.first = simulation.totals();
  Chronicle chronicle(scene, simulation, until);
  const bool audited = watch && watch->audited;
  audit::Audit audit(run.initial,
                     audit_setup(scene, simulation.epoch_length(), watch ? watch->share : 1));
  int wrong = 0;
  if (watch) {
    simulation.on_collision([&](const Collision& c) {
      if (const auto good = chronicle.take(c); !good && ++wrong <= 3) {
        ADD_FAILURE() << "collision " << run.collisions.size() << " of " << c.first << " and "
                      << c.second << " at " << c.time << ": " << good.message();
      }
      run.collisions.push_back(c);
      if (audited) audit.add(c);
    });
  }
  try {
    run.stop = simulation.advance(until);
  } catch (const InvalidStateError& error) {
    run.failure = error.what();
  }
  run.end = simulation.copy();
  run.last = simulation.totals();
  run.time = simulation.time();
  run.hash = simulation.trajectory_hash();
  run.counters = simulation.counters();
  if (audited) {
    audit.finish(run.time);
    run.findings = audit.findings();
  }
  return run;
}

void expect_sound(const HardRun& run, const Scene& scene) {
  const double count = static_cast<double>(run.end.size());
  if (run.stop == Stop::time) {
    EXPECT_TRUE(scene.until.time == std::nullopt || run.time == *scene.until.time);
  }
  EXPECT_LE(run.last.energy, run.first.energy * (1 + 1e-12));
  const double most = std::sqrt(2 * count * run.first.energy);  // largest momentum that one needle
                                                                // can have
  const double collisions = static_cast<double>(run.collisions.size());
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(run.last.momentum[axis], run.first.momentum[axis],
                1e-15 * most * (count + collisions))
        << "momentum";
  }
  for (std::size_t i = 0; i < run.end.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(run.end.position[i][axis] >= 0 && run.end.position[i][axis] < run.end.box[axis])
          << "needle " << i << " at " << run.end.position[i][axis];
    }
    EXPECT_TRUE(is_finite(run.end.velocity[i]) && is_finite(run.end.angular_velocity[i]));
    EXPECT_TRUE(is_finite(run.end.orientation[i]));
    if (testing::Test::HasFailure()) return;
  }
}

void expect_clean(const audit::Findings& findings, const Watch& watch) {
  for (const audit::Kind kind : audit::kinds) {
    EXPECT_EQ(findings.count(kind), 0u) << audit::name(kind);
  }
  for (std::size_t n = 0; n < std::min<std::size_t>(3, findings.listed.size()); ++n) {
    const auto& d = findings.listed[n];
    ADD_FAILURE() << audit::name(d.kind) << ": " << d.first << " and " << d.second << " at "
                  << d.time;
  }
  EXPECT_LE(findings.undecided, watch.undecided) << "of " << findings.checked;
}

void expect_same(const HardRun& truth, const HardRun& other, const std::string& what) {
  SCOPED_TRACE(what);
  EXPECT_EQ(other.hash, truth.hash);
  EXPECT_EQ(other.stop, truth.stop);
  EXPECT_EQ(other.failure, truth.failure);
  EXPECT_EQ(other.time, truth.time);
  EXPECT_EQ(other.last.collisions, truth.last.collisions);
  const State &a = truth.end, &b = other.end;
  EXPECT_TRUE(a.position == b.position && a.image == b.image && a.velocity == b.velocity &&
              a.orientation == b.orientation && a.angular_velocity == b.angular_velocity);
}

}  // namespace

HardRun run_hard(const Scene& given, const State& state, const Scene::Until& until,
                 const Watch& watch) {
  Scene scene = given;
  scene.engine = {};
  scene.engine.threads = 1;
  scene.engine.search = "all-pairs";
  const HardRun truth = run_once(scene, state, until, &watch);
  expect_sound(truth, scene);
  if (watch.audited) expect_clean(truth.findings, watch);

  const auto choices = search_choices();
  for (const SearchChoice& choice : choices) {
    const bool plain = !choice.setup.cell_side && !choice.setup.capsule_radius;
    const bool best = plain && choice.setup.isa == choices.back().setup.isa;
    if (!watch.everywhere && !best) continue;
    choice.apply(scene);
    expect_same(truth, run_once(scene, state, until, nullptr), choice.name());
  }
  scene.engine = {};
  scene.engine.threads = 1;
  if (watch.audited && truth.collisions.size() <= most_rigorous) {
    SCOPED_TRACE("rigorous");
    scene.engine.accuracy = "rigorous";
    const HardRun rigorous = run_once(scene, state, until, &watch);
    expect_sound(rigorous, scene);
    expect_clean(rigorous.findings, watch);
    if (!watch.by_rounding) {
      EXPECT_EQ(rigorous.failed(), truth.failed());
    }
    scene.engine = {};
  }
  scene = test::on_threads(scene, 2);
  for (const char* search : {"linked-cells", "capsules"}) {
    scene.engine.search = search;
    expect_same(truth, run_once(scene, state, until, nullptr),
                std::string(search) + " on two threads");
  }
  return truth;
}

HardRun run_hard(const Scene& scene, const Scene::Until& until, const Watch& watch) {
  return run_hard(scene, draw_initial_state(scene), until, watch);
}

State empty_state(std::array<double, 3> box) {
  State state;
  state.box = box;
  return state;
}

void add_needle(State& state, const std::array<double, 3>& r, const std::array<double, 3>& u,
                const std::array<double, 3>& v, const std::array<double, 3>& w) {
  state.position.push_back(r);
  state.orientation.push_back(u);
  state.velocity.push_back(v);
  state.angular_velocity.push_back(w);
}

}  // namespace needlework::test
