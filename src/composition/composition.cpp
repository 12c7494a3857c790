#include "needlework/composition.h"

#include <algorithm>
#include <cmath>

namespace needlework {

std::uint64_t Composition::count() const {
  std::uint64_t out = 0;
  for (const Species& each : species_) out += each.count;
  return out;
}

std::vector<SpeciesIndex> Composition::in_order_of_id(
    const std::vector<SpeciesIndex>& given) const {
  if (!given.empty()) return given;
  std::vector<SpeciesIndex> out;
  for (std::size_t index = 0; index < size(); ++index) {
    out.insert(out.end(), species_[index].count, static_cast<SpeciesIndex>(index));
  }
  return out;
}

double Composition::longest() const {
  double out = 0;
  for (const Species& each : species_) out = std::max(out, each.length);
  return out;
}

bool Composition::is_rough() const {
  return std::any_of(rules_.begin(), rules_.end(),
                     [](const Restitution& r) { return r.is_rough(); });
}

bool Composition::is_inelastic() const {
  return std::any_of(rules_.begin(), rules_.end(),
                     [](const Restitution& r) { return r.epsilon < 1 || std::abs(r.beta) != 1; });
}

}  // namespace needlework
