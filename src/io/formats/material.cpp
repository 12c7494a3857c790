#include "src/io/formats/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "src/io/in_child_process.h"
#include "src/io/source.h"

namespace needlework::io {
namespace {

std::optional<double> read_number(const Source& source, const std::string& path) {
  const std::string place = source.place(path);
  if (!hdf5::exists(source.get(), path, place)) return {};
  const std::vector<double> values = Element(source, path).read<double>({});
  if (values.empty()) return {};
  const auto other = std::find_if(values.begin(), values.end(),
                                  [&](double value) { return value != values.front(); });
  if (other != values.end()) {
    throw InputError(
        fmt::format("{}[{}] = {}: expected {}, the value of the first: all needles are "
                    "equal",
                    place, other - values.begin(), *other, values.front()));
  }
  return values.front();
}

std::optional<double> read_positive(const Source& source, const std::string& path) {
  const std::optional<double> value = read_number(source, path);
  if (value && !(*value > 0 && std::isfinite(*value))) {
    throw InputError(fmt::format("{} = {}: expected a number > 0", source.place(path), *value));
  }
  return value;
}

}  // namespace

static void transfer(Archive& archive, Material& material) {
  auto& [name, length, mass, k, epsilon, beta] = material;
  archive(name, length, mass, k, epsilon, beta);
}

static Material read_material_here(const std::string& path) {
  const Source source(path);
  Material material;
  material.length = read_positive(source, "/parameters/length");
  // Without needles, the group of them does not hold their mass.
  material.mass = read_positive(source, "/parameters/mass");
  if (!material.mass) material.mass = read_positive(source, find_particles(source) + "/mass");
  material.k = read_positive(source, "/parameters/k");
  material.epsilon = read_number(source, "/parameters/epsilon");
  material.beta = read_number(source, "/parameters/beta");
  return material;
}

Material read_material(const std::string& path) {
  return read_in_child_process(path, [&] { return read_material_here(path); });
}

void require_complete(const Material& material, const std::string& path) {
  for (const auto& [name, value] :
       {std::pair("length", material.length), std::pair("mass", material.mass),
        std::pair("k", material.k), std::pair("epsilon", material.epsilon)}) {
    if (value) continue;
    throw InputError(
        fmt::format("{}: {} of the needles is missing: expected a file that needlework has written",
                    path, name));
  }
}

}  // namespace needlework::io
