// The Andersen thermostat: at random times, each needle gets the velocities of a heat bath.
#pragma once

#include <cstdint>
#include <vector>

#include "src/effects/event_source.h"

namespace needlework {

/// Each needle has its velocities drawn anew at exponentially distributed times, from the Maxwell
/// distribution of the bath (H. C. Andersen, J. Chem. Phys. 72, 2384 (1980)). Times and velocities
/// are functions of the seed, the needle's id and the number of its redraws so far.
class Andersen final : public EventSource {
 public:
  struct Parameters {
    double rate = 1;         ///< of redraws of each needle [1 / time]
    double temperature = 1;  ///< of the bath
    std::uint64_t seed = 1;
  };
  /// Adds its columns to the gas.
  Andersen(Gas& gas, const Parameters& parameters);

  const char* name() const override { return "thermostat"; }
  Happening::Kind kind() const override { return Happening::thermostat; }
  void begin(const Gas& gas) override;
  SourceEvent next(const Gas& gas, Needle i, Time now, Time until) const override;
  SourceOutcome happen(const Gas& gas, const NeedleAt& at, std::int8_t detail) override;
  double usual_time() const override { return 1 / parameters_.rate; }
  double usual_temperature() const override { return parameters_.temperature; }
  std::vector<double> parameters() const override;

 private:
  const Parameters parameters_;
  Column<std::uint64_t>& redraws_;  ///< so far
  Column<Time>& next_;              ///< time of the next one
};

}  // namespace needlework
