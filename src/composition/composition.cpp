#include "needlework/composition.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace needlework {

double Species::volume() const {
  constexpr double pi = std::numbers::pi;
  if (sizes) return sizes->volume;
  return pi * diameter * diameter * (length / 4 + diameter / 6);
}

double homogeneous_k(double length, double diameter) {
  // m L^2 / (2 I) with I = m D^2 (a^3 / 4 + a^2 / 2 + 9 a / 16 + 1 / 5) / (3 a + 2), a = L / D, by
  // the shares x and y of L and D in their sum, either of which may be 0.
  const double x = length / (length + diameter), y = diameter / (length + diameter);
  const double inertia = ((x / 4 + y / 2) * x + 9 * (y * y) / 16) * x + y * y * y / 5;
  return x * x * (3 * x + 2 * y) / (2 * inertia);
}

std::uint64_t Composition::count() const {
  std::uint64_t out = 0;
  for (const Species& each : species_) out += each.count;
  return out;
}

std::uint64_t Composition::fixed() const {
  std::uint64_t out = 0;
  for (const Species& each : species_) out += each.fixed ? each.count : 0;
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

namespace {

// Calls visit(index) for the species with needles, or for all if none has any.
template <class Visit>
void for_each_present(const std::vector<Species>& all, const Visit& visit) {
  const auto has_needles = [](const Species& species) { return species.count > 0; };
  const bool any = std::ranges::any_of(all, has_needles);
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (!any || has_needles(all[n])) visit(n);
  }
}

}  // namespace

std::optional<std::size_t> Composition::only() const {
  std::size_t present = 0, last = 0;
  for_each_present(species_, [&](std::size_t n) {
    ++present;
    last = n;
  });
  return present == 1 ? std::optional(last) : std::nullopt;
}

bool Composition::all_meet() const {
  return std::ranges::none_of(meets_, [](std::uint8_t meets) { return meets == 0; });
}

bool Composition::any_meet() const {
  if (!is_mixture()) return meets(0, 0);
  for (std::size_t a = 0; a < size(); ++a) {
    for (std::size_t b = a; b < size(); ++b) {
      const std::uint64_t others = species_[b].count - (a == b ? 1 : 0);
      if (species_[a].count > 0 && others > 0 && meets(a, b)) return true;
    }
  }
  return false;
}

double Composition::longest() const {
  double out = 0;
  for_each_present(species_,
                   [&](std::size_t n) { out = std::max(out, species_[n].greatest_extent()); });
  return out;
}

double Composition::widest() const {
  double out = 0;
  for_each_present(species_,
                   [&](std::size_t n) { out = std::max(out, species_[n].greatest_diameter()); });
  return out;
}

bool Composition::is_partly_thin() const {
  bool thin = false;
  for_each_present(species_, [&](std::size_t n) { thin = thin || species_[n].diameter == 0; });
  return thin && has_width();
}

bool Composition::are_spheres() const {
  bool out = true;
  for_each_present(species_, [&](std::size_t n) { out = out && !species_[n].has_axis(); });
  return out;
}

bool Composition::has_own_sizes() const {
  return std::ranges::any_of(species_, [](const Species& each) { return each.sizes.has_value(); });
}

double Composition::turning_share() const {
  double half = 0;
  for (const Species& each : species_) {
    if (!each.fixed) half += 0.5 * each.rotations() * static_cast<double>(each.count);
  }
  const std::uint64_t all = count() - fixed();
  return all > 0 ? half / static_cast<double>(all) : 1;
}

double Composition::packing_fraction(double volume) const {
  double out = 0;
  for (const Species& each : species_) {
    out += static_cast<double>(each.count) * (each.volume() / volume);
  }
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
