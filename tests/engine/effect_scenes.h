// Small scenes of each effect, and of many at once.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "needlework/scene.h"
#include "needlework/totals.h"

namespace needlework::test {

struct EffectScene {
  std::string name;
  Scene scene;
  Scene::Until end;  ///< after which the effect has happened often

  Scene::Until share_of_end(double share) const {
    Scene::Until out = end;
    if (out.time) *out.time *= share;
    if (out.collisions_per_needle) *out.collisions_per_needle *= share;
    return out;
  }
};

inline void PrintTo(const EffectScene& each, std::ostream* out) { *out << each.name; }

std::vector<EffectScene> effect_scenes();
/// One of them.
Scene effect_scene(const std::string& name);

/// All shares of a budget, of each wall too.
std::vector<double> numbers_of(const EnergyBudget& budget);

}  // namespace needlework::test
