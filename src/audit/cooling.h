// Bodies that grow heat a gas: their velocities are scaled back to the temperature at the start.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "needlework/scene.h"
#include "src/audit/pair_flight.h"

namespace needlework::audit {

/// How bodies grow that are these at the start: the mean diameter by the rate of the scene times
/// the root of T / m, m the mean mass, in a unit of time.
Growth growth_of(const Scene::Growth& growth, std::span<const Needle> needles);

/// When velocities are scaled back, and by how much; and the pressure between these instants.
class Cooling {
 public:
  /// Collisions between two instants; nothing where velocities are never scaled back.
  static std::optional<double> collisions_of(const Scene::Growth& growth, std::size_t bodies);
  /// `needles` are those at the start.
  Cooling(double collisions, std::span<const Needle> needles);

  /// The next instant: as long after the last one as it would have taken at the rate of collisions
  /// before that, within a factor of 8. The first one follows from an estimate of the engine, and
  /// is taken from when it `is` [epochs].
  Instant next(double is) const { return later(last_, step_ > 0 ? step_ : is); }
  /// Goes on from next(), with so many collisions since the start of so many bodies, whose flights
  /// until then are all over.
  void pass(double is, std::uint64_t collisions, std::size_t bodies);

  /// A flight that is over now, and r12 . dp of a collision.
  void add_flight(const Needle& needle, const Vector<double>& gravity, const Instant& now);
  void add_collision(double virial) { virial_ += virial; }
  /// P V / (N T) between the last two instants with enough collisions between them, and the largest
  /// one before; 0: none yet.
  double pressure() const { return pressure_; }
  double pressure_before() const { return before_; }

  /// By which factor all velocities change then.
  Quad factor(std::span<const Needle> needles, const Vector<double>& gravity,
              const Instant& now) const;

 private:
  double wanted_;
  double step_ = 0;  ///< [epochs]
  Instant last_;
  std::uint64_t collisions_ = 0;  ///< until then
  std::uint64_t measured_ = 0;    ///< the same when the pressure was measured
  double virial_ = 0;             ///< since then
  double integral_ = 0;           ///< since then, of the sum of m v^2 over time
  double pressure_ = 0, before_ = 0;
  Quad squares_;  ///< at the start, the sum of m v^2
};

/// Largest difference of a needle's record from what it becomes as velocities change by this
/// factor, in units of what rounding may explain; a value above 1 is an error.
double excess_over_cooling(const Needle& before, const Record& after, const Quad& factor,
                           const Space& space);

}  // namespace needlework::audit
