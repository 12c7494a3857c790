// Hard needles, or rods, in free flight: the model that is simulated.
#pragma once

#include "needlework/accuracy.h"
#include "src/physics/model.h"
#include "src/physics/sliding_contact.h"

namespace needlework {

/// Infinitely thin needles with normal and tangential restitution or, by another law of contact,
/// smooth rods of finite width. Without effects they are smooth needles, lengths and masses are 1,
/// and nothing is looked up by species. With effects, each is asked for when the model runs.
template <bool with_effects, ContactLaw Law = NeedleContact>
class NeedleModel {
 public:
  static constexpr bool has_effects = with_effects;
  static constexpr bool has_width = Law::excludes_volume;
  static constexpr bool has_sliding = Law::slides;
  static_assert(has_effects || !(has_width || has_sliding), "these are looked up by species");

  /// `gas` must outlive the model. Without effects, `effects` must have none.
  NeedleModel(Gas& gas, const Effects& effects, const Accuracy& accuracy)
      : gas_(gas),
        effects_(effects),
        contact_(accuracy),
        only_(gas.composition.only().value_or(0)) {}

  Effects effects() const {
    if constexpr (has_effects) return effects_;
    return {};
  }
  Gas& gas() const { return gas_; }
  const Restitution& restitution(const Record& a, const Record& b) const {
    if constexpr (has_effects) return gas_.composition.restitution(a.species, b.species);
    return gas_.composition.restitution(only_, only_);
  }
  const Accuracy& accuracy() const { return contact_.accuracy(); }

  FreeFlight motion(const Record& record) const {
    if constexpr (has_effects) return gas_.motion(record);
    return FreeFlight(record.flight);
  }
  /// Half the length of the axis of needle i. [L]
  double half_length(Needle i) const {
    if constexpr (has_effects) return gas_.bodies[gas_.records[i].species].half_length;
    return 0.5;
  }
  /// How far it reaches from its centre. Centres of two needles that are farther apart than both
  /// reach cannot be in contact. [L]
  double reach(Needle i) const {
    if constexpr (has_width || has_sliding) return gas_.bodies[gas_.records[i].species].reach();
    return half_length(i);
  }
  typename Law::Pair pair(Needle a, const Record& record_a, Needle b, const Record& record_b,
                          const Shift& shift) const {
    typename Law::Pair out{make_pair(gas_, a, record_a, b, record_b, shift)};
    if constexpr (has_effects) {
      out.half_first = body(record_a).half_length;
      out.half_second = body(record_b).half_length;
    }
    if constexpr (has_width) out.distance = body(record_a).radius + body(record_b).radius;
    if constexpr (has_sliding) out.look_up(gas_, {a, record_a}, {b, record_b}, shift);
    return out;
  }
  const Law& contact() const { return contact_; }
  Impact collide(const Record& a, const Record& b, Time now,
                 const kernels::ContactGeometry& contact, int side, bool elastic) const {
    const kernels::Flight &first = a.flight, &second = b.flight;
    if constexpr (has_effects) {
      const Vec3d v_first = velocity(a, now), v_second = velocity(b, now);
      const Meeting both{v_first, first.w, v_second, second.w, body(a), body(b), contact, side};
      constexpr Surface smooth = has_width ? Surface::wide : Surface::smooth;
      if (elastic) return needlework::collide<smooth>(both, Restitution{});
      const Restitution& rule = restitution(a, b);
      if (!has_width && rule.is_rough()) return needlework::collide<Surface::rough>(both, rule);
      return needlework::collide<smooth>(both, rule);
    } else {
      const Meeting both{first.v, first.w, second.v, second.w, body(a), body(b), contact, side};
      return needlework::collide<Surface::smooth>(both, restitution(a, b));
    }
  }

  Shift renew(Needle i, Time now, const Vec3d& director, const Vec3d& velocity,
              const Vec3d& angular_velocity) const {
    return renew_record(gas_, i, now, {director, velocity, angular_velocity, extent(i)});
  }
  Shift renew_in_flight(Needle i, Time now) const {
    const Record& record = gas_.records[i];
    const auto present = gas_.motion_from(record, now);
    return renew(i, now, present.director(), present.velocity(), present.angular_velocity());
  }
  /// The same as renew(), of a needle that may slide at present.
  Shift renew_from(Needle i, Time now, const kernels::Stance& present) const {
    return renew_record_from(gas_, i, now, present.r, {present.u, present.v, present.w, extent(i)});
  }

 private:
  /// From end to end. [L]
  double extent(Needle i) const { return 2 * (has_sliding ? half_length(i) : reach(i)); }
  Vec3d velocity(const Record& record, Time now) const {
    return gas_.falls ? gas_.motion_from(record, now).velocity() : record.flight.v;
  }
  Body body(const Record& record) const {
    if constexpr (has_effects) return gas_.bodies[record.species];
    return {
        .half_length = 0.5, .inverse_mass = 1, .inverse_inertia = 2 * gas_.composition[only_].k};
  }

  Gas& gas_;
  Effects effects_;
  Law contact_;
  std::size_t only_;  ///< without effects, the species of all
};

using RodModel = NeedleModel<true, RodContact>;
using SlidingModel = NeedleModel<true, SlidingContact>;

static_assert(Model<NeedleModel<false>> && Model<NeedleModel<true>> && Model<RodModel> &&
              Model<SlidingModel>);

}  // namespace needlework
