// The interface of contacts of two bodies: when they touch, and how.
#pragma once

#include <concepts>

#include "kernels/first_contact.h"
#include "kernels/rod_contact.h"
#include "kernels/sphere_contact.h"
#include "needlework/accuracy.h"
#include "src/physics/collision.h"

namespace needlework {

/// A contact of two bodies, described by a contact function: it is 0 at a contact, and its value
/// [L] is called the gap. Thin needles cross it from either side, so that a pair is on one side of
/// each other or the other, 1 or -1; bodies that exclude a volume are always on side 1.
///
/// `Pair` is what it needs to know of two bodies, kernels::Pair or more. Of a law is known:
///   `has_distance`: the axes of bodies in contact are apart by Pair::distance, so that collisions
///     push along the line between them, which adds to the virial;
///   `never_overlap`: bodies never pass through each other, so that a lost contact leaves an
///     overlap, which first_contact() reports;
///   `mixes`: of some pairs Pair::distance is 0, which are two thin needles;
///   `surface`: the rule of collisions for beta = -1, and that for others (`rough`), which is the
///     same where there are none;
///   `has_axes`: bodies are needles or rods, or there may be some among them;
///   `slides`: bodies may slide on each other (src/physics/sliding_contact.h).
///
/// All are pure functions of the pair. They do not depend on when they are called, on the search or
/// on the thread. Exchanging the bodies and negating the shift changes no bit. None throws.
///   `first_contact(pair, from, to, spent)` returns the first contact in (0, to], as a time since
///     the later record. The caller knows that there is none before `from`. If the pair touches to
///     within rounding and its records do not hold the side, it decides nothing and sets
///     `side_unknown`.
///   `gap(pair, elapsed)` is the value of the contact function; where the pair holds a touch, it is
///     continued from that touch.
///   `side_after(pair)` is for a pair that touches at the time of the later record: the sign of the
///     gap just after it, or 0 if there is none.
///   `time_apart(pair)` is for a pair that has just collided, at the time of both records: no
///     contact comes before it.
///   `geometry(pair, elapsed)` is for the moment of a contact: directors, normal and arms.
template <class C>
concept ContactLaw = requires(const C& contact, const typename C::Pair& pair, double time,
                              const DoubleDouble& elapsed, kernels::EvaluationCounters& spent) {
  requires std::derived_from<typename C::Pair, kernels::Pair>;
  { C::has_distance } -> std::convertible_to<bool>;
  { C::never_overlap } -> std::convertible_to<bool>;
  { C::mixes } -> std::convertible_to<bool>;
  { C::surface } -> std::convertible_to<Surface>;
  { C::rough } -> std::convertible_to<Surface>;
  { C::has_axes } -> std::convertible_to<bool>;
  { C::slides } -> std::convertible_to<bool>;
  { contact.first_contact(pair, time, time, spent) } -> std::same_as<kernels::Contact>;
  { contact.gap(pair, elapsed) } -> std::convertible_to<double>;
  { contact.side_after(pair) } -> std::convertible_to<int>;
  { contact.time_apart(pair) } -> std::convertible_to<double>;
  { contact.geometry(pair, elapsed) } -> std::same_as<kernels::ContactGeometry>;
};

/// The contact of thin needles: f = r12 . (u1 x u2) vanishes within both lengths.
class NeedleContact {
 public:
  using Pair = kernels::Pair;
  static constexpr bool has_distance = false, never_overlap = false, mixes = false;
  static constexpr Surface surface = Surface::smooth, rough = Surface::rough;
  static constexpr bool has_axes = true, slides = false;

  explicit NeedleContact(const Accuracy& accuracy) : accuracy_(accuracy) {}
  const Accuracy& accuracy() const { return accuracy_; }

  kernels::Contact first_contact(const kernels::Pair& pair, double from, double to,
                                 kernels::EvaluationCounters& spent) const {
    return kernels::first_contact(pair, from, to, spent, accuracy_);
  }
  double gap(const kernels::Pair& pair, const DoubleDouble& elapsed) const {
    return gap_at(pair, elapsed);
  }
  int side_after(const kernels::Pair& pair) const { return kernels::side_after(pair); }
  double time_apart(const kernels::Pair& pair) const { return kernels::time_apart(pair); }
  kernels::ContactGeometry geometry(const kernels::Pair& pair, const DoubleDouble& elapsed) const {
    return contact_geometry(pair, elapsed);
  }

