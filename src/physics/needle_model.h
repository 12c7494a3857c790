// Hard needles, or rods, in free flight: the model that is simulated.
#pragma once

#include <cmath>
#include <limits>

#include "needlework/accuracy.h"
#include "src/physics/model.h"
#include "src/physics/sliding_contact.h"

namespace needlework {

/// Infinitely thin needles with normal and tangential restitution or, by another law of contact,
/// smooth rods of finite width or spheres, or such needles among them. Without effects they are
/// smooth needles, lengths and masses are 1, and nothing is looked up by species. With effects,
/// each is asked for when the model runs.
template <bool with_effects, ContactLaw TheLaw = NeedleContact>
class NeedleModel {
 public:
  using Law = TheLaw;
  static constexpr bool has_effects = with_effects;
  static constexpr bool has_sliding = Law::slides;
  static_assert(has_effects || !(Law::has_distance || has_sliding), "bodies are looked up");

  /// Whether the model simulates these effects, all of them and no other one.
  static constexpr bool covers(const Effects& effects) {
    if (Law::has_distance != effects.width || has_sliding != effects.sliding) return false;
    if (Law::has_axes == effects.spheres || Law::mixes != effects.mixed) return false;
    if (effects.rough && Law::rough == Law::surface) return false;
    if (effects.growth && !Law::has_distance) return false;
    if (effects.contact_time && has_sliding) return false;  // both replace the same bounces
    // Contacts that last are of images at rest, and carry momentum besides flights and collisions.
    if (has_sliding && (effects.shear || effects.stress)) return false;
    return has_effects || !effects.any();
  }

  /// `gas` must outlive the model, which must cover the effects.
  NeedleModel(Gas& gas, const Effects& effects, const Accuracy& accuracy)
      : gas_(gas),
        effects_(effects),
        contact_(accuracy),
        only_(gas.composition.only().value_or(0)),
        unit_{.inverse_inertia = 2 * gas.composition[only_].k} {}

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
  decltype(auto) body(Needle i) const {
    if constexpr (has_effects)
      return gas_.body(i);
    else
      return (unit_);
  }
  /// Half the length of the axis of needle i. [L]
  double half_length(Needle i) const {
    if constexpr (has_effects) return gas_.half_length(i);
    return 0.5;
  }
  /// How far it reaches from its centre. Centres of two needles that are farther apart than both
  /// reach cannot be in contact. [L]
  double reach(Needle i) const {
    if constexpr (Law::has_distance || has_sliding) return gas_.reach(i);
    return half_length(i);
  }
  typename Law::Pair pair(Needle a, const Record& record_a, Needle b, const Record& record_b,
                          const Shift& shift) const {
    typename Law::Pair out{make_pair(gas_, a, record_a, b, record_b, shift)};
    if constexpr (has_effects) {
      out.half_first = half_length(a);
      out.half_second = half_length(b);
    }
    if constexpr (Law::has_distance) {
      out.distance = gas_.radius(a) + gas_.radius(b);
      if (gas_.growth) set_present_size(out, Gas::start_of(record_a, record_b));
    }
    if constexpr (has_sliding) out.look_up(gas_, {a, record_a}, {b, record_b}, shift);
    return out;
  }
  const Law& contact() const { return contact_; }
  double time_apart(Needle a, Needle b, const Shift& shift) const {
    if constexpr (!Law::has_axes) {
      if (part_for_good(a, b, shift)) return std::numeric_limits<double>::infinity();
    }
    return contact_.time_apart(pair(a, gas_.records[a], b, gas_.records[b], shift));
  }
  PairOutcome collide(Needle i, Needle j, const Shift& shift, Time now,
                      const kernels::ContactGeometry& contact, int side, bool elastic) const {
    const Record &a = gas_.records[i], &b = gas_.records[j];
    const kernels::Flight &first = a.flight, &second = b.flight;
    const auto outcome = [&](const Impact& impact) {
      return PairOutcome::of(impact, contact, gas_.motion_from(a, now).centre(),
                             gas_.motion_from(b, now).centre(), side);
    };
    if constexpr (has_effects) {
      // The image in contact flies past the needle where rows slide.
      const Vec3d past = gas_.image_velocity(shift);
      const Vec3d v_first = velocity(a, now), its_velocity = velocity(b, now),
                  v_second = gas_.shear ? its_velocity + past : its_velocity;
      CollidingPair both{v_first, first.w, v_second, second.w, body(i), body(j), contact, side};
      if constexpr (Law::has_distance) {
        if (gas_.growth) {
          both.scale = gas_.growth->scale_at(gas_.clock, now);
          both.growth = closing_by_growth(i, j, contact, both.scale);
        }
      }
      const auto in_frames_of_records = [&](Impact impact) {
        if (gas_.shear) impact.v_second = impact.v_second - past;
        return outcome(impact);
      };
      return in_frames_of_records(impact<Law>(both, restitution(a, b), elastic));
    } else {
      const CollidingPair both{first.v, first.w, second.v, second.w,
                               body(i), body(j), contact,  side};
      return outcome(needlework::collide<Law::surface>(both, restitution(a, b)));
    }
  }
  kernels::BodyState present(Needle i, Time now) const {
    if constexpr (has_sliding) return gas_.present(i, now);
    const auto motion = gas_.motion_from(gas_.records[i], now);
    return {motion.centre(), motion.velocity(), motion.director(), motion.angular_velocity()};
  }
  Shift renew(Needle i, Time now, const kernels::BodyState& state) const {
    return renew_record(gas_, i, now, state, body(i));
  }

