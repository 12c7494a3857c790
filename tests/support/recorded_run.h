// A run of the engine, recorded with all that the audit needs, so that what it is told can be
// altered.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "src/audit/audit.h"
#include "tests/support/audit_setup.h"
#include "tests/support/runs.h"

namespace needlework::test {

struct RecordedRun {
  Scene scene;
  State initial;
  std::vector<Happening> happenings;
  /// Of all needles, or when velocities of bodies that grow have been scaled back.
  struct Kick {
    std::size_t happenings;  ///< before it
    double time;
    State after;
  };
  std::vector<Kick> kicks;
  audit::Setup setup;
  Stop stop{};
  double end = 0;

  RecordedRun(const Scene& its_scene, const Scene::Until& until) : scene(its_scene) {
    Simulation simulation(scene);
    record(simulation, until);
  }

  /// `at_end` may check more of the audit.
  audit::Findings audited(const std::function<void(audit::Audit&)>& at_end = {}) const {
    audit::Audit audit(initial, setup);
    audit.check_start(scene, nullptr);
    auto kick = kicks.begin();
    for (std::size_t n = 0; n <= happenings.size(); ++n) {
      for (; kick != kicks.end() && kick->happenings == n; ++kick)
        audit.add_kick(kick->after, kick->time);
      if (n < happenings.size()) audit.add(happenings[n]);
    }
    audit.finish(end);
    if (at_end) at_end(audit);
    return audit.findings();
  }
  /// Leaves out the n-th of what has happened, or adds something before it.
  void leave_out(std::size_t n) {
    happenings.erase(happenings.begin() + static_cast<std::ptrdiff_t>(n));
    for (Kick& kick : kicks) kick.happenings -= kick.happenings > n;
  }
  void insert(std::size_t n, const Happening& happening) {
    happenings.insert(happenings.begin() + static_cast<std::ptrdiff_t>(n), happening);
    for (Kick& kick : kicks) kick.happenings += kick.happenings > n;
  }
  /// Of the first n reports only.
  void stop_after(std::size_t n) {
    if (n >= happenings.size()) return;
    happenings.resize(n);
    std::erase_if(kicks, [&](const Kick& kick) { return kick.happenings >= n; });
    end = happenings.back().event.time;
  }

 protected:
  explicit RecordedRun(const Scene& its_scene) : scene(its_scene) {}
  void record(Simulation& simulation, const Scene::Until& until) {
    initial = simulation.copy();
    setup = audit_setup(scene, simulation.epoch_length());
    simulation.on_happening([&](const Happening& happening) { happenings.push_back(happening); });
    simulation.on_kick([&] {
      kicks.push_back({happenings.size(), simulation.time(), simulation.copy()});
    });
    stop = simulation.advance(until);
    end = simulation.time();
  }
};

}  // namespace needlework::test
