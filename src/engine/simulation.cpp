#include "needlework/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "kernels/default_arithmetic.h"
#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "src/calendar/choice.h"
#include "src/engine/drawn_state.h"
#include "src/engine/effect_totals.h"
#include "src/engine/initial_gas.h"
#include "src/engine/make_loop.h"
#include "src/engine/present_state.h"
#include "src/engine/rods_apart.h"
#include "src/engine/subdomains.h"
#include "src/physics/permutation.h"
#include "src/physics/vectors.h"
#include "src/scene/accuracy.h"
#include "src/scene/check.h"
#include "src/scene/own_bodies.h"
#include "src/scene/validity.h"
#include "src/search/choice.h"
#include "src/search/lengths.h"
#include "src/search/sizing.h"

namespace needlework {
namespace {

kernels::Isa isa_of(const std::string& name) {
  const std::vector<kernels::Isa> offered = kernels::available();
  if (name == "auto") return offered.back();
  for (const kernels::Isa isa : offered) {
    if (kernels::name_of(isa) == name) return isa;
  }
  throw std::logic_error("engine.isa = \"" + name + "\": expected one of a valid scene");
}

// The parts of the loop that the scene asks for, for a gas of this density.
LoopChoice choice_of(const Scene& scene, const Run& run, double density) {
  const int threads = std::max(1, scene.engine.threads.value_or(1));
  Vector divided = run.gas.box.edges();
  if (run.gas.shear) divided[0] = 0;  // rows of cells stay whole
  return {.search = chosen_search(scene.engine.search, density, run.gas.composition,
                                  scene.shear.has_value()),
          .calendar = chosen_calendar(scene.engine.queue, threads),
          .threads = threads,
          .threads_place = place_of(scene, "engine.threads", fmt::to_string(threads)),
          .all_threads = scene.engine.team == "all",
          .setup = {.isa = isa_of(scene.engine.isa),
                    .density = density,
                    .cell_side = scene.engine.cell_side,
                    .capsule_radius = scene.engine.capsule_radius,
                    .by_class = scene.engine.search == "auto",
                    .float_filter = accuracy_of(scene.engine).float_filter,
                    .count_multiples =
                        multiples_to_divide(divided, static_cast<std::uint32_t>(threads))},
          .replaced = {}};
}

double square(const std::array<double, 3>& a) { return a[0] * a[0] + a[1] * a[1] + a[2] * a[2]; }

// Passes each row, whose square enters the energy, to add(row, values).
template <class Add>
void check_squares(std::span<const std::array<double, 3>> values, std::size_t count,
                   const char* what, const Add& add) {
  if (values.size() != count) {
    throw InputError(
        fmt::format("set_velocities: {} rows of {}: expected {}", values.size(), what, count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::array<double, 3>& a = values[i];
    if (!std::isfinite(square(a))) {
      throw InputError(fmt::format(
          "set_velocities: row {} of {} = ({}, {}, {}): expected finite numbers, their squares too",
          i, what, a[0], a[1], a[2]));
    }
    add(i, a);
  }
}

// That rows of fixed needles are 0.
void require_fixed_at_rest(const Gas& gas, const std::vector<Needle>& rows,
                           std::span<const std::array<double, 3>> values, const char* what) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::array<double, 3>& a = values[i];
    if (!gas.is_fixed(rows[i]) || a == std::array<double, 3>{}) continue;
    throw InputError(
        fmt::format("set_velocities: row {} of {} = ({}, {}, {}): expected 0, as its species is "
                    "fixed",
                    i, what, a[0], a[1], a[2]));
  }
}

}  // namespace

struct Simulation::Implementation {
  /// `start` is a gas or a checkpoint.
  template <class Start>
  Implementation(const Scene& its_scene, Start&& start)
      : scene(its_scene), run(scene, std::forward<Start>(start)), isa(isa_of(scene.engine.isa)) {
    if (has_sizes(scene.engine.search) && !scene.engine.cell_side && !scene.engine.capsule_radius) {
      sizing.emplace(run.gas, run.now);
    }
    if (run.gas.growth) {
      composition_at_start = scene.composition();
      if (!run.gas.composition.is_mixture()) composition_at_start->set_count(0, run.gas.size());
    }
    begin_loop();
#ifndef NDEBUG
    // A state that is given may overlap by what is taken for a touch.
    if (find_overlap(run.gas, run.now, isa, explained_overlap(run.gas, run.now)))
      overlap_at_start = run.gas.touch_tolerance();
#endif
  }

