// Simulations run by C callers.
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "needlework/error.h"
#include "src/c/handle.h"
#include "src/c/vectors.h"
#include "src/runs/limits.h"
#include "src/scene/confinement.h"

namespace needlework::c {
namespace {

/// Neither shows progress nor stops a run: callers interrupt it.
struct NoMonitor : runs::RunMonitor {
  bool is_due(double) const override { return false; }
  void show(const runs::Progress&) override {}
};

static_assert(static_cast<int>(Stop::time) == NEEDLEWORK_STOP_TIME);
static_assert(static_cast<int>(Stop::collisions) == NEEDLEWORK_STOP_COLLISIONS);
static_assert(static_cast<int>(Stop::energy) == NEEDLEWORK_STOP_ENERGY);
static_assert(static_cast<int>(Stop::wall_time) == NEEDLEWORK_STOP_WALL_TIME);
static_assert(static_cast<int>(Stop::interrupted) == NEEDLEWORK_STOP_INTERRUPTED);
static_assert(static_cast<int>(Stop::nothing_can_happen) == NEEDLEWORK_STOP_NOTHING_CAN_HAPPEN);
static_assert(static_cast<int>(Stop::walls_meet) == NEEDLEWORK_STOP_WALLS_MEET);
static_assert(static_cast<int>(Stop::jammed) == NEEDLEWORK_STOP_JAMMED);
static_assert(static_cast<int>(Stop::grown) == NEEDLEWORK_STOP_GROWN);
static_assert(static_cast<int>(Stop::pressure) == NEEDLEWORK_STOP_PRESSURE);
static_assert(static_cast<int>(Stop::no_room) == NEEDLEWORK_STOP_NO_ROOM);

runs::Limits limits_of(const needlework_limits& limits) {
  runs::Limits out;
  // A limit that is not a number is passed on, so that it is refused there.
  const auto set = [](std::optional<double>& to, double value) {
    if (value != 0) to = value;
  };
  set(out.time, limits.time);
  set(out.collisions_per_needle, limits.collisions_per_needle);
  set(out.energy_ratio, limits.energy_ratio);
  set(out.wall_s, limits.wall_s);
  if (limits.collisions != 0) out.collisions = limits.collisions;
  return out;
}

/// Ends a run because the callback asks for it. The engine is interrupted as for any exception of a
/// callback, so that a request after the last event does not stop the next call.
struct StopRequested : std::exception {};

void require_open(const needlework_simulation& simulation) {
  if (simulation.closed) {
    throw UsageError("the simulation is closed: expected one that can be run");
  }
}

/// The limits of a call, by from_start() or from_now(). What is wrong with them is an argument.
template <class Count>
Scene::Until until_of(const needlework_limits& limits, const needlework_simulation& simulation,
                      Count&& count) {
  try {
    return count(limits_of(limits), simulation.run.simulation());
  } catch (const InputError& error) {
    throw UsageError(std::string("limits: ") + error.what());
  }
}

template <class Until>
int run(needlework_simulation* simulation, int* stop, Until&& until) noexcept {
  return guarded(simulation, [&](needlework_simulation& self) {
    require_open(self);
    const Scene::Until end = until(self);
    NoMonitor monitor;
    Stop reason = Stop::interrupted;
    try {
      reason = changing(self, [&] { return self.run.advance(end, monitor); });
    } catch (const StopRequested&) {
    }
    if (stop) *stop = static_cast<int>(reason);
  });
}

// The same memory serves both interfaces, so that batches need not be copied.
static_assert(std::is_standard_layout_v<Collision> && std::is_trivially_copyable_v<Collision>);
static_assert(sizeof(Collision) == sizeof(needlework_collision));
static_assert(offsetof(Collision, epoch) == offsetof(needlework_collision, epoch));
static_assert(offsetof(Collision, offset) == offsetof(needlework_collision, offset));
static_assert(offsetof(Collision, time) == offsetof(needlework_collision, time));
static_assert(offsetof(Collision, first) == offsetof(needlework_collision, first));
static_assert(offsetof(Collision, second) == offsetof(needlework_collision, second));
static_assert(offsetof(Collision, shift) == offsetof(needlework_collision, shift));
static_assert(offsetof(Collision, arm_first) == offsetof(needlework_collision, arm_first));
static_assert(offsetof(Collision, arm_second) == offsetof(needlework_collision, arm_second));
static_assert(offsetof(Collision, sin_angle) == offsetof(needlework_collision, sin_angle));
static_assert(offsetof(Collision, normal_velocity) ==
              offsetof(needlework_collision, normal_velocity));
static_assert(offsetof(Collision, impulse) == offsetof(needlework_collision, impulse));
static_assert(offsetof(Collision, energy_change) == offsetof(needlework_collision, energy_change));
static_assert(offsetof(Collision, contact_time_rule) ==
              offsetof(needlework_collision, contact_time_rule));
static_assert(offsetof(Collision, after) == offsetof(needlework_collision, after));
using After = std::remove_extent_t<decltype(needlework_collision::after)>;
static_assert(sizeof(StateAfterCollision) == sizeof(After));
static_assert(offsetof(StateAfterCollision, position) == offsetof(After, position));
static_assert(offsetof(StateAfterCollision, velocity) == offsetof(After, velocity));
static_assert(offsetof(StateAfterCollision, orientation) == offsetof(After, orientation));
static_assert(offsetof(StateAfterCollision, angular_velocity) == offsetof(After, angular_velocity));
static_assert(std::is_standard_layout_v<Happening> && std::is_trivially_copyable_v<Happening>);
static_assert(sizeof(Happening) == sizeof(needlework_happening));
static_assert(offsetof(Happening, kind) == offsetof(needlework_happening, kind));
static_assert(offsetof(Happening, source) == offsetof(needlework_happening, source));
static_assert(offsetof(Happening, event) == offsetof(needlework_happening, event));
static_assert(int{Happening::pair} == int{NEEDLEWORK_KIND_PAIR});
static_assert(int{Happening::wall} == int{NEEDLEWORK_KIND_WALL});
static_assert(int{Happening::contact_entered} == int{NEEDLEWORK_KIND_CONTACT_ENTERED});
static_assert(int{Happening::contact_ended} == int{NEEDLEWORK_KIND_CONTACT_ENDED});
static_assert(int{Happening::thermostat} == int{NEEDLEWORK_KIND_THERMOSTAT});
static_assert(int{Happening::other} == int{NEEDLEWORK_KIND_OTHER});

/// The function that hands batches to a callback; none for NULL, for which `batch` may be anything.
template <class Report, class CReport>
typename runs::Batches<Report>::Callback batches_to(size_t batch,
                                                    int (*callback)(const CReport*, size_t, void*),
                                                    void* user) {
  if (!callback) return {};
  if (batch == 0) throw UsageError("batch = 0: expected at least 1");
  return [callback, user](std::span<const Report> reports) {
    const auto* first = reinterpret_cast<const CReport*>(reports.data());
    if (callback(first, reports.size(), user) != 0) throw StopRequested();
  };
}

}  // namespace
}  // namespace needlework::c

