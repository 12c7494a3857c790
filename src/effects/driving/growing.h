// Gases whose bodies grow: when they are measured and cooled.
#pragma once

#include <cstdint>
#include <initializer_list>

#include "needlework/stop.h"
#include "src/physics/clock.h"

namespace needlework {

/// Bodies that grow heat a gas. Its velocities are scaled back to the temperature at the start
/// after as many collisions as are asked for, at instants that follow from how many there have been
/// between the last two: so they depend on the trajectory alone, however it is computed. There the
/// pressure is measured, too. How long the first collisions take is not known: until there are
/// enough of them, instants are looks, each at eight times the time of the one before.
class Growing {
 public:
  struct Parameters {
    double temperature = 1;  ///< translational, to which they are scaled back
    double collisions = 0;   ///< between two instants
    bool cools = true;
    double most_pressure = 0;     ///< P V / (N T) that ends the run
    Stop at_most = Stop::jammed;  ///< with this reason
    Stop at_end = Stop::grown;    ///< as bodies have come to their largest sizes
  };
  /// Sums since the start of the run.
  struct Sums {
    std::uint64_t collisions = 0;
    double virial = 0;    ///< of collisions, sum of r12 . dp [energy]
    double integral = 0;  ///< of the translational temperature over time [energy time]

    template <class A>
    void transfer(A& archive) {
      archive(collisions, virial, integral);
    }
  };

  /// `near` is a time in which there may be as many collisions as are asked for.
  Growing(const Parameters& parameters, double near, const Clock& clock)
      : parameters_(parameters), step_(near * first_share), next_(clock.add({}, step_)) {}
  explicit Growing(const Parameters& parameters) : parameters_(parameters) {}

  const Parameters& parameters() const { return parameters_; }
  Time next() const { return next_; }
  /// P V / (N T) over the last collisions that were counted; 0: not measured yet.
  double pressure() const { return pressure_; }
  bool is_over() const { return pressure_ >= parameters_.most_pressure; }
  bool is_looking() const { return then_.collisions == 0; }

  /// To be called at the instant next(), for so many bodies. Finds the one after it.
  void measure(const Clock& clock, Time now, const Sums& sums, double bodies);

  template <class A>
  void transfer(A& archive) {
    archive(parameters_.temperature, step_, next_, pressure_);
    for (Sums* each : {&then_, &measured_}) each->transfer(archive);
  }

 private:
  // Estimates of collision rates are too low by the pressure, which is 1e10 in a packing.
  static constexpr double first_share = 0x1p-40;

  Parameters parameters_;
  double step_ =
      0;  ///< between the last instant and the next; that of a look from the start [time]
  Time next_ = Time::never();
  double pressure_ = 0;
  Sums then_;      ///< at the last instant
  Sums measured_;  ///< as the pressure was last measured
};

}  // namespace needlework