  void begin_loop() {
    LoopChoice choice =
        choice_of(scene, run, sizing ? sizing->density() : reduced_density(run.gas));
    choice.replaced = replaced;  // kept until there is a loop, as making one may throw
    loop = make_loop(run, std::move(choice));
    // They are needed until all needles have searched, and no checkpoint holds them.
    if (!replaced.empty()) loop->prepare(nullptr);
    replaced = {};
    search = loop->search_name();
    calendar = loop->calendar_name();
  }

  // Places in storage, ordered by id.
  std::vector<Needle> by_id() const {
    std::vector<Needle> out(run.gas.size());
    const auto& ids = run.gas.ids;
    // Ids are distinct, and nearly always 0 to N - 1. They need no sorting then, which would take
    // longer than to copy all needles.
    if (std::all_of(ids.begin(), ids.end(), [&](Id id) { return id.value < out.size(); })) {
      for (Needle i{0}; i < out.size(); ++i) out[ids[i].value] = i;
      return out;
    }
    for (Needle i{0}; i < out.size(); ++i) out[i] = i;
    std::sort(out.begin(), out.end(), [&](Needle a, Needle b) { return ids[a] < ids[b]; });
    return out;
  }

  // Velocities are given as they are copied, of the images in the box.
  struct FlowOfImage {
    Vec3d at_place;  ///< the flow where the image is [L / time]
    Vec3d beyond;    ///< how much faster the needle itself is than its image [L / time]
  };
  FlowOfImage flow_of_image(Needle i) const {
    if (!run.gas.shear) return {};
    const Box box = run.gas.box_at(run.now);
    const auto [place, boxes] = box.wrap(to_array(run.gas.present(i, run.now).r));
    return {run.gas.flow_at(vector_of(place)), box.image(boxes).velocity};
  }

  void set_velocities(std::span<const std::array<double, 3>> velocity,
                      std::span<const std::array<double, 3>> angular_velocity) {
    const std::vector<Needle> rows = by_id();
    std::vector<SumsOfSquares> sums(run.gas.composition.size());
    check_squares(velocity, rows.size(), "velocity", [&](std::size_t row, const auto& v) {
      const Needle i = rows[row];
      const Vec3d beside = vector_of(v) - flow_of_image(i).at_place;
      sums[run.gas.records[i].species].v2 += weight_of(run.gas, i).mass * dot(beside, beside);
    });
    check_squares(
        angular_velocity, rows.size(), "angular velocity", [&](std::size_t row, const auto& w) {
          const Needle i = rows[row];
          sums[run.gas.records[i].species].w2 += weight_of(run.gas, i).inertia * square(w);
        });
    if (run.gas.composition.has_fixed()) {
      require_fixed_at_rest(run.gas, rows, velocity, "velocity");
      require_fixed_at_rest(run.gas, rows, angular_velocity, "angular velocity");
    }
    const auto moves = [](const std::array<double, 3>& row) {
      return row != std::array<double, 3>{};
    };
    run.require_followable(
        sums, std::ranges::any_of(velocity, moves) || std::ranges::any_of(angular_velocity, moves));
    const std::vector<Needle> ranks = ranks_of(rows);
    require_steady_flow(scene, run.gas, "set_velocities",
                        [&](Needle i) { return velocity[ranks[i]][1]; });
    // On which sides needles are that touch now is known once all have searched.
    if (loop) loop->prepare(nullptr);
    replace([&] {
      return run.set_velocities(
          [&](Needle i) { return vector_of(velocity[ranks[i]]) + flow_of_image(i).beyond; },
          [&](Needle i) { return vector_of(angular_velocity[ranks[i]]); });
    });
  }

  // Replaces all records, by a function that returns the previous ones. All needles search again.
  template <class Replacement>
  void replace(const Replacement& replacement) {
    std::unique_ptr<Loop> kept = std::move(loop);  // of which an error leaves none
    replaced = replacement();
    if (!kept) return begin_loop();
    kept->begin_again(std::move(replaced));
    replaced = {};
    loop = std::move(kept);
    loop->prepare(nullptr);
    // Windows, at whose ends they go otherwise, may never end while records are replaced.
    run.gas.further_touches->keep_only(run.gas.records, run.gas.ids);
    if (run.gas.slides) run.gas.slides->keep_only(run.gas.records, run.gas.ids);
  }

