// What a run that is watched has shown so far, beside kinetic theory, as charts.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "needlework/scene.h"
#include "needlework/theory.h"
#include "needlework/totals.h"
#include "src/picture/terminal_chart.h"

namespace needlework::cli {

class WatchedRun {
 public:
  /// There is a theory unless the gas starts from a file or at rest, or a caller has replaced its
  /// velocities.
  WatchedRun(const Scene& scene, const Totals& initial, bool theory_holds = true);

  /// Times must not fall.
  void add(const Totals& now);
  /// Number of instants that have been kept: some two hundred in each decade of time.
  std::size_t size() const { return energy_.x.size(); }

  /// Energy, T_tr / T_rot, and collisions per needle and time, over time; all axes are logarithmic.
  std::vector<picture::Panel> panels() const;

 private:
  void add_rate(const Totals& now);
  void add_theory(double time);

  struct Theory {
    theory::CoolingCurve curve;
    double density, time_scale, k;
    picture::Curve energy, ratio, rate;
  };

  Totals initial_;
  Totals last_rate_;  ///< the end of the time over which the last rate was measured
  double needles_;
  picture::Curve energy_, ratio_, rate_;
  std::optional<Theory> theory_;
};

}  // namespace needlework::cli
