#include "src/search/contact_distances.h"

#include <algorithm>

#include "src/physics/permutation.h"

namespace needlework {
namespace {

bool have_one_width(const Gas& gas) {
  for (Needle i{0}; i < gas.size(); ++i) {
    if (gas.body(i).width() != gas.body(Needle(0)).width()) return false;
  }
  return true;
}

}  // namespace

ContactDistances::ContactDistances(const Gas& gas, double per_length)
    : margin_(static_cast<float>(gas.margin * per_length)) {
  if (gas.size() == 0) return;
  same_half_ = static_cast<float>(gas.radius(Needle(0)) * per_length);
  if (have_one_width(gas)) return;
  half_widths_.resize(gas.size());
  for (Needle i{0}; i < gas.size(); ++i) {
    half_widths_[i] = static_cast<float>(gas.body(i).width() * per_length);
  }
}

void ContactDistances::set(const kernels::PairColumns& pairs, Needle i, const kernels::Found& found,
                           std::size_t count) const {
  float* const distance = pairs.column[kernels::PairColumns::distance];
  if (half_widths_.empty()) {
    std::fill_n(distance, count, 2 * same_half_);
    return;
  }
  const float own = half_widths_[i];
  for (std::size_t k = 0; k < count; ++k) distance[k] = own + half_widths_[Needle(found.needle[k])];
}

void ContactDistances::renumber(const std::vector<Needle>& order) {
  if (!half_widths_.empty()) permute(half_widths_, order);
}

}  // namespace needlework