  std::optional<Stop> prepare(const Scene::Until& until) {
    const auto stop = prepare(StopConditions(run, until));
    if (!stop) return std::nullopt;
    return run.interrupted.exchange(false) ? Stop::interrupted : stop;
  }

  Stop advance(const Scene::Until& until) {
    const Stop stop = advance(StopConditions(run, until));
#ifndef NDEBUG
    require_rods_apart(run.gas, run.now, isa,
                       std::max(overlap_at_start, explained_overlap(run.gas, run.now)));
#endif
    // An interruption must not be lost when it comes just as a condition is met.
    return run.interrupted.exchange(false) ? Stop::interrupted : stop;
  }

  // Whether it ends without an event, and why.
  std::optional<Stop> prepare(const StopConditions& limits) {
    // On which sides needles are that touch is to be known before time passes without events.
    if (limits.time != Time::never() && run.nothing_can_happen()) {
      if (!loop) begin_loop();
      if (const auto stop = loop->prepare(&limits)) return stop;
    }
    if (const auto stop = limits.reached_without_events(run)) return stop;
    if (const auto stop = limits.reached(run)) return stop;
    if (!loop) begin_loop();
    return loop->prepare(&limits);
  }

  void pass_instant() {
    if (run.growing) run.measure_growth();
    if (!run.replaces_velocities()) return;
    loop->keep_in_order();
    replace([&] { return run.kicks ? run.kick() : run.cool(); });
    if (run.listeners.kick) run.listeners.kick();
  }

  Stop advance(StopConditions limits) {
    if (const auto stop = prepare(limits)) return *stop;
    for (;;) {
      if (sizing) limits.pause = sizing->next();
      // What happens at the instant of a kick happens before it.
      const Time instant = run.next_instant();
      StopConditions before = limits;
      before.time = std::min(limits.time, instant);
      before.why = Stop::time;
      before.collisions = std::min(limits.collisions, run.next_look_for_jam());
      const auto stop = loop->advance(before);
      if (stop == Stop::collisions && before.collisions < limits.collisions) {
        if (run.is_jammed()) return Stop::jammed;
        continue;
      }
      if (stop == Stop::time && instant <= limits.time) {
        pass_instant();
        if (const auto reached = limits.reached(run)) return *reached;
        if (const auto called_off = limits.called_off(run)) return *called_off;
        continue;
      }
      if (stop == Stop::time) return limits.why;
      if (stop) return *stop;
      if (!sizing->look(run.tally.collisions, run.gas, run.now)) continue;
      loop.reset();  // frees its memory before the next loop allocates
      ++run.tally.counters.resized;
      begin_loop();
    }
  }

  const Composition& composition() const {
    return composition_at_start ? *composition_at_start : run.gas.composition;
  }
  PresentSizes sizes() const { return {composition(), present_scale(run, scene, composition())}; }

  const Scene scene;
  Run run;
  std::optional<Sizing> sizing;  ///< empty if the scene sets the size of cells or capsules
  std::unique_ptr<Loop> loop;
  ReplacedRecords replaced;  ///< by a caller at the present time, not known to a loop yet
  std::string search, calendar;
  kernels::Isa isa;
#ifndef NDEBUG
  double overlap_at_start = 0;  ///< that rounding does not explain [L]
#endif
  std::optional<Composition> composition_at_start;  ///< where bodies grow
  std::string placement;                            ///< how rods of a drawn state have found room
};

namespace {

// A scene with a state from which it starts, and the bodies of the two.
class SceneWithState {
 public:
  SceneWithState(const Scene& scene, const State& state) : scene_(scene), state_(state) {
    adopt_spheres(scene_, state);
    if (lacks_numbers(scene_, state)) {
      completed_ = state;
      completed_->own_bodies = all_numbers_of(scene_, state);
    }
    adopt_own_bodies(scene_, this->state());
    require_rules(scene_, Aspect::sizes);
  }

  const Scene& scene() const { return scene_; }
  const State& state() const { return completed_ ? *completed_ : state_; }

