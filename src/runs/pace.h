// How fast a run goes, from which follows when it ends.
#pragma once

#include <cstdint>

#include "needlework/scene.h"
#include "needlework/simulation.h"
#include "needlework/totals.h"
#include "src/runs/run_monitor.h"

namespace needlework::runs {

/// Measured from its construction on: what was done before took time in another process, or in
/// another call.
class Pace {
 public:
  /// Simulation and scene must outlive it; `initial` are the totals at the start of the run.
  Pace(const Simulation& simulation, const Scene& scene, const Scene::Until& until,
       const Totals& initial);

  /// The progress after so much wall time; without the age of a checkpoint.
  Progress after(double elapsed) const;

 private:
  double fraction_of(const Totals& now, double elapsed) const;
  double fraction_grown() const;

  const Simulation& simulation_;
  const Scene& scene_;
  Scene::Until until_;
  Totals initial_;
  double fraction_before_;
  std::uint64_t collisions_before_;
};

}  // namespace needlework::runs
