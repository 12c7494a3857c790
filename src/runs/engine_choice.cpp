#include "src/runs/engine_choice.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "needlework/error.h"
#include "needlework/simulation.h"
#include "src/machine/available_cores.h"
#include "src/runs/exact_rates.h"
#include "src/scene/check.h"
#include "src/scene/validity.h"

namespace needlework::runs {
namespace {

std::string wish_for_threads() {
  const char* text = std::getenv("OMP_NUM_THREADS");
  return text ? text : "";
}

// The first number of OMP_NUM_THREADS, which may be a list, or 1.
int threads_of_environment() {
  const std::string wish = wish_for_threads();
  const char* const text = wish.c_str();
  char* end = nullptr;
  const long threads = std::strtol(text, &end, 10);
  if (end == text || (*end != '\0' && *end != ',' && *end != ' ')) return 1;
  return static_cast<int>(std::clamp(threads, 1L, 1024L));
}

// A thread with fewer needles than these meets the others so often that little is gained; see
// docs/performance.md.
constexpr std::size_t least_needles_of_a_thread = 4000;

}  // namespace

int threads_by_size(std::size_t needles) {
  const std::size_t shares = std::max<std::size_t>(1, needles / least_needles_of_a_thread);
  const int most = std::min(cores(), omp_get_max_threads());
  return static_cast<int>(std::min<std::size_t>(shares, std::max(1, most)));
}

void choose_engine(Scene& scene) {
  Scene::Engine& engine = scene.engine;
  const char* isa_of_environment = std::getenv("NEEDLEWORK_ISA");
  if (engine.isa == "auto" && isa_of_environment && *isa_of_environment) {
    engine.isa = isa_of_environment;
    scene.places["engine.isa"] = "NEEDLEWORK_ISA=" + engine.isa;
  }
  require_rules(scene, Aspect::machine);
  const bool parallel = is_for_threads(engine);
  const std::string threads_place =
      place_of(scene, "engine.threads", fmt::to_string(engine.threads.value_or(1)));
  const int most = omp_get_thread_limit();
  if (engine.threads && *engine.threads > most) {
    throw InputError(fmt::format(
        "{}: expected at most {}, which is all that OMP_THREAD_LIMIT leaves", threads_place, most));
  }
  if (engine.threads_by_size) {
    engine.threads = parallel ? threads_by_size(scene.needles.count) : 1;
  }
  // OMP_NUM_THREADS is an offer, not a demand: what cannot use it runs on one thread.
  if (!engine.threads) {
    engine.threads = parallel ? std::min(threads_of_environment(), most) : 1;
    if (*engine.threads > 1)
      scene.places["engine.threads"] = "OMP_NUM_THREADS=" + wish_for_threads();
  }
}

std::string threads_text(const Scene& scene) {
  const int threads = scene.engine.threads.value_or(1);
  if (!scene.engine.threads_by_size) return fmt::to_string(threads);
  const int here = cores();
  return fmt::format("{}, for {} needles on {} core{}", threads, scene.needles.count, here,
                     here == 1 ? "" : "s");
}

int cores() { return available_cores().usable(); }

int threads_on_offer() { return std::getenv("OMP_NUM_THREADS") ? omp_get_max_threads() : cores(); }

std::vector<std::string> all_warnings(const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  std::vector<std::string> all = warnings(scene);
  if (const Scene::Collisions& c = scene.collisions; c.tc && scene.composition().is_inelastic()) {
    const double rate = initial_collision_rate(loaded);
    if (*c.tc * rate >= long_contact) {
      all.push_back(fmt::format("{}: is {:.3g} mean free times at the start: {}",
                                place_of(scene, "collisions.tc", fmt::to_string(*c.tc)),
                                *c.tc * rate, effect_of_long_contact));
    }
  }
  if (const std::string of_state = warning_of_state(loaded); !of_state.empty())
    all.push_back(of_state);
  const std::string why = loaded.initial ? why_no_collision(scene, *loaded.initial) : "";
  // A gas at rest may be meant, to be set in motion.
  if (!why.empty() && totals_of(*loaded.initial, scene).energy > 0) {
    const std::string& file = scene.initial.file;
    all.push_back(fmt::format("{}: {}: nothing collides",
                              file.empty() ? "state" : place_of(scene, "initial.file", file), why));
  }
  const int threads = scene.engine.threads.value_or(1);
  if (threads > cores()) {
    all.push_back(
        fmt::format("{}: expected at most {}, the number of cores here: threads beyond these {}",
                    place_of(scene, "engine.threads", fmt::to_string(threads)), cores(),
                    scene.engine.team == "all" ? "make a run slower" : "are not used"));
  }
  return all;
}

std::string resolved_isa(const Scene::Engine& engine) {
  return engine.isa == "auto" ? instruction_sets().back() : engine.isa;
}

}  // namespace needlework::runs