 private:
  Accuracy accuracy_;
};

static_assert(ContactLaw<NeedleContact>);

/// The contact of rods of finite width: their axes are their mean diameter apart.
class RodContact {
 public:
  using Pair = kernels::RodPair;
  static constexpr bool has_distance = true, never_overlap = true, mixes = false;
  static constexpr Surface surface = Surface::wide;
  static constexpr Surface rough = Surface::rough_sphere;  ///< of two spheres; others are smooth
  static constexpr bool has_axes = true, slides = false;

  explicit RodContact(const Accuracy& accuracy) : accuracy_(accuracy) {}
  const Accuracy& accuracy() const { return accuracy_; }

  kernels::Contact first_contact(const Pair& pair, double from, double to,
                                 kernels::EvaluationCounters& spent) const {
    return kernels::rod_contact(pair, from, to, spent, accuracy_);
  }
  double gap(const Pair& pair, const DoubleDouble& elapsed) const {
    return kernels::rod_gap(pair, elapsed);
  }
  int side_after(const Pair&) const { return 1; }
  double time_apart(const Pair& pair) const { return kernels::rod_time_apart(pair); }
  kernels::ContactGeometry geometry(const Pair& pair, const DoubleDouble& elapsed) const {
    return kernels::rod_geometry(pair, elapsed);
  }

 private:
  Accuracy accuracy_;
};

static_assert(ContactLaw<RodContact>);

/// The contact of spheres, in gases of spheres alone: that of rods, without axes.
class SphereContact : public RodContact {
 public:
  static constexpr Surface surface = Surface::sphere;
  static constexpr bool has_axes = false;

  using RodContact::RodContact;

  kernels::Contact first_contact(const Pair& pair, double, double to,
                                 kernels::EvaluationCounters& spent) const {
    return kernels::sphere_contact(pair, to, spent, accuracy());
  }
  double time_apart(const Pair& pair) const { return kernels::sphere_time_apart(pair); }
  kernels::ContactGeometry geometry(const Pair& pair, const DoubleDouble& elapsed) const {
    return kernels::sphere_geometry(pair, elapsed);
  }
};

static_assert(ContactLaw<SphereContact>);

/// The contact of bodies some of which are thin needles and others not: of two thin needles that of
/// needles, of any other two that of rods, whose radii may be 0 for one of them.
class MixedContact {
 public:
  using Pair = kernels::RodPair;

 private:
  /// What ask(law) returns for the law of the pair.
  template <class Ask>
  auto of(const Pair& pair, const Ask& ask) const {
    return pair.distance > 0 ? ask(wide_) : ask(thin_);
  }

 public:
  static constexpr bool has_distance = true, never_overlap = true, mixes = true;
  /// Of pairs with a distance; thin ones may be rough, too.
  static constexpr Surface surface = Surface::wide, rough = Surface::rough_sphere;
  static constexpr bool has_axes = true, slides = false;

  explicit MixedContact(const Accuracy& accuracy) : thin_(accuracy), wide_(accuracy) {}
  const Accuracy& accuracy() const { return thin_.accuracy(); }

  kernels::Contact first_contact(const Pair& pair, double from, double to,
                                 kernels::EvaluationCounters& spent) const {
    return of(pair, [&](const auto& law) { return law.first_contact(pair, from, to, spent); });
  }
  double gap(const Pair& pair, const DoubleDouble& elapsed) const {
    return of(pair, [&](const auto& law) { return law.gap(pair, elapsed); });
  }
  int side_after(const Pair& pair) const {
    return of(pair, [&](const auto& law) { return law.side_after(pair); });
  }
  double time_apart(const Pair& pair) const {
    return of(pair, [&](const auto& law) { return law.time_apart(pair); });
  }
  kernels::ContactGeometry geometry(const Pair& pair, const DoubleDouble& elapsed) const {
    return of(pair, [&](const auto& law) { return law.geometry(pair, elapsed); });
  }

 private:
  NeedleContact thin_;
  RodContact wide_;
};

static_assert(ContactLaw<MixedContact>);

}  // namespace needlework
