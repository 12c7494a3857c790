#include "src/io/bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "needlework/composition.h"
#include "needlework/error.h"

namespace needlework::io {
namespace {

using hdf5::Handle;

bool has_dataset(const Source& source, const std::string& path) {
  return hdf5::is_dataset(source.get(), path, source.place(path));
}

bool is_assumed(const Source& source, const std::string& path) {
  const std::string place = source.place(path);
  const Handle dataset = hdf5::open_dataset(source.get(), path, place);
  return hdf5::check(H5Aexists(dataset.get(), "assumed"), place) > 0;
}

// Of a dataset with one number, or with one for each species. /parameters is where other programs
// keep what they like, so that a dataset of this name may be something else.
std::vector<double> read_numbers(const Source& source, const std::string& name) {
  const std::string path = "/parameters/" + name, place = source.place(path);
  if (!has_dataset(source, path) || is_assumed(source, path)) return {};
  const Handle dataset = hdf5::open_dataset(source.get(), path, place);
  const Handle type(H5Dget_type(dataset.get()), H5Tclose, place);
  const H5T_class_t kind = H5Tget_class(type.get());
  if ((kind != H5T_FLOAT && kind != H5T_INTEGER) || hdf5::shape_of(dataset.get(), place).size() > 1)
    return {};
  std::vector<double> values = Element(source, path).read<double>({});
  if (values.size() > most_species) {
    throw InputError(
        fmt::format("{}: {} species: expected at most {}", place, values.size(), most_species));
  }
  const bool may_be_zero = name == "length" || name == "diameter" || name == "inertia";
  for (const double value : values) {
    const bool is_fixed = (name == "mass" || name == "inertia") && std::isinf(value);
    if ((std::isfinite(value) || is_fixed) && (value > 0 || (may_be_zero && value == 0))) continue;
    throw InputError(
        fmt::format("{} = {}: expected a number {} 0", place, value, may_be_zero ? ">=" : ">"));
  }
  return values;
}

std::vector<std::string> read_names(const Source& source) {
  const std::string path = "/parameters/species", place = source.place(path);
  if (!has_dataset(source, path) || is_assumed(source, path)) return {};
  const Handle dataset = hdf5::open_dataset(source.get(), path, place);
  if (hdf5::type_name(dataset.get(), place) != "string") return {};
  return hdf5::read_strings(dataset.get(), place);
}

}  // namespace

std::vector<double> masses_by_species(const Source& source) {
  const std::string group = find_particles(source), path = group + "/mass",
                    path_of_species = group + "/species";
  const auto read = [&](const std::string& name) -> std::vector<double> {
    if (!hdf5::exists(source.get(), name, source.place(name))) return {};
    return Element(source, name).read<double>({});
  };
  const std::vector<double> masses = read(path);
  std::vector<double> indices = read(path_of_species);
  indices.resize(masses.size());
  std::vector<double> of_species;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    if (!(masses[i] > 0)) {
      throw InputError(
          fmt::format("{} = {}: expected a number > 0", source.place(path), masses[i]));
    }
    if (!(indices[i] >= 0 && indices[i] < most_species)) {
      throw InputError(fmt::format("{}[{}] = {}: expected an index below {}",
                                   source.place(path_of_species), i, indices[i], most_species));
    }
    const auto index = static_cast<std::size_t>(indices[i]);
    if (of_species.size() <= index) of_species.resize(index + 1);
    if (of_species[index] == 0) of_species[index] = masses[i];
    if (of_species[index] == masses[i]) continue;
    throw InputError(
        fmt::format("{}[{}] = {}: expected {}, as of the needles before: those of a "
                    "species are equal",
                    source.place(path), i, masses[i], of_species[index]));
  }
  return of_species;
}

Bodies read_bodies(const Source& source) {
  Bodies bodies;
  bodies.names = read_names(source);
  bodies.length = read_numbers(source, "length");
  bodies.diameter = read_numbers(source, "diameter");
  bodies.mass = read_numbers(source, "mass");
  bodies.k = read_numbers(source, "k");
  // An import that has assumed another number has the moment of inertia by it.
  const auto is_assumed_here = [&](const char* name) {
    const std::string path = std::string("/parameters/") + name;
    return has_dataset(source, path) && is_assumed(source, path);
  };
  if (std::ranges::none_of(std::array{"length", "mass", "k"}, is_assumed_here))
    bodies.inertia = read_numbers(source, "inertia");
  if (bodies.inertia.size() != bodies.length.size()) bodies.inertia.clear();
  if (!has_dataset(source, "/parameters/mass") && !has_own_bodies(source))
    bodies.mass = masses_by_species(source);
  // There is a species of which the file has no particle.
  if (std::ranges::count(bodies.mass, 0) > 0) bodies.mass.clear();
  // A file that says how long its needles are says their diameter, unless they have none.
  if (!has_dataset(source, "/parameters/diameter")) bodies.diameter.assign(bodies.length.size(), 0);
  return bodies;
}

bool has_own_bodies(const Source& source) {
  return has_dataset(source, find_particles(source) + "/length");
}

OwnBodies read_own_bodies(const Source& source, std::size_t needles) {
  OwnBodies out;
  if (!has_own_bodies(source)) return out;
  const auto read = [&](const char* name, bool may_be_infinite, bool may_be_zero) {
    const std::string path = find_particles(source) + "/" + name, place = source.place(path);
    if (!has_dataset(source, path)) return std::vector<double>{};
    std::vector<double> column = Element(source, path).read<double>({});
    if (column.size() != needles) {
      throw InputError(fmt::format("{}: {} numbers: expected {}, one for each needle", place,
                                   column.size(), needles));
    }
    for (std::size_t i = 0; i < needles; ++i) {
      const double value = column[i];
      if ((value > 0 || (may_be_zero && value == 0)) && (may_be_infinite || std::isfinite(value)))
        continue;
      throw InputError(fmt::format("{}[{}] = {}: expected a {}number {} 0", place, i, value,
                                   may_be_infinite ? "" : "finite ", may_be_zero ? ">=" : ">"));
    }
    return column;
  };
  out.length = read("length", false, true);
  out.diameter = read("diameter", false, true);
  out.mass = read("mass", true, false);
  out.inertia = read("inertia", true, true);
  return out;
}

void enlarge(State& state, double scale) {
  Bodies& bodies = state.bodies;
  OwnBodies& own = state.own_bodies;
  const auto fill = [&](std::vector<double>& rows, const std::vector<double>& of_species) {
    if (!rows.empty() || of_species.empty()) return;
    for (std::size_t i = 0; i < state.size(); ++i) {
      const std::size_t species = state.species.empty() ? 0 : state.species[i];
      rows.push_back(of_species[std::min(species, of_species.size() - 1)]);
    }
  };
  fill(own.length, bodies.length);
  fill(own.diameter, bodies.diameter);
  fill(own.mass, bodies.mass);
  fill(own.inertia, bodies.inertia);
  for (std::vector<double>* sizes : {&bodies.length, &bodies.diameter, &own.length, &own.diameter})
    for (double& size : *sizes) size *= scale;
  for (double& k : bodies.k) k *= scale * scale;
  state.scale = scale;
}

}  // namespace needlework::io
