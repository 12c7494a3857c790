#include "src/cli/audit_command.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "needlework/error.h"
#include "needlework/simulation.h"
#include "src/audit/audit.h"
#include "src/cli/audit_state.h"
#include "src/cli/json.h"
#include "src/cli/messages.h"
#include "src/cli/progress.h"
#include "src/cli/scene_arguments.h"
#include "src/cli/signals.h"
#include "src/runs/duration_text.h"
#include "src/runs/engine_choice.h"
#include "src/runs/exit_codes.h"
#include "src/runs/output_path.h"
#include "src/runs/pace.h"
#include "src/runs/prepared_run.h"
#include "src/runs/resources.h"
#include "src/scene/check.h"

namespace needlework::cli {

using enum runs::ExitCode;
namespace {

/// Longest time in the event loop between two checks of wall time and signals [s].
constexpr double longest_step = 0.25;

struct Outcome {
  Stop stop = Stop::time;
  std::optional<std::string> failure;  ///< of the run
  runs::Stopwatch clock;

  bool is_complete() const { return stop != Stop::interrupted && stop != Stop::wall_time; }
};

audit::Setup setup_of(const Scene& scene, const AuditArguments& arguments, double epoch_length) {
  const Scene::Collisions& collisions = scene.collisions;
  return {.epoch_length = epoch_length,
          .composition = scene.composition(),
          .tc = collisions.tc,
          .tc_relative = collisions.tc_relative,
          .sliding = audit::sliding_of(scene),
          .walls = scene.walls,
          .gravity = scene.forces.gravity,
          .shear = scene.shear,
          .driving = scene.driving,
          .scene_seed = scene.needles.seed,
          .share = arguments.share,
          .seed = arguments.seed};
}

// Runs and audits until the end or a signal.
Outcome follow(Simulation& simulation, audit::Audit& audit, const Scene& scene, bool quiet) {
  RunProgress progress(quiet);
  Outcome outcome;
  outcome.clock.start();
  const double begin = runs::seconds_since_launch();
  const runs::Pace pace(simulation, scene, scene.until, simulation.totals());
  try {
    for (;;) {
      const double elapsed = runs::seconds_since_launch() - begin;
      if (SignalGuard::received()) {
        outcome.stop = Stop::interrupted;
        break;
      }
      if (scene.until.wall_s && elapsed >= *scene.until.wall_s) {
        outcome.stop = Stop::wall_time;
        break;
      }
      if (progress.is_due(elapsed)) {
        progress.show(pace.after(elapsed));
      }
      Scene::Until until = scene.until;
      until.wall_s = longest_step;
      outcome.stop = simulation.advance(until);
      if (outcome.is_complete()) break;
    }
    // until.wall_s does not apply here: an audit that is continued with only these flights left
    // could be stopped by it every time.
    if (outcome.is_complete() && !audit.finish(simulation.time(), SignalGuard::received)) {
      outcome.stop = Stop::interrupted;
    }
    if (outcome.is_complete()) audit.check_end(scene.until, outcome.stop, simulation.time());
  } catch (const InvalidStateError& error) {
    outcome.failure = error.what();
  }
  outcome.clock.stop();
  return outcome;
}

nlohmann::ordered_json findings_json(const audit::Findings& findings,
                                     const AuditArguments& arguments, const Outcome& outcome) {
  nlohmann::ordered_json json;
  json["checked"] = findings.checked;
  for (const audit::Kind kind : audit::kinds) json[audit::name(kind)] = findings.count(kind);
  json["undecided"] = findings.undecided;
  for (const audit::Kind kind : audit::kinds) {
    if (!is_of_collisions(kind)) continue;
    json["bound95"][audit::name(kind)] = number(findings.bound95(kind));
  }
  if (findings.overlaps) {
    json["overlap"] = {{"at_collisions", findings.overlaps->at_collisions},
                       {"at_most", findings.overlaps->at_most}};
  }
  json["collisions"] = findings.collisions;
  json["contacts_entered"] = findings.entered;
  json["contacts_ended"] = findings.ended;
  json["hits"] = findings.hits;
  json["at_walls"] = findings.at_walls;
  json["draws"] = findings.draws;
  json["kicks"] = findings.kicks;
  json["coolings"] = findings.coolings;
  json["contacts"] = findings.contacts;
  json["escalated"] = findings.escalated;
  json["share"] = arguments.share;
  json["complete"] = outcome.is_complete() && !outcome.failure;
  json["wall_s"] = outcome.clock.wall();
  json["cpu_s"] = outcome.clock.cpu();
  json["differences"] = nlohmann::json::array();
  for (const audit::Difference& difference : findings.listed) {
    json["differences"].push_back(
        {{"kind", audit::name(difference.kind)}, {"time", difference.time}});
    if (!is_of_collisions(difference.kind)) continue;
    if (difference.at_wall) {
      json["differences"].back()["needle"] = difference.first;
      json["differences"].back()["wall"] = difference.second;
      continue;
    }
    json["differences"].back()["pair"] = {difference.first, difference.second};
  }
  return json;
}

const char* meaning_of(audit::Kind kind) {
  return kind == audit::Kind::wrong_start
             ? "the initial state is not that of the scene"
             : "the run did not end at the first of the conditions in [until]";
}

std::string text_of(const audit::Findings& findings, const AuditArguments& arguments,
                    const Outcome& outcome) {
  std::string text =
      fmt::format("{} flights of pairs checked{}, {} collisions, in {}\n", findings.checked,
                  arguments.share < 1 ? fmt::format(" ({:g} of all pairs)", arguments.share) : "",
                  findings.collisions, runs::duration_text(outcome.clock.wall()));
  if (findings.at_walls > 0) {
    text += fmt::format("{} flights of needles between walls checked, {} hits\n", findings.at_walls,
                        findings.hits);
  }
  if (findings.entered > 0) {
    text += fmt::format("{} sliding contacts checked, {} of which ended\n", findings.entered,
                        findings.ended);
  }
  if (findings.kicks > 0) {
    text += fmt::format("{} kicks of all needles checked\n", findings.kicks);
  }
  if (findings.coolings > 0) {
    text +=
        fmt::format("{} times checked at which velocities were scaled back\n", findings.coolings);
  }
  if (findings.draws > 0) {
    text += fmt::format(
        "{} draws of the thermostat: that needles go on from where they were; the "
        "velocities that they get are not checked\n",
        findings.draws);
  }
  for (const audit::Kind kind : audit::kinds) {
    if (!is_of_collisions(kind)) continue;
    const double bound = findings.bound95(kind);
    text += fmt::format("{:12} {:8}   {}\n", audit::name(kind), findings.count(kind),
                        std::isnan(bound)
                            ? "no bound, as there was nothing to check"
                            : fmt::format("at most {:.2g} of all collisions (95 %)", bound));
  }
  text +=
      fmt::format("{:12} {:8}   pairs that rounding decides\n", "undecided", findings.undecided);
  if (findings.overlaps) {
    text += fmt::format(
        "{:12} {:8.2g}   of the diameter is the largest at a collision, and {:.2g} what none "
        "exceeds at any time\n",
        "overlap", findings.overlaps->at_collisions, findings.overlaps->at_most);
  }
  for (const audit::Difference& difference : findings.listed) {
    if (!is_of_collisions(difference.kind)) {
      text += fmt::format("{}: {}\n", audit::name(difference.kind), meaning_of(difference.kind));
      continue;
    }
    text += fmt::format("{}: needle{} {} and {}{} at time {:.17g}\n", audit::name(difference.kind),
                        difference.at_wall ? "" : "s", difference.first,
                        difference.at_wall ? "wall " : "", difference.second, difference.time);
  }
  return text;
}

int exit_code_of(const audit::Findings& findings, const Outcome& outcome,
                 const std::optional<std::string>& state) {
  if (outcome.failure) {
    print_error(*outcome.failure);
    return invalid_state;
  }
  if (!outcome.is_complete()) {
    print_error(fmt::format(
        "stopped by {} after {} collisions ({})",
        outcome.stop == Stop::wall_time ? "until.wall_s" : "a signal", findings.collisions,
        state ? "saved in " + *state : "nothing is saved, as no --state file is named"));
    return stopped;
  }
  return findings.clean() ? ok : differences_found;
}

}  // namespace

int run(const AuditArguments& arguments) {
  if (arguments.share == 0) {
    print_error("--share 0: checks no pair: expected a share > 0");
    return bad_usage;
  }
  const runs::LoadedScene loaded = load_scene(arguments.scene);
  const Scene& scene = loaded.scene;
  for (const std::string& warning : runs::all_warnings(loaded)) print_warning(warning);
  if (arguments.state)
    runs::require_writable(*arguments.state, true, "--state " + *arguments.state);
  runs::require_events(loaded, arguments.scene.path);
  Simulation simulation = loaded.initial ? Simulation(scene, *loaded.initial) : Simulation(scene);
  audit::Audit audit(simulation.copy(), setup_of(scene, arguments, simulation.epoch_length()));
  const AuditIdentity identity =
      fmt::format("share {:.17g}, seed {}\n{}", arguments.share, arguments.seed, scene.text);
  if (arguments.state) {
    if (auto checkpoint = read_audit_state(*arguments.state, identity)) {
      audit.resume(std::move(*checkpoint));
    }
  }
  audit.check_start(scene, loaded.initial ? &*loaded.initial : nullptr);
  simulation.on_happening([&](const Happening& happening) { audit.add(happening); });
  simulation.on_kick([&] { audit.add_kick(simulation.copy(), simulation.time()); });
  SignalGuard guard;
  guard.interrupt(simulation);
  const Outcome outcome = follow(simulation, audit, scene, arguments.quiet);
  if (arguments.state && !outcome.failure) {
    if (outcome.is_complete()) {
      std::remove(arguments.state->c_str());
    } else {
      write_audit_state(*arguments.state, identity, audit.checkpoint());
    }
  }
  const audit::Findings findings = audit.checkpoint().findings;
  if (arguments.share < 1 && findings.contacts == 0) {
    print_warning(
        fmt::format("--share {:g}: none of the {} collisions is one of the pairs chosen: expected "
                    "a larger share",
                    arguments.share, findings.collisions));
  }
  if (arguments.json) {
    fmt::print("{}\n", json_text(findings_json(findings, arguments, outcome), 2));
  } else if (!arguments.quiet) {
    fmt::print("{}", text_of(findings, arguments, outcome));
  }
  return exit_code_of(findings, outcome, arguments.state);
}

}  // namespace needlework::cli
