// A program as someone else would write it: a scene in code, a callback, a look at the result.
#include <needlework/error.h>
#include <needlework/predict.h>
#include <needlework/scene.h>
#include <needlework/simulation.h>

#include <cmath>
#include <cstdint>
#include <cstdio>

int main() {
  needlework::Scene scene;
  scene.needles.count = 50;
  scene.needles.box = {5, 5, 5};
  scene.needles.seed = 7;
  scene.collisions.epsilon = 0.9;
  scene.collisions.tc_relative = 1e-3;

  needlework::Simulation simulation(scene);
  std::uint64_t seen = 0;
  double lost = 0;
  simulation.on_collision([&](const needlework::Collision& collision) {
    ++seen;
    lost -= collision.energy_change;
  });
  needlework::Scene::Until until;
  until.collisions_per_needle = 2;
  const needlework::Stop stop = simulation.advance(until);

  const needlework::Totals totals = simulation.totals();
  const double expected = 50 * 2.5 - lost;
  std::printf("%llu collisions, energy %.15g, expected %.15g\n",
              static_cast<unsigned long long>(seen), 50 * totals.energy, expected);
  const needlework::FreeNeedle first{{.25, -.125, -.5}, {1, 0, 0}, {0, 0, .75}, {0, 0, 0}};
  const needlework::FreeNeedle second{{0, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 0}};
  const double time =
      needlework::predict(first, second, 2, false, needlework::rigorous_accuracy).time;

  const bool right = std::abs(time - 2. / 3) < 1e-15 && stop == needlework::Stop::collisions &&
                     seen == 50 && totals.collisions == 50 && lost > 0 &&
                     std::abs(50 * totals.energy - expected) < 1e-10 &&
                     simulation.copy().size() == 50;
  return right ? 0 : 1;
}
