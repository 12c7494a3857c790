// A run of needles that slide on each other, recorded with all that the audit needs, so that what
// it is told can be altered.
#pragma once

#include <cmath>
#include <vector>

#include "tests/support/audited.h"

namespace needlework::test {

inline Scene sliding_gas(std::uint64_t count, double density, double epsilon) {
  Scene scene = scene_of(count, std::cbrt(static_cast<double>(count) / density));
  scene.collisions.epsilon = epsilon;
  scene.collisions.sliding = true;
  return scene;
}

/// A run of the engine, recorded with all that the audit needs.
struct SlidingRun {
  Scene scene;
  State initial;
  std::vector<Happening> happenings;
  struct Kick {
    std::size_t happenings;  ///< before it
    double time;
    State after;
  };
  std::vector<Kick> kicks;
  audit::Setup setup;
  double end = 0;
  SlidingContacts contacts;

  SlidingRun(const Scene& its_scene, double per_needle) : scene(its_scene) {
    Simulation simulation(scene);
    initial = simulation.copy();
    setup = audit_setup(scene, simulation.epoch_length());
    simulation.on_happening([&](const Happening& happening) { happenings.push_back(happening); });
    simulation.on_kick([&] {
      kicks.push_back({happenings.size(), simulation.time(), simulation.copy()});
    });
    simulation.advance(until_collisions(per_needle / audit_share));
    end = simulation.time();
    contacts = *simulation.sliding_contacts();
  }

  audit::Findings audited() const {
    audit::Audit audit(initial, setup);
    auto kick = kicks.begin();
    for (std::size_t n = 0; n <= happenings.size(); ++n) {
      for (; kick != kicks.end() && kick->happenings == n; ++kick)
        audit.add_kick(kick->after, kick->time);
      if (n < happenings.size()) audit.add(happenings[n]);
    }
    audit.finish(end);
    return audit.findings();
  }
  // Of the first n reports only.
  void stop_after(std::size_t n) {
    if (n >= happenings.size()) return;
    happenings.resize(n);
    std::erase_if(kicks, [&](const Kick& kick) { return kick.happenings >= n; });
    end = happenings.back().event.time;
  }
};

}  // namespace needlework::test
