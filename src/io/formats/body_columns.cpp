#include "src/io/formats/body_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "src/io/decimal.h"

namespace needlework::io {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Masses follow from densities but for roundings, and means of equal numbers are rounded, too.
constexpr double rounding = 1e-12;

bool are_same(double a, double b) { return a == b || std::abs(a - b) <= rounding * std::abs(b); }

// Of fixed bodies, masses and moments of inertia are infinite. `if_zero` is what a body is whose
// number may be 0.
double read_positive(const Row& row, std::size_t field, const char* name, const char* if_zero,
                     bool may_be_infinite) {
  const double value = may_be_infinite && is_infinite(row.fields[field])
                           ? std::numeric_limits<double>::infinity()
                           : row.read(field, name);
  if (value > 0 || (if_zero && value == 0)) return value;
  row.reject(fmt::format("{} = {}: expected a number > 0{}", name, value,
                         if_zero ? fmt::format(", or 0 for {}", if_zero) : ""));
}

double volume_of_sphere(double diameter) {
  return std::numbers::pi / 6 * diameter * diameter * diameter;
}

}  // namespace

// `row` is that of the needle that was entered last.
void BodyColumns::add(Column& column, const Row& row, double value) {
  column.rows.push_back(value);
  const double first = column.rows[first_[species_.back()]->needle];
  if ((value == 0) == (first == 0) && std::isinf(value) == std::isinf(first)) return;
  const char* kind = first == 0          ? "0"
                     : std::isinf(first) ? "infinity"
                     : value == 0        ? "a number > 0"
                                         : "a finite number";
  row.reject(
      fmt::format("{} = {}: expected {}, as for others of its species", column.name, value, kind));
}

void BodyColumns::read(const Row& row, std::size_t species) {
  if (first_.size() <= species) first_.resize(species + 1);
  if (!first_[species]) first_[species] = First{species_.size(), {row.path, row.number, {}}};
  species_.push_back(species);
  const char* const length = places_.diameter ? "a sphere" : nullptr;
  if (places_.length)
    add(length_, row, read_positive(row, *places_.length, "length", length, false));
  if (places_.diameter)
    add(diameter_, row, read_positive(row, *places_.diameter, "diameter", "a thin needle", false));
  if (places_.mass) add(mass_, row, read_positive(row, *places_.mass, "mass", nullptr, true));
  if (places_.density) {
    const double density = read_positive(row, *places_.density, "density", nullptr, false);
    add(mass_, row, density * volume_of_sphere(length_.rows.back()));
  }
  if (places_.k) add(k_, row, read_positive(row, *places_.k, "k", nullptr, false));
  if (places_.inertia)
    add(inertia_, row, read_positive(row, *places_.inertia, "inertia", length, true));
}

bool BodyColumns::vary(const Column& column) const {
  const double tolerance = &column == &mass_ && places_.density ? rounding : 0;
  for (std::size_t i = 0; i < column.rows.size(); ++i) {
    const double value = column.rows[i], first = column.rows[first_[species_[i]]->needle];
    if (value != first && !(std::abs(value - first) <= tolerance * first)) return true;
  }
  return false;
}

// With a number for each species: NaN of one without needles, which is left out later, or else the
// usual one if the file names it.
std::vector<double>& BodyColumns::sized(std::vector<double>& numbers,
                                        const Material& material) const {
  const Species usual;
  const double otherwise = material.names.empty()           ? unknown
                           : &numbers == &material.length   ? usual.length
                           : &numbers == &material.mass     ? usual.mass
                           : &numbers == &material.diameter ? usual.diameter
                           : &numbers == &material.inertia  ? 0
                                                            : usual.k;
  numbers.resize(std::max({numbers.size(), first_.size(), material.names.size()}), otherwise);
  return numbers;
}

