#include "needlework/simulation.h"

#include <optional>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "src/calendar/all.h"
#include "src/calendar/choice.h"
#include "src/engine/make_loop_with.h"
#include "src/engine/zones.h"
#include "src/scene/accuracy.h"
#include "src/scene/check.h"
#include "src/search/choice.h"
#include "src/search/sizing.h"

namespace needlework {
namespace {

kernels::Isa isa_of(const std::string& name) {
  const std::vector<kernels::Isa> offered = kernels::available();
  if (name == "auto") return offered.back();
  for (const kernels::Isa isa : offered) {
    if (kernels::name_of(isa) == name) return isa;
  }
  throw InputError("engine.isa = \"" + name + "\": expected one that this processor has");
}

// Makes the loop with that of the calendars whose name it is.
template <class... Queues>
std::unique_ptr<Loop> with_queue(CalendarList<Queues...>, const std::string& queue,
                                 const Scene& scene, Run& run, const std::string& search,
                                 const SearchSetup& setup) {
  std::unique_ptr<Loop> loop;
  const bool found = ((queue == Queues::name &&
                       (loop = make_loop_with<Queues>(scene, run, search, setup), true)) ||
                      ...);
  if (found) return loop;
  std::string names = "auto";
  ((names += std::string(", ") + Queues::name), ...);
  throw InputError("engine.queue = \"" + queue + "\": expected one of " + names);
}

// The event loop that the scene asks for, for a gas of this density.
std::unique_ptr<Loop> make_loop(const Scene& scene, Run& run, double density) {
  const int threads = std::max(1, scene.engine.threads.value_or(1));
  const SearchSetup setup{isa_of(scene.engine.isa),
                          density,
                          scene.engine.cell_side,
                          scene.engine.capsule_radius,
                          accuracy_of(scene.engine).float_filter,
                          multiples_to_divide(run.gas.box, static_cast<std::uint32_t>(threads))};
  const std::string search = chosen_search(scene.engine.search, density);
  const std::string queue = chosen_calendar(scene.engine.queue, threads);
  return with_queue(AllCalendars<CalendarList>(), queue, scene, run, search, setup);
}

State initial_state(const Scene& scene) {
  if (scene.initial.file.empty()) return draw_initial_state(scene);
  throw InputError(place_of(scene, "initial.file", scene.initial.file) +
                   ": expected none, as Simulation(scene) reads no files: read the state with "
                   "io::read_last_frame() and pass it to Simulation(scene, state)");
}

std::string name_effects(const Scene::Collisions& collisions) {
  std::string out = collisions.epsilon < 1 ? "inelastic" : "elastic";
  if (collisions.beta != -1) out += " rough";
  if (collisions.tc || collisions.tc_relative) out += " tc";
  return out;
}

}  // namespace

struct Simulation::Implementation {
  Implementation(const Scene& its_scene, Gas initial)
      : scene(its_scene), run(scene, std::move(initial)), isa(isa_of(scene.engine.isa)) {
    if (has_sizes(scene.engine.search) && !scene.engine.cell_side && !scene.engine.capsule_radius) {
      sizing.emplace(run.gas, run.now);
    }
    begin_loop();
  }

  void begin_loop() {
    loop = make_loop(scene, run, sizing ? sizing->density() : run.gas.density());
    search = loop->search_name();
    queue = loop->queue_name();
  }

  Stop advance(const Scene::Until& until) {
    run.interrupted = false;
    Limits limits(run, until);
    if (const auto stop = limits.reached_without_events(run)) return *stop;
    for (;;) {
      if (!loop) begin_loop();
      if (sizing) limits.pause = sizing->next();
      if (const auto stop = loop->advance(limits)) return *stop;
      if (!sizing->look(run.tally.collisions, run.gas, run.now)) continue;
      loop.reset();  // before the next one takes its memory
      ++run.tally.counters.resized;
    }
  }

  const Scene scene;
  Run run;
  std::optional<Sizing> sizing;  ///< unless the scene says how large cells or capsules are
  std::unique_ptr<Loop> loop;
  std::string search, queue;
  kernels::Isa isa;
};

Simulation::Simulation(const Scene& scene) {
  // The state's arrays go before the rest of the run takes its memory.
  Gas gas = make_gas(scene, initial_state(scene));
  implementation_ = std::make_unique<Implementation>(scene, std::move(gas));
}

Simulation::Simulation(const Scene& scene, const State& initial)
    : implementation_(std::make_unique<Implementation>(scene, make_gas(scene, initial))) {}

Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Stop Simulation::advance(const Scene::Until& until) { return implementation_->advance(until); }

void Simulation::on_collision(std::function<void(const Collision&)> callback) {
  implementation_->run.callback = std::move(callback);
}

void Simulation::interrupt() noexcept { implementation_->run.interrupted = true; }
Totals Simulation::totals() const { return implementation_->run.totals(); }
const Counters& Simulation::counters() const { return implementation_->run.tally.counters; }
double Simulation::time() const {
  return implementation_->run.gas.clock.since_start(implementation_->run.now);
}
double Simulation::epoch_length() const { return implementation_->run.gas.clock.epoch_length(); }
double Simulation::mean_free_time() const { return implementation_->run.mean_free_time; }
std::string Simulation::trajectory_hash() const { return implementation_->run.tally.hash.hex(); }
State Simulation::state() const { return implementation_->run.state(implementation_->isa); }
std::string Simulation::search() const { return implementation_->search; }
std::string Simulation::queue() const { return implementation_->queue; }
std::string Simulation::isa() const { return std::string(kernels::name_of(implementation_->isa)); }
std::string Simulation::effects() const { return name_effects(implementation_->scene.collisions); }

}  // namespace needlework
