#include "src/scene/bodies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "needlework/error.h"
#include "src/scene/check.h"
#include "src/scene/confinement.h"
#include "src/scene/printable.h"
#include "src/scene/schema.h"

namespace needlework {
namespace {

constexpr double least_k = 1e-9, most_k = 1e9;

[[noreturn]] void refuse(const Scene& scene, const std::string& key, double value,
                         const std::string& expected) {
  throw InputError(
      fmt::format("{}: expected {}", place_of(scene, key, fmt::to_string(value)), expected));
}

void require_shape(const Scene& scene, const Species& species, std::size_t n) {
  if (species.extent() <= 0) {
    refuse(scene, key_of_species("length", n), species.length,
           "a length above 0, or a diameter, which makes it a sphere");
  }
  if (!species.given_inertia) return;
  const std::string key = key_of_species("inertia", n);
  if (scene.places.contains(key_of_species("k", n))) {
    refuse(scene, key, *species.given_inertia, "either k or inertia, not both");
  }
  const double k = species.mass * (species.length * species.length) / (2 * *species.given_inertia);
  if (species.turns() && !(k >= least_k && k <= most_k)) {
    refuse(scene, key, *species.given_inertia,
           fmt::format("one with which k = m L^2 / (2 I) is from {:g} to {:g}", least_k, most_k));
  }
}

// Two needles meet where they cross, and two rods where their axes are some distance apart; there
// is no such distance between needles, which pass through each other's place after a contact.
void require_one_kind(const Scene& scene) {
  const auto is_rod = [](const Species& each) { return each.diameter > 0; };
  const auto first = std::ranges::find_if_not(scene.species, is_rod);
  if (first == scene.species.end() || std::ranges::none_of(scene.species, is_rod)) return;
  const auto n = static_cast<std::size_t>(first - scene.species.begin());
  refuse(scene, key_of_species("diameter", n), first->diameter,
         "one above 0, as other species have one: thin needles cross each other, rods of finite "
         "width never do, and there is no contact between the two kinds");
}

void require_smooth(const Scene& scene) {
  if (!scene.composition().has_width()) return;
  constexpr const char* reason =
      "-1 for rods of finite width: what turns them about their axes is not simulated";
  if (scene.collisions.beta != -1) {
    refuse(scene, "collisions.beta", scene.collisions.beta, reason);
  }
  for (std::size_t n = 0; n < scene.pairs.size(); ++n) {
    const double beta = scene.pairs[n].beta.value_or(-1);
    const std::string key = n == 0 ? "pairs.beta" : fmt::format("pairs.beta#{}", n);
    if (beta != -1) refuse(scene, key, beta, reason);
  }
}

}  // namespace

std::string key_of_species(std::string_view key, std::size_t entry) {
  return entry == 0 ? fmt::format("species.{}", key) : fmt::format("species.{}#{}", key, entry);
}

void require_possible_bodies(const Scene& scene) {
  for (std::size_t n = 0; n < scene.species.size(); ++n) require_shape(scene, scene.species[n], n);
  require_one_kind(scene);
  require_smooth(scene);
}

void require_room_in_box(const Scene& scene) {
  const Composition composition = scene.composition();
  const std::array<double, 3>& box = scene.needles.box;
  const Room room(scene);
  if (room.holds(box)) return;
  const std::string_view of = composition.is_mixture() ? ", of the longest species" : "";
  const bool is_plain =
      composition.longest() == 1 && scene.walls.empty() && !scene.collisions.sliding;
  throw InputError(fmt::format(
      "{}: expected {}", place_of(scene, "needles.box", fmt::format("[{}]", fmt::join(box, ", "))),
      is_plain ? std::string(find_scene_key("needles", "box")->expected)
               : fmt::format("{}{}", room.expected_instead_of(box), of)));
}

void require_pairs_of_species(const Scene& scene) {
  std::vector<std::string> names;
  for (const Species& each : scene.species) names.push_back(each.name);
  for (std::size_t n = 0; n < scene.pairs.size(); ++n) {
    for (const std::string& name : scene.pairs[n].between) {
      if (std::ranges::find(names, name) != names.end()) continue;
      const std::string key = n == 0 ? "pairs.between" : fmt::format("pairs.between#{}", n);
      throw InputError(fmt::format(
          "{}: expected names of two [[species]]{}{}",
          place_of(scene, key,
                   printable(fmt::format("{}", fmt::join(scene.pairs[n].between, "-")))),
          names.empty() ? "" : ", among ",
          printable(fmt::format("{}", fmt::join(names, ", ")), 200)));
    }
  }
}

}  // namespace needlework