 private:
  /// Of bodies that grow, how large they are at the start of the time of their pair, and how fast
  /// they grow then. Kept out of the code of others.
  [[gnu::noinline]] void set_present_size(typename Law::Pair& pair, Time start) const {
    const double scale = gas_.growth->scale_at(gas_.clock, start);
    pair.half_first *= scale;
    pair.half_second *= scale;
    pair.distance *= scale;
    pair.growth = gas_.growth->relative_rate(scale);
  }
  /// How fast growth brings the surfaces of two bodies in contact together: the relative rate times
  /// the distance of the centres along the normal, at this scale. [L / time]
  [[gnu::noinline]] double closing_by_growth(Needle i, Needle j,
                                             const kernels::ContactGeometry& contact,
                                             double scale) const {
    const double distance = (gas_.radius(i) + gas_.radius(j)) * scale;
    const Vec3d arms = contact.u_first * contact.arm_first - contact.u_second * contact.arm_second;
    return gas_.growth->relative_rate(scale) * (distance - dot(contact.normal, arms));
  }
  template <ContactLaw Touching>
  [[gnu::always_inline]] static Impact impact(const CollidingPair& pair, const Restitution& rule,
                                              bool elastic) {
    if constexpr (Touching::mixes) {
      const bool thin = pair.body_first.radius == 0 && pair.body_second.radius == 0;
      return thin ? impact<NeedleContact>(pair, rule, elastic)
                  : impact<RodContact>(pair, rule, elastic);
    }
    // Within the contact time needles are smooth, too; spheres stay as rough as they are.
    if (Touching::rough != Touching::surface && rule.is_rough() &&
        !(elastic && Touching::rough == Surface::rough))
      return needlework::collide<Touching::rough>(pair, elastic ? Restitution{1, rule.beta} : rule);
    return needlework::collide<Touching::surface>(pair, elastic ? Restitution{} : rule);
  }
  /// Whether two spheres with records of one time surely fly apart, by numbers in double: most that
  /// have just collided.
  bool part_for_good(Needle a, Needle b, const Shift& shift) const {
    if (gas_.shear) return false;  // images fly past
    const kernels::Flight &first = gas_.records[a].flight, &second = gas_.records[b].flight;
    Vec3d r = first.r - second.r;
    if (!same(shift, Shift{})) r = r - gas_.box.image(shift).place;
    Vec3d v = first.v - second.v;
    double speeds = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
    if (gas_.growth) {
      const double rate =
          gas_.growth->relative_rate(gas_.growth->scale_at(gas_.clock, gas_.records[a].time));
      speeds += rate * (std::abs(r.x) + std::abs(r.y) + std::abs(r.z));
      v = v - r * rate;
    }
    // Far more than what rounds these places, and than what rounds the product.
    const double least = 0x1p-20 * (gas_.radius(a) + gas_.radius(b)) + gas_.touch_tolerance();
    return dot(r, v) > least * speeds;
  }
  Vec3d velocity(const Record& record, Time now) const {
    return gas_.falls ? gas_.motion_from(record, now).velocity() : record.flight.v;
  }

  Gas& gas_;
  Effects effects_;
  Law contact_;
  std::size_t only_;  ///< without effects, the species of all
  Body unit_;         ///< and its body
};

using RodModel = NeedleModel<true, RodContact>;
using SphereModel = NeedleModel<true, SphereContact>;
using MixedModel = NeedleModel<true, MixedContact>;
using SlidingModel = NeedleModel<true, SlidingContact>;

static_assert(Model<NeedleModel<false>> && Model<NeedleModel<true>> && Model<RodModel> &&
              Model<SphereModel> && Model<MixedModel> && Model<SlidingModel>);

}  // namespace needlework
