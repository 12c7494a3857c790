// Two needles that are alone: all their collisions, from the first contact until they part for
// good.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "kernels/contact_function.h"
#include "needlework/composition.h"
#include "needlework/predict.h"
#include "src/physics/body.h"

namespace needlework::boltzmann {

/// Two needles that touch at the origin, each with its arm there.
struct Touching {
  std::array<kernels::Flight, 2> needle;  ///< centre, velocity, director, angular velocity
  std::array<double, 2> arm;              ///< from the centre to the point of contact [L]
};

/// Velocities and directors as given, with the centres where the arms say.
Touching touching(const std::array<Vec3d, 2>& v, const std::array<Vec3d, 2>& u,
                  const std::array<Vec3d, 2>& w, const std::array<double, 2>& arm);

/// How an encounter went.
struct EncounterResult {
  std::uint64_t collisions = 0, tc_collisions = 0;
  bool finished = true;  ///< false if it was given up
};

class Encounter {
 public:
  /// Of two thin needles. `contact_time` is that of the t_c rule. [time]
  Encounter(const std::array<Body, 2>& bodies, const Restitution& rule, double contact_time)
      : bodies_(bodies), rule_(rule), contact_time_(contact_time) {}

  /// One collision; the needles approach.
  void collide(Touching& pair) const { collide(pair, rule_); }
  /// Whether the needles, which approach, have not collided before: flying back they do not meet.
  bool is_first(const Touching& pair) const;
  /// From the first collision to the last one.
  EncounterResult follow(Touching& pair) const;

 private:
  // The next contact of needles that touch and part, flying on (1) or back (-1). Without a contact
  // it is infinitely late; nothing if the search is given up.
  std::optional<FirstContact> next_contact(const Touching& pair, double direction) const;
  void collide(Touching& pair, const Restitution& rule) const;

  std::array<Body, 2> bodies_;
  Restitution rule_;
  double contact_time_;
};

}  // namespace needlework::boltzmann
