// A run of the engine under the audit, kicks included, and whether it found nothing.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "src/audit/audit.h"
#include "tests/support/audit_setup.h"
#include "tests/support/by_build.h"
#include "tests/support/runs.h"

namespace needlework::test {

/// Runs of debug builds are shorter by this factor.
inline constexpr int audit_share = by_build(1, 5);

/// Runs until this time. `alter` changes what the audit is given of the state after each kick.
inline audit::Findings audited(const Scene& scene, double time, const audit::Setup& setup,
                               const std::function<void(State&)>& alter = {}) {
  Simulation simulation(scene);
  audit::Audit audit(simulation.copy(), setup);
  audit.check_start(scene, nullptr);
  simulation.on_happening([&](const Happening& happening) { audit.add(happening); });
  simulation.on_kick([&] {
    State after = simulation.copy();
    if (alter) alter(after);
    audit.add_kick(after, simulation.time());
  });
  const Stop stop = simulation.advance(until_time(time));
  audit.finish(simulation.time());
  audit.check_end(until_time(time), stop, simulation.time());
  return audit.findings();
}

inline audit::Findings audited(const Scene& scene, double time) {
  return audited(scene, time, audit_setup(scene, Simulation(scene).epoch_length()));
}

inline std::string listed(const audit::Findings& findings) {
  std::string text;
  for (const audit::Kind kind : audit::kinds) {
    text += std::string(audit::name(kind)) + " " + std::to_string(findings.count(kind)) + ", ";
  }
  text += "undecided " + std::to_string(findings.undecided) + ", collisions " +
          std::to_string(findings.collisions) + ", checked " + std::to_string(findings.checked);
  for (const auto& each : findings.listed) {
    if (&each - findings.listed.data() > 5) break;
    text += "\n" + std::string(audit::name(each.kind)) + " " + std::to_string(each.time) + " " +
            std::to_string(each.first) + (each.at_wall ? " wall " : " ") +
            std::to_string(each.second);
  }
  return text;
}

inline void expect_clean(const audit::Findings& findings, const std::string& what) {
  EXPECT_TRUE(findings.clean()) << what << ": " << listed(findings);
  // Pairs whose contact rounding decides are one in millions.
  EXPECT_LE(findings.undecided, 1 + findings.checked / 1000000) << what << ": " << listed(findings);
}

/// Needles of three lengths, of which the long ones are few.
inline std::vector<Species> three_species() {
  return {{.name = "short", .count = 100, .length = 0.6, .mass = 0.5, .k = 4},
          {.name = "long", .count = 12, .length = 2.2, .mass = 7, .k = 6, .t_tr = 0.3},
          {.name = "middle", .count = 40, .length = 1, .mass = 1, .k = 2, .t_rot = 2}};
}

}  // namespace needlework::test
