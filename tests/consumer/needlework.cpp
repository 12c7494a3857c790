// A program as someone else would write it: a run that continues from a file.
#include <needlework/error.h>
#include <needlework/h5md.h>
#include <needlework/scene.h>
#include <needlework/simulation.h>

#include <cstdio>

int main() {
  needlework::Scene scene;
  scene.needles.count = 50;
  scene.needles.box = {5, 5, 5};
  needlework::Scene::Until until;
  until.collisions_per_needle = 2;

  needlework::Simulation first(scene);
  first.advance(until);
  needlework::io::Writer writer("state.h5", true, scene, {});
  writer.write_frame(first.totals(), first.copy());
  writer.close();

  const needlework::State state = needlework::io::read_last_frame("state.h5");
  needlework::Simulation second(scene, state);
  const needlework::Stop stop = second.advance(until);

  scene.initial.file = "state.h5";
  bool refused = false;
  try {
    needlework::Simulation third(scene);
  } catch (const needlework::InputError& error) {
    refused = true;
    std::puts(error.what());
  }
  const bool right = state.size() == 50 && stop == needlework::Stop::collisions && refused;
  return right ? 0 : 1;
}
