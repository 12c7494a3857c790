// A program as someone else would write it: a run by the text of a scene.
#include <needlework/error.h>
#include <needlework/parse.h>
#include <needlework/simulation.h>

#include <cstdio>

int main() {
  const needlework::Scene scene = needlework::parse_scene(
      "[needles]\ncount = 50\nbox = 5.0\n[until]\ncollisions_per_needle = 2\n", "fifty");
  needlework::Simulation simulation(scene);
  const needlework::Stop stop = simulation.advance(scene.until);
  bool refused = false;
  try {
    needlework::parse_scene("[needles]\ncount = -1\n", "negative");
  } catch (const needlework::InputError& error) {
    refused = true;
    std::puts(error.what());
  }
  return refused && stop == needlework::Stop::collisions ? 0 : 1;
}