 private:
  Scene scene_;
  const State& state_;
  std::optional<State> completed_;
};

}  // namespace

void require_simulable(const Scene& scene, const State& initial) {
  const kernels::DefaultArithmetic arithmetic;
  require_valid(scene, simulable);
  const SceneWithState both(scene, initial);
  const Run run(both.scene(), make_gas(both.scene(), both.state()));
}

// The way to whatever computes: while it lasts, in the arithmetic that bits rely on, whatever the
// host program has chosen.
class Simulation::Access {
 public:
  explicit Access(Implementation& implementation) : implementation_(implementation) {}
  Implementation* operator->() const { return &implementation_; }

 private:
  kernels::DefaultArithmetic arithmetic_;
  Implementation& implementation_;
};

Simulation::Access Simulation::access() const { return Access(*implementation_); }

Simulation::Simulation(const Scene& scene) {
  if (!scene.initial.file.empty()) {
    throw InputError(place_of(scene, "initial.file", scene.initial.file) +
                     ": expected none, as Simulation(scene) reads no files: read the state with "
                     "io::read_last_frame() and pass it to Simulation(scene, state)");
  }
  const kernels::DefaultArithmetic arithmetic;
  require_valid(scene, simulable | Aspect::sizes);
  // The state's arrays are freed before the rest of the run allocates its memory.
  DrawnState drawn = draw_state(scene);
  Gas gas = make_gas(scene, drawn.state);
  drawn.state = {};
  implementation_ = std::make_unique<Implementation>(scene, std::move(gas));
  implementation_->placement = std::move(drawn.placement);
}

Simulation::Simulation(const Scene& scene, const State& initial) {
  const kernels::DefaultArithmetic arithmetic;
  require_valid(scene, simulable);
  const SceneWithState both(scene, initial);
  implementation_ =
      std::make_unique<Implementation>(both.scene(), make_gas(both.scene(), both.state()));
}

Simulation::Simulation(const Scene& scene, const Checkpoint& checkpoint) {
  const kernels::DefaultArithmetic arithmetic;
  require_valid(scene, simulable);
  implementation_ = std::make_unique<Implementation>(scene, checkpoint);
}

Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

std::optional<Stop> Simulation::prepare(const Scene::Until& until) {
  return access()->prepare(until);
}

Stop Simulation::advance(const Scene::Until& until) { return access()->advance(until); }

std::string Simulation::why_no_collision() const {
  const Run& run = implementation_->run;
  if (const auto reason = run.collisionless()) return words_for(*reason);
  if (!run.is_quiet()) return {};
  return "none has come for so long that none is expected";
}

void Simulation::on_collision(std::function<void(const Collision&)> callback) {
  implementation_->run.listeners.collision = std::move(callback);
}

void Simulation::on_collision_times(std::function<void(std::span<const double>)> callback) {
  implementation_->run.listeners.times = std::move(callback);
}

void Simulation::on_kick(std::function<void()> callback) {
  implementation_->run.listeners.kick = std::move(callback);
}

void Simulation::on_happening(std::function<void(const Happening&)> callback) {
  implementation_->run.listeners.happening = std::move(callback);
}

std::vector<std::string> Simulation::sources() const {
  std::vector<std::string> out;
  for (const auto& source : implementation_->run.sources) out.push_back(source->name());
  return out;
}

std::vector<std::uint64_t> Simulation::events_by_source() const {
  const Run& run = implementation_->run;
  std::vector<std::uint64_t> out;
  for (const SourceTally& source : run.tally.by_source) out.push_back(source.events);
  out.resize(run.sources.size());
  return out;
}

std::vector<std::vector<ObjectTotals>> Simulation::objects_by_source() const {
  return needlework::objects_by_source(implementation_->run);
}

const std::string& Simulation::placement() const { return implementation_->placement; }

double Simulation::virial() const {
  const Access self = access();
  return self->run.virial();
}

double Simulation::t_tr_integral() const {
  const Access self = access();
  return self->run.temperature_integral_now();
}

std::array<double, 3> Simulation::box() const {
  const Access self = access();
  return self->run.gas.edges_at(self->run.now);
}

std::array<double, 3> Simulation::low() const {
  const Access self = access();
  return self->run.gas.low_at(self->run.now);
}

std::vector<WallTotals> Simulation::wall_totals() const {
  const Access self = access();
  return needlework::wall_totals(self->run, self->scene);
}

std::optional<SlidingContacts> Simulation::sliding_contacts() const {
  const Access self = access();
  return needlework::sliding_contacts(self->run);
}

std::optional<StressTotals> Simulation::stress() const {
  const Access self = access();
  return self->run.effects.stress ? std::optional(self->run.stress()) : std::nullopt;
}

std::optional<StressSums> Simulation::stress_sums() const {
  const Access self = access();
  return self->run.effects.stress ? std::optional(self->run.stress_sums()) : std::nullopt;
}

EnergyBudget Simulation::energy_budget() const { return access()->run.energy_budget(); }

void Simulation::interrupt() noexcept { implementation_->run.interrupted = true; }
Totals Simulation::totals() const { return access()->run.totals(); }
std::vector<SpeciesTotals> Simulation::species_totals() const {
  const Access self = access();
  const Run& run = self->run;
  return needlework::species_totals(run.gas, sums_of_squares(run.gas, run.now, run.team.threads()));
}
std::vector<std::uint8_t> Simulation::species() const {
  const Gas& gas = implementation_->run.gas;
  std::vector<std::uint8_t> out;
  if (!gas.composition.is_mixture()) return out;
  for (const Needle i : implementation_->by_id()) out.push_back(gas.records[i].species);
  return out;
}
OwnBodies Simulation::own_bodies() const {
  OwnBodies out;
  const Access self = access();
  const Gas& gas = self->run.gas;
  copy_own_bodies(gas, self->sizes(), self->by_id(), out);
  return out;
}
OwnBodies Simulation::own_bodies_at_start() const {
  OwnBodies out;
  const Access self = access();
  const Gas& gas = self->run.gas;
  if (gas.has_own_bodies()) copy_own_bodies(gas, {composition(), 1}, self->by_id(), out);
  return out;
}
const Composition& Simulation::composition() const { return implementation_->composition(); }
std::optional<GrowthTotals> Simulation::growth() const {
  const Access self = access();
  return growth_totals(self->run, self->scene, composition());
}
std::vector<std::uint64_t> Simulation::collisions_by_pair() const {
  return needlework::collisions_by_pair(implementation_->run);
}
const Counters& Simulation::counters() const { return implementation_->run.tally.counters; }
double Simulation::time() const {
  return access()->run.gas.clock.since_start(implementation_->run.now);
}
std::size_t Simulation::needles() const { return implementation_->run.gas.size(); }
std::uint64_t Simulation::collisions() const { return implementation_->run.tally.collisions; }
double Simulation::initial_energy() const {
  const Access self = access();
  const Run& run = self->run;
  return (run.initial_energy - energy_of_low_edges(run.gas)) /
         static_cast<double>(std::max<std::size_t>(run.gas.moving(), 1));
}
double Simulation::energy_drift() const { return access()->run.energy_drift(); }
double Simulation::epoch_length() const { return implementation_->run.gas.clock.epoch_length(); }
double Simulation::mean_free_time() const { return implementation_->run.windows.mean_free_time(); }
std::string Simulation::trajectory_hash() const { return implementation_->run.tally.hash.hex(); }
void Simulation::copy(State& into) const {
  const Access self = access();
  const Run& run = self->run;
  const PresentSizes sizes = self->sizes();
  copy_state(run.gas, run.now, implementation_->isa, implementation_->by_id(), into);
  copy_own_bodies(run.gas, sizes, implementation_->by_id(), into.own_bodies);
  into.scale.reset();
  if (run.gas.growth) into.scale = sizes.scale;
}
State Simulation::copy() const {
  State out;
  copy(out);
  return out;
}
FreeNeedle Simulation::needle(std::uint32_t id) const {
  const Access self = access();
  return needle_at(self->run.gas, self->sizes(), self->run.now, {id});
}
void Simulation::set_velocities(std::span<const std::array<double, 3>> velocity,
                                std::span<const std::array<double, 3>> angular_velocity) {
  access()->set_velocities(velocity, angular_velocity);
}
Checkpoint Simulation::checkpoint() const {
  const Access self = access();
  return self->run.save(self->scene, self->by_id());
}
std::string Simulation::search() const { return implementation_->search; }
std::string Simulation::queue() const { return implementation_->calendar; }
std::string Simulation::isa() const { return std::string(kernels::name_of(implementation_->isa)); }
std::string Simulation::effects() const { return name_effects(implementation_->run); }

}  // namespace needlework
