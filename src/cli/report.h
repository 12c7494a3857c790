// The result of a run, as printed when it is over.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "needlework/scene.h"
#include "needlework/simulation.h"
#include "needlework/theory.h"
#include "src/runs/run_driver.h"

namespace needlework::cli {

/// Kinetic theory of a mixture at the times that are asked for.
class MixtureTheory {
 public:
  MixtureTheory(const Composition& composition, double volume,
                std::vector<theory::Temperatures> initial);
  /// Of each species. Quick for times in ascending order, and for those that were asked for before.
  const std::vector<theory::Temperatures>& at(double time);

 private:
  theory::MixtureCurve begin() const { return {composition_, volume_, initial_}; }

  Composition composition_;
  double volume_;
  std::vector<theory::Temperatures> initial_;
  theory::MixtureCurve curve_;
  double time_ = 0;  ///< of the curve
  std::map<double, std::vector<theory::Temperatures>> known_;
};

/// The facts of a run, for people and for programs. Borrows what it is about.
struct Report {
  const Scene& scene;
  const Simulation& simulation;
  const runs::RunResult& result;
  double setup_s = 0;

  /// Per needle and unit time, over the run; NaN if no time has passed.
  double collision_rate() const;
  /// The exact rate of a gas in equilibrium, and the standard error of the measured one; NaN for
  /// other gases, the error also for runs that are too short to estimate it.
  double collision_rate_exact() const;
  double collision_rate_error() const;
  /// Collisions that a needle has taken part in; NaN without needles.
  double collisions_per_needle() const;
  /// CPU time of the event loop, by this process; NaN without collisions.
  double us_per_collision() const;
  /// Collisions of each two species per unit time in equilibrium, by Composition::pair_index; empty
  /// for other gases.
  std::vector<double> pair_rates_exact() const;
  /// What the cooling curve has for a sample; none for a state read from a file or at rest.
  std::optional<theory::Temperatures> theory_at(const Totals& sample) const;
  /// The same of each species of a mixture.
  std::optional<std::vector<theory::Temperatures>> species_theory_at(const Totals& sample) const;
  /// Collisions of a needle per time at the start, by theory.
  double initial_collision_rate() const;

  mutable std::optional<MixtureTheory> mixture_theory = {};  ///< made when it is asked for
};

/// One word for why the run stopped.
std::string stop_name(const runs::RunResult& result);

/// The object that `run --json` prints.
std::string json_of(const Report& report);

/// Some lines for people: what happened, how it compares with theory, what it cost.
std::string summary_of(const Report& report);

}  // namespace needlework::cli
