// The contact of thin needles that may slide on each other: the end of a step of their contact, or
// a contact with a needle that slides on a third, is an event of the pair as any other.
#pragma once

#include "src/physics/contact.h"
#include "src/physics/slides.h"

namespace needlework {

/// Two needles, one or both of which may be in contact with each other or with others.
struct SlidingPair : kernels::Pair {
  /// What the records say of the two.
  enum class Bond : std::uint8_t {
    none,
    whole,  ///< they slide on each other
    cut     ///< one slides on the other, whose record has been replaced since: due at once
  };

  struct Needle {
    needlework::Needle index;
    const Record& record;
  };
  void look_up(const Gas& gas, const Needle& a, const Needle& b, const Shift& shift_of_second);

  bool any_slides() const { return slide_first || slide_second; }
  /// That of the contact of the two, whole or cut.
  const Slide& joint() const { return joint_is_first ? *slide_first : *slide_second; }

  const Gas* gas = nullptr;
  needlework::Needle first_needle{}, second_needle{};
  const Record *record_first = nullptr, *record_second = nullptr;
  Id id_first{}, id_second{};
  const Slide *slide_first = nullptr, *slide_second = nullptr;  ///< null in free flight
  Bond bond = Bond::none;
  bool joint_is_first = false;
};

/// See ContactLaw. Where neither needle slides it is that of NeedleContact.
class SlidingContact {
 public:
  using Pair = SlidingPair;
  static constexpr bool has_distance = false, never_overlap = false, mixes = false;
  static constexpr Surface surface = Surface::smooth, rough = surface;
  static constexpr bool has_axes = true, slides = true;

  explicit SlidingContact(const Accuracy& accuracy) : free_(accuracy) {}
  const Accuracy& accuracy() const { return free_.accuracy(); }

  kernels::Contact first_contact(const Pair& pair, double from, double to,
                                 kernels::EvaluationCounters& spent) const;
  double gap(const Pair& pair, const DoubleDouble& elapsed) const;
  int side_after(const Pair& pair) const;
  double time_apart(const Pair& pair) const {
    return pair.any_slides() ? 0 : free_.time_apart(pair);
  }
  kernels::ContactGeometry geometry(const Pair& pair, const DoubleDouble& elapsed) const;

 private:
  NeedleContact free_;
};

static_assert(ContactLaw<SlidingContact>);

}  // namespace needlework
