#include "src/scene/own_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

#include "needlework/error.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

std::uint32_t id_of_row(const State& state, std::size_t row) {
  return state.id.empty() ? static_cast<std::uint32_t>(row) : state.id[row];
}

[[noreturn]] void refuse(const State& state, std::size_t row, const char* what, double value,
                         const std::string& expected) {
  throw InputError(fmt::format("state: needle {}: {} = {}: expected {}", id_of_row(state, row), what,
                               value, expected));
}

void require_numbers(const OwnBodies& bodies, std::size_t count) {
  for (const auto& [what, column] : {std::pair("length", &bodies.length),
                                     {"diameter", &bodies.diameter},
                                     {"mass", &bodies.mass},
                                     {"inertia", &bodies.inertia}}) {
    if (column->empty() || column->size() == count) continue;
    throw InputError(
        fmt::format("state: {} rows of {}: expected {}", column->size(), what, count));
  }
}

void require_in_range(const State& state, std::size_t row, const BodyNumbers& body,
                      const BodyNumbers& usual) {
  const auto check = [&](const char* what, double value, const ValueRange& range) {
    if (range.holds(value)) return;
    refuse(state, row, what, value,
           fmt::format("from {:g} to {:g}{}", range.least, range.greatest,
                       range.or_zero ? ", or 0" : ""));
  };
  check("length", body.length, lengths);
  check("diameter", body.diameter, lengths);
  check("mass", body.mass, masses);
  if ((body.length > 0) != (usual.length > 0)) {
    refuse(state, row, "length", body.length,
           usual.length > 0 ? "above 0, as others of its species have one" : "0, as for the others");
  }
  if ((body.diameter > 0) != (usual.diameter > 0)) {
    refuse(state, row, "diameter", body.diameter,
           usual.diameter > 0 ? "above 0, as others of its species have one"
                              : "0, as for the others");
  }
  if (body.length == 0) return;
  const double k = body.mass * (body.length * body.length) / (2 * body.inertia);
  if (!range_of_k.holds(k)) {
    refuse(state, row, "inertia", body.inertia,
           fmt::format("one with which k = m L^2 / (2 I) is from {:g} to {:g}", range_of_k.least,
                       range_of_k.greatest));
  }
}

BodyNumbers body_of_row(const OwnBodies& own, std::size_t row, const Species& species) {
  BodyNumbers out = numbers_of(species);
  const auto take = [&](double& to, const std::vector<double>& column) {
    if (!column.empty()) to = column[row];
  };
  take(out.length, own.length);
  take(out.diameter, own.diameter);
  take(out.mass, own.mass);
  if (!species.given_inertia && out.length > 0)
    out.inertia = out.mass * (out.length * out.length) / (2 * species.k);
  take(out.inertia, own.inertia);
  if (out.length == 0) out.inertia = 0;
  return out;
}

}  // namespace

BodyNumbers numbers_of(const Species& species) {
  return {species.length, species.diameter, species.mass, species.inertia()};
}

std::vector<BodyNumbers> own_bodies_of(const Composition& composition, const State& state) {
  std::vector<BodyNumbers> out;
  if (state.own_bodies.empty()) return out;
  require_numbers(state.own_bodies, state.size());
  const std::vector<SpeciesIndex> species = composition.in_order_of_id(state.species);
  if (species.size() != state.size() && composition.size() > 1) return out;  // refused elsewhere
  std::vector<const BodyNumbers*> usual(composition.size());
  out.reserve(state.size());
  for (std::size_t row = 0; row < state.size(); ++row) {
    const std::size_t its = composition.size() > 1 ? species[row] : 0;
    out.push_back(body_of_row(state.own_bodies, row, composition[its]));
    if (!usual[its]) usual[its] = &out.back();
    require_in_range(state, row, out.back(), *usual[its]);
  }
  return out;
}

std::vector<BodyNumbers> drawn_bodies(const Scene&) { return {}; }

OwnBodies columns_of(const std::vector<BodyNumbers>& bodies) {
  OwnBodies out;
  for (const BodyNumbers& body : bodies) {
    out.length.push_back(body.length);
    out.diameter.push_back(body.diameter);
    out.mass.push_back(body.mass);
    out.inertia.push_back(body.inertia);
  }
  return out;
}

void adopt_own_bodies(Scene& scene, const State& state) {
  const Composition composition = scene.composition();
  const std::vector<BodyNumbers> bodies = own_bodies_of(composition, state);
  if (bodies.empty()) return;
  const std::vector<SpeciesIndex> species = composition.in_order_of_id(state.species);
  std::vector<std::size_t> rows(state.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::ranges::sort(rows, {}, [&](std::size_t row) { return id_of_row(state, row); });
  std::vector<SizesOfBodies> sizes(composition.size());
  for (const std::size_t row : rows)
    sizes[composition.size() > 1 ? species[row] : 0].add(bodies[row]);
  if (scene.species.empty()) scene.species = composition.species();
  for (std::size_t n = 0; n < sizes.size(); ++n) {
    if (sizes[n].count() > 0) scene.species[n] = sizes[n].complete(scene.species[n]);
  }
  if (scene.species.size() == 1) scene.species[0].count = state.size();
}

}  // namespace needlework
