// How near the axes of two bodies come in contact.
//
// Why no pair is left out: axes in contact are apart by both half widths, those of bodies that
// slide included, and searches look as far as the widest body of a class may be from that. Filters
// know the distance of each pair, rounded by less than their margins.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/near_needles.h"
#include "src/memory/large_array.h"
#include "src/physics/gas.h"

namespace needlework {

class ContactDistances {
 public:
  ContactDistances(const Gas& gas, double per_length);

  /// The largest distance of the axis of body i from one in a class with which it is in contact;
  /// `widest_half` is half the largest diameter of that class. [unit of length]
  float largest(Needle i, float widest_half) const { return half_width(i) + widest_half + margin_; }
  /// Half its diameter. [unit of length]
  float half_width(Needle i) const { return half_widths_.empty() ? same_half_ : half_widths_[i]; }
  /// Sets the column `distance` of the first pairs, those of body i with the ones found.
  void set(const kernels::PairColumns& pairs, Needle i, const kernels::Found& found,
           std::size_t count) const;
  /// `order` as of permute().
  void renumber(const std::vector<Needle>& order);

 private:
  float margin_;                   ///< Gas::margin [unit of length]
  float same_half_ = 0;            ///< half the diameter of all, if it is one [unit of length]
  LargeArray<float> half_widths_;  ///< empty if all are equal [unit of length]
};

}  // namespace needlework