using namespace needlework;

int needlework_run_until(needlework_simulation* simulation, const needlework_limits* limits,
                         int* stop) {
  return c::run(simulation, stop, [&](const needlework_simulation& self) {
    if (limits) return c::until_of(*limits, self, runs::from_start);
    if (!has_end(self.run.scene()))
      throw c::UsageError("limits is NULL: expected limits, as the scene has no [until]");
    return c::until_of({}, self, [&](const runs::Limits& none, const Simulation& simulation) {
      return runs::from_start_or_scene(none, self.run.scene(), simulation);
    });
  });
}

int needlework_advance(needlework_simulation* simulation, const needlework_limits* limits,
                       int* stop) {
  return c::run(simulation, stop, [&](const needlework_simulation& self) {
    c::require(limits, "limits");
    return c::until_of(*limits, self, runs::from_now);
  });
}

void needlework_interrupt(needlework_simulation* simulation) {
  if (simulation) simulation->run.simulation().interrupt();
}

int needlework_checkpoint(needlework_simulation* simulation) {
  return c::guarded(simulation, [](needlework_simulation& self) {
    c::require_open(self);
    if (const std::string why = self.run.why_not_saved(); !why.empty()) throw c::UsageError(why);
    self.run.save_checkpoint();
  });
}

int needlework_sample(needlework_simulation* simulation, int frame) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require_open(self);
    if (const std::string why = self.run.why_no_output(); !why.empty()) throw c::UsageError(why);
    self.run.sample(frame != 0);
  });
}

int needlework_close(needlework_simulation* simulation) {
  return c::guarded(simulation, [](needlework_simulation& self) {
    if (self.run.scene().output.file.empty()) return;
    self.closed = true;
    self.run.close();
  });
}

int needlework_set_callback(needlework_simulation* simulation, size_t batch,
                            needlework_on_collisions callback, void* user) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    const auto pass_on = c::batches_to<Collision, needlework_collision>(batch, callback, user);
    self.run.on_collisions(batch, pass_on);
  });
}

int needlework_set_happening_callback(needlework_simulation* simulation, size_t batch,
                                      needlework_on_happenings callback, void* user) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    const auto pass_on = c::batches_to<Happening, needlework_happening>(batch, callback, user);
    self.run.on_happenings(batch, pass_on);
  });
}

int needlework_set_velocities(needlework_simulation* simulation,
                              const needlework_const_vectors* velocity,
                              const needlework_const_vectors* angular_velocity) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(velocity, "velocity");
    c::require(velocity->data, "velocity->data");
    if (angular_velocity) c::require(angular_velocity->data, "angular_velocity->data");
    const std::size_t count = self.run.simulation().needles();
    const auto v = c::rows_of(*velocity, count);
    const auto w =
        c::rows_of(angular_velocity ? *angular_velocity : needlework_const_vectors{}, count);
    c::changing(self, [&] { self.run.set_velocities(v, w); });
    if (!angular_velocity && self.run.simulation().composition().turning_share() > 0)
      c::report_warning(runs::no_rotation_given, &self.last);
  });
}
