#include "src/io/formats/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "needlework/scene.h"
#include "src/box/own_numbers.h"
#include "src/io/bodies.h"
#include "src/io/in_child_process.h"
#include "src/io/source.h"

namespace needlework {

static void transfer(Archive& archive, Scene::WallMotion& motion) {
  auto& [amplitude, frequency, phase, velocity, stop_at, tangential] = motion;
  archive(amplitude, frequency, phase, velocity, stop_at, tangential);
}

static void transfer(Archive& archive, Scene::Wall& wall) {
  auto& [axis, side, epsilon, temperature, motion] = wall;
  archive(axis, side, epsilon, temperature, motion);
}

}  // namespace needlework

namespace needlework::io {
namespace {

std::vector<double> read_numbers(const Source& source, const std::string& path) {
  if (!hdf5::exists(source.get(), path, source.place(path))) return {};
  return Element(source, path).read<double>({});
}

std::vector<double> read_positive(const Source& source, const std::string& path,
                                  bool may_be_infinite = false, bool or_zero = false) {
  std::vector<double> values = read_numbers(source, path);
  for (const double value : values) {
    const bool is_in_range = value > 0 || (or_zero && value == 0);
    if (is_in_range && (may_be_infinite || std::isfinite(value))) continue;
    throw InputError(fmt::format("{} = {}: expected a number {} 0", source.place(path), value,
                                 or_zero ? ">=" : ">"));
  }
  return values;
}

std::vector<std::string> read_texts(const Source& source, const std::string& path) {
  const std::string place = source.place(path);
  if (!hdf5::is_dataset(source.get(), path, place)) return {};
  return hdf5::read_strings(hdf5::open_dataset(source.get(), path, place).get(), place);
}

// What /parameters holds in the scene only. A scene that cannot be read, such as that of a later
// version, says nothing.
void read_surroundings(const Source& source, Material& material) {
  const std::string path = "/parameters/scene";
  const std::vector<std::string> texts = read_texts(source, path);
  if (texts.empty()) return;
  try {
    const Scene scene = parse_recorded_scene(texts.front(), path);
    material.walls = scene.walls;
    material.gravity = scene.forces.gravity;
  } catch (const InputError&) {
  }
}

// A single one is that of all.
bool fits(const std::vector<double>& values, std::size_t count) {
  return values.size() <= 1 || values.size() == count;
}

}  // namespace

static void transfer(Archive& archive, Material& material) {
  auto& [names, length, mass, k, diameter, inertia, epsilon, beta, meet, walls, gravity] = material;
  archive(names, length, mass, k, diameter, inertia, epsilon, beta, meet, walls, gravity);
}

static Material read_material_here(const std::string& path) {
  const Source source(path);
  Material material;
  material.diameter = read_positive(source, "/parameters/diameter", false, true);
  // A rod without an axis is a sphere.
  material.length = has_width(material) ? read_numbers(source, "/parameters/length")
                                        : read_positive(source, "/parameters/length");
  // Without needles, the group of them does not hold their mass.
  constexpr bool may_be_infinite = true;
  material.mass = read_positive(source, "/parameters/mass", may_be_infinite);
  if (material.mass.empty() && !has_own_bodies(source)) material.mass = masses_by_species(source);
  material.k = read_positive(source, "/parameters/k");
  material.epsilon = read_numbers(source, "/parameters/epsilon");
  material.beta = read_numbers(source, "/parameters/beta");
  material.meet = read_numbers(source, "/parameters/meet");
  material.names = read_texts(source, "/parameters/species");
  read_surroundings(source, material);
  material.inertia = read_positive(source, "/parameters/inertia", may_be_infinite, true);
  const std::vector<Species> all = species_of(material);
  if (std::ranges::none_of(all, [](const Species& each) { return each.q > 0; }))
    material.inertia.clear();
  composition_of(material, path);
  return material;
}

std::size_t Material::species() const {
  return std::max({std::size_t{1}, names.size(), length.size(), mass.size(), k.size(),
                   diameter.size(), inertia.size()});
}

std::vector<Species> species_of(const Material& material) {
  std::vector<Species> all(material.species());
  for (std::size_t i = 0; i < all.size(); ++i) {
    Species& each = all[i];
    if (i < material.names.size()) each.name = material.names[i];
    if (each.name.empty()) {
      each.name = all.size() == 1 ? "needles" : fmt::format("needles {}", i + 1);
    }
    each.length = number_of(material.length, i, each.length);
    const double mass = number_of(material.mass, i, each.mass);
    each.fixed = std::isinf(mass);
    if (!each.fixed) each.mass = mass;
    each.diameter = number_of(material.diameter, i, each.diameter);
    each.k = number_of(
        material.k, i,
        each.diameter > 0 && each.has_axis() ? homogeneous_k(each.length, each.diameter) : each.k);
    const double inertia = number_of(material.inertia, i, 0);
    if (!each.has_axis() && std::isfinite(inertia)) each.set_inertia(inertia);
  }
  return all;
}

std::vector<Scene::Wall> single_walls(const std::vector<Scene::Wall>& walls) {
  Scene scene;
  scene.walls = walls;
  std::vector<Scene::Wall> out;
  for (const Scene::WallSide& side : scene.wall_sides()) {
    out.push_back(walls[side.entry]);
    out.back().side = side.is_high ? "high" : "low";
  }
  return out;
}

bool moves(const Scene::WallMotion& motion) {
  return motion.amplitude > 0 || motion.velocity.value_or(0) != 0;
}

bool slides(const Scene::WallMotion& motion) {
  constexpr std::array<double, 2> no_slip{};
  return motion.tangential.value_or(no_slip) != no_slip;
}

const Scene::Wall* wall_at(const Material& material, std::size_t axis, bool high) {
  for (const Scene::Wall& wall : material.walls) {
    const bool there = wall.side == "both" || wall.side == (high ? "high" : "low");
    if (there && wall.axis == std::string(1, "xyz"[axis])) return &wall;
  }
  return nullptr;
}

std::vector<double> lengths_of(const Material& material) {
  std::vector<double> lengths;
  for (const Species& each : species_of(material)) lengths.push_back(each.length);
  return lengths;
}

std::vector<double> diameters_of(const Material& material) {
  std::vector<double> diameters;
  for (const Species& each : species_of(material)) diameters.push_back(each.diameter);
  return diameters;
}

BodyOfRow body_at(const std::vector<Species>& all, const State& state, std::size_t i) {
  const Species& species = all.at(species_at(state, i));
  const OwnBodies& own = state.own_bodies;
  const auto number = [&](const std::vector<double>& rows, double otherwise) {
    return rows.empty() ? otherwise : rows[i];
  };
  BodyOfRow out{.length = number(own.length, species.length),
                .diameter = number(own.diameter, species.diameter),
                .mass = number(own.mass, species.mass_or_infinity()),
                .k = species.k,
                .inertia = 0};
  Species as_it_is{.length = out.length,
                   .mass = out.mass,
                   .k = species.k,
                   .diameter = out.diameter,
                   .q = species.q};
  out.inertia = number(own.inertia, as_it_is.turns() ? as_it_is.inertia() : 0);
  if (!own.inertia.empty() && out.length > 0 && std::isfinite(out.inertia)) {
    as_it_is.set_inertia(out.inertia);
    out.k = as_it_is.k;
  }
  return out;
}

std::vector<bool> which_differ(const State& state, std::size_t species) {
  std::vector<bool> out(species);
  std::vector<std::optional<std::size_t>> first(species);
  for (std::size_t i = 0; i < state.size(); ++i) {
    const std::size_t its = species_at(state, i);
    if (!first[its]) first[its] = i;
    for (const auto& [name, rows] : named_columns(state.own_bodies))
      if (!rows->empty() && (*rows)[i] != (*rows)[*first[its]]) out[its] = true;
  }
  return out;
}

double farthest_end(const std::vector<Species>& all, const State& state) {
  double longest = 0;
  for (const Species& each : all) longest = std::max(longest, each.extent());
  for (std::size_t i = 0; i < state.own_bodies.length.size(); ++i) {
    const BodyOfRow body = body_at(all, state, i);
    longest = std::max(longest, body.length + body.diameter);
  }
  return longest / 2;
}

Material grown(Material material, const State& state) {
  const double scale = state.scale.value_or(1);
  for (std::vector<double>* sizes : {&material.length, &material.diameter})
    for (double& size : *sizes) size *= scale;
  for (double& k : material.k) k *= scale * scale;
  return material;
}

bool has_width(const Material& material) { return !material.diameter.empty(); }

bool are_spheres(const Material& material) {
  return has_width(material) &&
         std::ranges::none_of(species_of(material), [](const Species& s) { return s.has_axis(); });
}

bool differ_in_inertia(const Material& material) {
  const std::vector<Species> all = species_of(material);
  return std::ranges::any_of(all, [&](const Species& each) {
    return each.mass != all[0].mass || each.inertia() != all[0].inertia();
  });
}

Composition composition_of(const Material& material, const std::string& path) {
  const std::size_t count = material.species();
  if (count > most_species) {
    throw InputError(fmt::format("{}: {} species: expected at most {}", path, count, most_species));
  }
  for (const auto& [name, values] :
       {std::pair("length", &material.length), std::pair("mass", &material.mass),
        std::pair("k", &material.k), std::pair("diameter", &material.diameter),
        std::pair("inertia", &material.inertia)}) {
    if (fits(*values, count)) continue;
    throw InputError(fmt::format("{}: {} numbers of {}: expected {}, one for each species", path,
                                 values->size(), name, count));
  }
  for (const auto& [name, values] :
       {std::pair("epsilon", &material.epsilon), std::pair("beta", &material.beta),
        std::pair("meet", &material.meet)}) {
    if (fits(*values, count * count)) continue;
    throw InputError(
        fmt::format("{}: {} numbers of {}: expected one, or {}, one for each two "
                    "species",
                    path, values->size(), name, count * count));
  }
  Composition out(species_of(material), Restitution{});
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a; b < count; ++b) {
      out.set_restitution(a, b,
                          {number_of(material.epsilon, a * count + b, 1),
                           number_of(material.beta, a * count + b, -1)});
      out.set_meets(a, b, number_of(material.meet, a * count + b, 1) != 0);
    }
  }
  return out;
}

Material read_material(const std::string& path) {
  return read_in_child_process(path, [&] { return read_material_here(path); });
}

void require_complete(const Material& material, const std::string& path) {
  for (const auto& [name, values] :
       {std::pair("length", &material.length), std::pair("mass", &material.mass),
        std::pair("k", &material.k), std::pair("epsilon", &material.epsilon)}) {
    if (!values->empty()) continue;
    throw InputError(
        fmt::format("{}: {} of the needles is missing: expected a file that needlework has written",
                    path, name));
  }
}

}  // namespace needlework::io
