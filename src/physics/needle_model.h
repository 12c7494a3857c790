// Hard needles in free flight: the model that is simulated.
#pragma once

#include "needlework/accuracy.h"
#include "src/physics/model.h"

namespace needlework {

/// Infinitely thin rods with normal and tangential restitution. Without effects they are smooth,
/// lengths and masses are 1, and nothing is looked up by species. With effects, each is asked for
/// when the model runs.
template <bool with_effects>
class NeedleModel {
 public:
  static constexpr bool has_effects = with_effects;

  /// `gas` must outlive the model. Without effects, `effects` must have none.
  NeedleModel(Gas& gas, const Effects& effects, const Accuracy& accuracy)
      : gas_(gas), effects_(effects), contact_(accuracy) {}

  Effects effects() const {
    if constexpr (has_effects) return effects_;
    return {};
  }
  Gas& gas() const { return gas_; }
  const Restitution& restitution(const Record& a, const Record& b) const {
    if constexpr (has_effects) return gas_.composition.restitution(a.species, b.species);
    return gas_.composition.rules().front();
  }
  const Accuracy& accuracy() const { return contact_.accuracy(); }

  FreeFlight motion(const Record& record) const {
    if constexpr (has_effects) return gas_.motion(record);
    return FreeFlight(record.flight);
  }
  /// Half the length of needle i. [L]
  double half_length(Needle i) const {
    if constexpr (has_effects) return gas_.bodies[gas_.records[i].species].half_length;
    return 0.5;
  }
  /// Centres farther apart than this cannot be in contact. [L]
  double reach(const Record& a, const Record& b) const {
    return body(a).half_length + body(b).half_length;
  }
  kernels::Pair pair(Needle a, const Record& record_a, Needle b, const Record& record_b,
                     const Shift& shift) const {
    kernels::Pair out = make_pair(gas_, a, record_a, b, record_b, shift);
    if constexpr (has_effects) {
      out.half_first = body(record_a).half_length;
      out.half_second = body(record_b).half_length;
    }
    return out;
  }
  const NeedleContact& contact() const { return contact_; }
  Impact collide(const Record& a, const Record& b, Time now,
                 const kernels::ContactGeometry& contact, int side, bool elastic) const {
    const kernels::Flight &first = a.flight, &second = b.flight;
    if constexpr (has_effects) {
      const Vec3d v_first = velocity(a, now), v_second = velocity(b, now);
      const Meeting both{v_first, first.w, v_second, second.w, body(a), body(b), contact, side};
      if (elastic) return needlework::collide<true>(both, Restitution{});
      if (restitution(a, b).is_rough()) return needlework::collide<false>(both, restitution(a, b));
      return needlework::collide<true>(both, restitution(a, b));
    } else {
      const Meeting both{first.v, first.w, second.v, second.w, body(a), body(b), contact, side};
      return needlework::collide<true>(both, restitution(a, b));
    }
  }

  Shift renew(Needle i, Time now, const Vec3d& director, const Vec3d& velocity,
              const Vec3d& angular_velocity) const {
    return renew_record(gas_, i, now, {director, velocity, angular_velocity, 2 * half_length(i)});
  }
  Shift renew_in_flight(Needle i, Time now) const {
    const Record& record = gas_.records[i];
    const auto present = gas_.motion_from(record, now);
    return renew(i, now, present.director(), present.velocity(), present.angular_velocity());
  }

 private:
  Vec3d velocity(const Record& record, Time now) const {
    return gas_.falls ? gas_.motion_from(record, now).velocity() : record.flight.v;
  }
  Body body(const Record& record) const {
    if constexpr (has_effects) return gas_.bodies[record.species];
    return {.half_length = 0.5, .inverse_mass = 1, .inverse_inertia = 2 * gas_.composition[0].k};
  }

  Gas& gas_;
  Effects effects_;
  NeedleContact contact_;
};

static_assert(Model<NeedleModel<false>> && Model<NeedleModel<true>>);

}  // namespace needlework
