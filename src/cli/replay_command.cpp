#include "src/cli/replay_command.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "src/cli/json.h"
#include "src/cli/messages.h"
#include "src/cli/progress.h"
#include "src/cli/signals.h"
#include "src/runs/exit_codes.h"
#include "src/runs/replay.h"
#include "src/scene/box_of.h"

namespace needlework::cli {

using enum runs::ExitCode;
namespace {

using Json = nlohmann::ordered_json;

// Where the needles touch, in the box.
std::array<double, 3> place_of_contact(const Collision& collision, const Box& box) {
  const StateAfterCollision& first = collision.after[0];
  std::array<double, 3> place{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    place[axis] = first.position[axis] + collision.arm_first * first.orientation[axis];
  return box.wrap(place).place;
}

// What came of the replay, as a sentence.
std::string verdict(const runs::Replay& replay, const runs::Replayed& done) {
  const std::string where =
      fmt::format("at time {:.17g} after {} collisions", done.time, done.collisions);
  if (!replay.failure()) {
    return done.failure ? fmt::format("it fails {}: {}", where, *done.failure)
                        : fmt::format("it does not fail: {} it is at its end", where);
  }
  if (done.same) return fmt::format("the failure came back {}: {}", where, *done.failure);
  const std::string run =
      fmt::format("the run failed at time {:.17g} after {} collisions: {}", replay.failure()->time,
                  replay.failure()->collisions, replay.failure()->message);
  if (done.failure) {
    return fmt::format("another failure came {}: {}; {}", where, *done.failure, run);
  }
  return fmt::format("the failure did not come back: {} nothing has failed; {}", where, run);
}

int exit_code_of(const runs::Replay& replay, const runs::Replayed& done) {
  if (!done.failure && done.stop == Stop::interrupted) return stopped;
  if (!replay.failure()) return done.failure ? invalid_state : ok;
  return done.same ? invalid_state : differences_found;
}

template <class Text>
void print_row(const char* name, const Text& text) {
  fmt::print("  {:<14}{}\n", name, text);
}

// The other needle, or what one needle meets.
std::string partner_of(const Happening& happening) {
  if (happening.has_two_needles()) return fmt::to_string(happening.event.second);
  if (happening.kind != Happening::wall) return name_of(happening.kind);
  return fmt::format("wall {}", happening.event.second);
}

void print_collisions(const runs::Replay& replay, const runs::Replayed& done) {
  const auto& failure = replay.failure();
  std::string whose = "all needles";
  if (failure && failure->needles) {
    const auto [first, second] = *failure->needles;
    whose = first == second ? fmt::format("needle {}", first)
                            : fmt::format("needles {} and {}", first, second);
  }
  print_row("collisions", fmt::format("the last {} of {}", done.last.size(), whose));
  fmt::print("  {:>12}  {:>23}  {:>10}  {:>10}  {:>9} {:>9} {:>9}  {:>10}\n", "number", "time",
             "needle", "partner", "x", "y", "z", "V_n");
  for (const runs::NumberedHappening& entry : done.last) {
    const Collision& collision = entry.happening.event;
    const auto place = place_of_contact(collision, box_of(replay.run().scene()));
    fmt::print("  {:>12}  {:>23.17g}  {:>10}  {:>10}  {:>9.5g} {:>9.5g} {:>9.5g}  {:>10.3g}\n",
               entry.number, collision.time, collision.first, partner_of(entry.happening), place[0],
               place[1], place[2], collision.normal_velocity);
  }
}

void print_result(const runs::Replay& replay, const runs::Replayed& done,
                  const std::string& bundle) {
  const Simulation& simulation = replay.run().simulation();
  print_row("bundle", fmt::format("{}: of time {:.17g}, after {} collisions", bundle,
                                  replay.start_time(), replay.start_collisions()));
  const int threads = replay.run().scene().engine.threads.value_or(1);
  print_row("replayed", fmt::format("{} collisions on {} thread{} ({}, {}, {})",
                                    done.collisions - replay.start_collisions(), threads,
                                    threads == 1 ? "" : "s", simulation.search(),
                                    simulation.queue(), simulation.isa()));
  if (!done.last.empty()) print_collisions(replay, done);
}

Json json_of(const runs::NumberedHappening& entry, const Box& box) {
  const Collision& collision = entry.happening.event;
  Json out{{"number", entry.number},
           {"time", collision.time},
           {"needles", {collision.first, collision.second}},
           {"position", place_of_contact(collision, box)},
           {"normal_velocity", number(collision.normal_velocity)},
           {"energy_change", number(collision.energy_change)},
           {"tc", collision.contact_time_rule}};
  if (entry.happening.is_collision()) return out;
  out["kind"] = name_of(entry.happening.kind);
  if (entry.happening.has_two_needles()) return out;
  out["needles"] = {collision.first};
  if (entry.happening.kind == Happening::wall) out["wall"] = collision.second;
  return out;
}

Json json_of(const runs::RunFailure& failure) {
  return {{"message", failure.message},
          {"needles", failure.needles ? Json(*failure.needles) : Json(nullptr)},
          {"time", failure.time},
          {"collisions", failure.collisions},
          {"trajectory_hash", failure.trajectory_hash},
          {"version", failure.version}};
}

Json json_of(const runs::Replay& replay, const runs::Replayed& done, const std::string& bundle) {
  const Simulation& simulation = replay.run().simulation();
  const Scene& scene = replay.run().scene();
  Json last = Json::array();
  for (const auto& entry : done.last) last.push_back(json_of(entry, box_of(scene)));
  return {{"bundle", bundle},
          {"failure", replay.failure() ? json_of(*replay.failure()) : Json(nullptr)},
          {"start", {{"time", replay.start_time()}, {"collisions", replay.start_collisions()}}},
          {"came_back", done.same},
          {"message", done.failure ? Json(*done.failure) : Json(nullptr)},
          {"time", done.time},
          {"collisions", done.collisions},
          {"trajectory_hash", done.trajectory_hash},
          {"threads", scene.engine.threads.value_or(1)},
          {"isa", simulation.isa()},
          {"search", simulation.search()},
          {"queue", simulation.queue()},
          {"last_collisions", last}};
}

}  // namespace

int run(const ReplayArguments& arguments) {
  SignalGuard signals;
  runs::Replay replay(arguments.bundle, arguments.last,
                      [&](Scene& scene) { apply(arguments.engine, scene); });
  signals.interrupt(replay.run().simulation());
  RunProgress progress(arguments.quiet, arguments.progress_every);
  const runs::Replayed done = replay.drive(progress);

  if (arguments.json) {
    fmt::print("{}\n", json_text(json_of(replay, done, arguments.bundle), 2));
  } else if (!arguments.quiet) {
    print_result(replay, done, arguments.bundle);
  }
  const int exit_code = exit_code_of(replay, done);
  if (exit_code == stopped) {
    print_error(fmt::format("stopped by a signal at time {:.6g} after {} collisions", done.time,
                            done.collisions));
  } else if (exit_code != ok) {
    print_error(verdict(replay, done));
  } else if (!arguments.quiet && !arguments.json) {
    print_row("result", verdict(replay, done));
  }
  return exit_code;
}

}  // namespace needlework::cli
