// What an event of two needles makes of them: the one form in which rules of collision and effects
// on pairs tell the event loop what has happened.
#pragma once

#include <cstdint>

#include "kernels/body_state.h"
#include "src/physics/collision.h"

namespace needlework {

/// What an event makes of the bond of two needles, which holds those that slide on each other.
enum class BondChange : std::uint8_t { none, begins, continues, ends };

/// The outcome of one event of a pair.
struct PairOutcome {
  kernels::BodyState first, second;  ///< just after the event, in the frames of their records
  int side = 0;  ///< sign of the contact function just after the event; of bonded needles, that
                 ///< from which they came into contact
  BondChange bond = BondChange::none;
  bool collides = true;            ///< an impulse has acted, and the event counts as a collision
  bool contact_time_rule = false;  ///< the t_c rule applied
  double normal_velocity = 0;      ///< V_n before the event [L / time]
  double energy_change = 0;        ///< of both needles, of either sign
  double growth_work = 0;          ///< the part of it that growth has done
  Vec3d impulse;  ///< on the first needle; the second gets the opposite [m L / time]

  bool are_bonded() const { return bond == BondChange::begins || bond == BondChange::continues; }

  /// A collision of needles with these centres.
  static PairOutcome of(const Impact& impact, const kernels::ContactGeometry& contact,
                        const Vec3d& centre_first, const Vec3d& centre_second, int side) {
    PairOutcome out;
    out.first = {centre_first, impact.v_first, contact.u_first, impact.w_first};
    out.second = {centre_second, impact.v_second, contact.u_second, impact.w_second};
    out.side = side;
    out.normal_velocity = impact.normal_velocity;
    out.energy_change = impact.energy_change;
    out.growth_work = impact.growth_work;
    out.impulse = impact.impulse;
    return out;
  }
};

}  // namespace needlework