void BodyColumns::adopt(const Column& column, Material& material) const {
  if (column.rows.empty()) return;
  std::vector<double>& numbers = material.*column.of_species;
  const std::size_t known = numbers.size();
  sized(numbers, material);
  for (std::size_t n = 0; n < first_.size(); ++n) {
    if (!first_[n]) continue;
    const double value = column.rows[first_[n]->needle];
    if (n < known && !are_same(value, numbers[n])) {
      first_[n]->place.reject(fmt::format("{} = {}: expected {}, as the file says of its species",
                                          column.name, value, numbers[n]));
    }
    numbers[n] = value;
  }
}

// Where there is none, by the moments of inertia.
void BodyColumns::find_k(Material& material) const {
  if (inertia_.rows.empty() || !material.k.empty()) return;
  sized(material.k, material);
  for (std::size_t n = 0; n < first_.size(); ++n) {
    if (!first_[n]) continue;
    const double inertia = material.inertia[n];
    const double length = number_of(material.length, n, Species{}.length);
    const double mass = number_of(material.mass, n, Species{}.mass);
    const bool turns = inertia > 0 && std::isfinite(inertia) && std::isfinite(mass);
    material.k[n] = turns ? mass * (length * length) / (2 * inertia) : Species{}.k;
  }
}

OwnBodies BodyColumns::all_of(const Material& material) const {
  OwnBodies own;
  for (std::size_t i = 0; i < species_.size(); ++i) {
    const auto number = [&](const Column& column, double otherwise) {
      return column.rows.empty() ? number_of(material.*column.of_species, species_[i], otherwise)
                                 : column.rows[i];
    };
    const double length = number(length_, Species{}.length), diameter = number(diameter_, 0);
    const double mass = number(mass_, Species{}.mass);
    const double k =
        number(k_, diameter > 0 && length > 0 ? homogeneous_k(length, diameter) : Species{}.k);
    own.length.push_back(length);
    own.diameter.push_back(diameter);
    own.mass.push_back(mass);
    own.inertia.push_back(inertia_.rows.empty()
                              ? length > 0 ? mass * (length * length) / (2 * k) : 0
                              : inertia_.rows[i]);
  }
  return own;
}

// Of what the file says.
void BodyColumns::adopt_means(const OwnBodies& own, Material& material) const {
  struct Sums {
    double count = 0, length = 0, diameter = 0, mass = 0, inertia = 0;
  };
  std::vector<Sums> sums(first_.size());
  for (std::size_t i = 0; i < species_.size(); ++i) {
    Sums& of = sums[species_[i]];
    ++of.count;
    of.length += own.length[i];
    of.diameter += own.diameter[i];
    of.mass += own.mass[i];
    of.inertia += own.inertia[i];
  }
  const auto set = [&](std::vector<double>& numbers, bool is_known, const auto& mean) {
    if (!is_known && numbers.empty()) return;
    sized(numbers, material);
    for (std::size_t n = 0; n < sums.size(); ++n) {
      if (sums[n].count > 0) numbers[n] = mean(sums[n]);
    }
  };
  set(material.length, !length_.rows.empty(), [](const Sums& s) { return s.length / s.count; });
  set(material.diameter, !diameter_.rows.empty(),
      [](const Sums& s) { return s.diameter / s.count; });
  set(material.mass, !mass_.rows.empty(), [](const Sums& s) { return s.mass / s.count; });
  set(material.inertia, !inertia_.rows.empty(), [](const Sums& s) { return s.inertia / s.count; });
  set(material.k, !k_.rows.empty() || !inertia_.rows.empty(), [](const Sums& s) {
    const bool turns = s.inertia > 0 && std::isfinite(s.inertia);
    return turns ? s.mass * (s.length * s.length) / (2 * s.inertia * (s.count * s.count))
                 : Species{}.k;
  });
}

void BodyColumns::settle(Configuration& configuration) const {
  Material& material = configuration.material;
  if (vary(length_) || vary(diameter_) || vary(mass_) || vary(k_) || vary(inertia_)) {
    configuration.state.own_bodies = all_of(material);
    adopt_means(configuration.state.own_bodies, material);
    return;
  }
  for (const Column* column : {&length_, &diameter_, &mass_, &k_, &inertia_})
    adopt(*column, material);
  find_k(material);
}

}  // namespace needlework::io
