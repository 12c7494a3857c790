#include "src/scene/saved_scene.h"

#include <string_view>

#include "src/scene/own_bodies.h"
#include "src/scene/scene_members.h"

namespace needlework {

void transfer(Archive& archive, Spread& spread) {
  archive(spread.mean, spread.width, spread.least, spread.greatest);
}

void transfer(Archive& archive, Sizes& sizes) {
  archive(sizes.product, sizes.square, sizes.cube, sizes.volume, sizes.least_extent,
          sizes.greatest_extent, sizes.length, sizes.diameter, sizes.mass, sizes.inertia, sizes.k);
}

void transfer(Archive& archive, Distribution& distribution) {
  auto shape = static_cast<std::uint8_t>(distribution.shape);
  archive(shape);
  archive.require(shape < Distribution::shape_names.size());
  distribution.shape = static_cast<Distribution::Shape>(shape);
  archive(distribution.mean, distribution.width, distribution.least, distribution.greatest,
          distribution.exponent);
}

void transfer(Archive& archive, DrawnSizes& drawn) {
  for (const DrawnQuantity& each : drawn_quantities) archive(drawn.*each.member);
  archive(drawn.density, drawn.aspect, drawn.homogeneous);
}

void transfer(Archive& archive, Scene::Species& species) {
  visit_species(species,
                [&](std::string_view, std::string_view, auto& member) { archive(member); });
  archive(species.sizes);
  // By which spheres are rough, and which no key says.
  if (archive.reads() && species.sizes && !species.has_axis() && !species.fixed)
    species.set_inertia(species.sizes->inertia.mean);
}

void transfer(Archive& archive, Scene::Pair& pair) {
  visit_pair(pair, [&](std::string_view, std::string_view, auto& member) { archive(member); });
}

void transfer(Archive& archive, Scene::WallMotion& motion) {
  visit_motion(motion, [&](std::string_view, std::string_view, auto& member) { archive(member); });
}

void transfer(Archive& archive, Scene::Wall& wall) {
  visit_wall(wall, [&](std::string_view, std::string_view, auto& member) { archive(member); });
}

void transfer(Archive& archive, Scene::Shear& shear) {
  visit_shear(shear, [&](std::string_view, std::string_view, auto& member) { archive(member); });
}

void transfer(Archive& archive, Scene::Kicks& kicks) {
  visit_kicks(kicks, [&](std::string_view, std::string_view, auto& member) { archive(member); });
}

void transfer(Archive& archive, Scene::Andersen& andersen) {
  visit_andersen(andersen,
                 [&](std::string_view, std::string_view, auto& member) { archive(member); });
}

void transfer(Archive& archive, Scene::Growth& growth) {
  visit_growth(growth, [&](std::string_view, std::string_view, auto& member) { archive(member); });
}

void transfer(Archive& archive, Scene& scene) {
  visit_members(scene, [&](std::string_view, std::string_view, auto& member) { archive(member); });
  archive(scene.text, scene.places);
}

}  // namespace needlework
