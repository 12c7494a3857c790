#include "src/python/run.h"

#include <pybind11/stl.h>

#include <exception>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "needlework/counters.h"
#include "needlework/error.h"
#include "src/composition/pair_name.h"
#include "src/machine/stop_request.h"
#include "src/python/arrays.h"
#include "src/python/collision_rows.h"
#include "src/python/errors.h"
#include "src/python/interpreter.h"
#include "src/python/monitor.h"
#include "src/python/scene_source.h"
#include "src/runs/engine_choice.h"
#include "src/runs/load_checkpoint.h"
#include "src/runs/output_path.h"
#include "src/runs/rod_totals.h"
#include "src/runs/state_file.h"
#include "src/scene/adopt_state.h"

namespace needlework::python {

namespace py = pybind11;

namespace {

/// A Python object that may be forgotten by a thread without the GIL.
std::shared_ptr<py::object> shared(const py::object& object) {
  return {new py::object(object), [](py::object* pointer) {
            if (has_ended_here()) return;  // it is Python's no more
            const LockTaken lock;
            delete pointer;
          }};
}

/// What hands reports to a function of Python as rows of this type; none for None.
template <class Report>
typename runs::Batches<Report>::Callback batches_to(const py::object& callback,
                                                    const py::dtype& type) {
  if (callback.is_none()) return {};
  const auto function = shared(callback);
  const auto row_type = shared(type);
  return [function, row_type](std::span<const Report> reports) {
    const LockTaken lock;
    call(*function, rows_of(reports, py::reinterpret_borrow<py::dtype>(*row_type)));
  };
}

/// Calls the function without the GIL, and lets Python handle its signals meanwhile. Throws what a
/// handler has thrown.
void set_up(const std::function<void()>& function) {
  std::exception_ptr of_handler;
  try {
    without_lock([&] {
      const StopRequest request([&] {
        of_handler = handle_signals();
        return std::string(of_handler ? "interrupted" : "");
      });
      function();
    });
  } catch (const StoppedEarly&) {
    std::rethrow_exception(of_handler);
  }
}

bool is_rough_sphere(const Species& species) { return species.turns() && !species.has_axis(); }

/// Properties of several species: arrays [species], and of each two [species][species].
void add_species(py::dict& out, const Composition& composition) {
  const auto size = static_cast<py::ssize_t>(composition.size());
  const auto each = [&](double Species::*member) {
    std::vector<double> values;
    for (const Species& one : composition.species()) values.push_back(one.*member);
    return read_only(values);
  };
  const auto pairs = [&](double Restitution::*member) {
    std::vector<double> values;
    for (const Restitution& rule : composition.rules()) values.push_back(rule.*member);
    return read_only(values.data(), {size, size});
  };
  py::tuple names(composition.size());
  std::vector<std::uint64_t> counts;
  for (std::size_t index = 0; index < composition.size(); ++index) {
    names[index] = text(composition[index].name);
    counts.push_back(composition[index].count);
  }
  out["species"] = names;
  out["counts"] = read_only(counts);
  out["k"] = each(&Species::k);
  out["length"] = each(&Species::length);
  std::vector<double> masses;
  for (const Species& one : composition.species()) masses.push_back(one.mass_or_infinity());
  out["mass"] = read_only(masses);
  if (composition.has_width()) out["diameter"] = each(&Species::diameter);
  if (std::ranges::any_of(composition.species(), is_rough_sphere)) out["q"] = each(&Species::q);
  out["epsilon"] = pairs(&Restitution::epsilon);
  out["beta"] = pairs(&Restitution::beta);
  std::vector<std::uint8_t> meet;
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = 0; b < composition.size(); ++b) meet.push_back(composition.meets(a, b));
  }
  if (!composition.all_meet()) out["meet"] = read_only(meet.data(), {size, size});
}

}  // namespace

Run::Run(const SceneSource& source, std::optional<State> state, bool force) {
  set_up([&] {
    runs::LoadedScene loaded = load_scene(source, std::move(state));
    runs::require_writable_output(loaded.scene, force, source.text ? "" : source.name,
                                  "force=True");
    warnings_ = runs::all_warnings(loaded);
    run_.emplace(std::move(loaded), force);
    add_warning(run_->warning());
  });
}

Run::Run(const std::string& file) {
  set_up([&] {
    auto [saved, warning] = runs::load_checkpoint(file);
    add_warning(warning);
    run_.emplace(std::move(saved));
    add_warning(run_->warning());
  });
}

void Run::add_warning(const std::string& warning) {
  if (!warning.empty()) warnings_.push_back(warning);
}

// A file that was not closed has all its frames nevertheless; there is no one to hear of errors.
Run::~Run() {
  try {
    run_->close();
  } catch (...) {
  }
}

void Run::require_idle() const {
  if (busy_) {
    throw UseError(
        "simulation: is running: expected one that has returned from run() or "
        "advance(); only interrupt() may be called meanwhile");
  }
}

void Run::require_open() const {
  if (closed_) throw UseError("simulation: is closed: expected one that is still open");
}

void Run::work(const std::function<void()>& function) {
  require_idle();
  struct Busy {
    explicit Busy(bool& flag) : flag_(flag) { flag_ = true; }
    ~Busy() { flag_ = false; }
    bool& flag_;
  };
  const Busy busy(busy_);
  without_lock(function);
}

std::string Run::drive(const Scene::Until& until, const py::object& show) {
  Monitor monitor(show);
  Stop stop{};
  work([&] { stop = run_->advance(until, monitor); });
  monitor.rethrow();
  return name_of(stop);
}

std::string Run::run(const runs::Limits& limits, const py::object& show) {
  require_idle();
  require_open();
  return drive(runs::from_start_or_scene(limits, run_->scene(), run_->simulation()), show);
}

std::string Run::advance(const runs::Limits& limits, const py::object& show) {
  require_idle();
  require_open();
  return drive(runs::from_now(limits, run_->simulation()), show);
}

void Run::on_collisions(const py::object& callback, std::size_t batch, const py::dtype& type) {
  require_idle();
  run_->on_collisions(batch, batches_to<Collision>(callback, type));
}

void Run::on_happenings(const py::object& callback, std::size_t batch, const py::dtype& type) {
  require_idle();
  run_->on_happenings(batch, batches_to<Happening>(callback, type));
}

void Run::set_velocities(std::vector<std::array<double, 3>> velocity,
                         std::vector<std::array<double, 3>> angular_velocity) {
  work([&] { run_->set_velocities(velocity, angular_velocity); });
}

void Run::sample(bool frame) {
  require_idle();
  require_open();
  if (const std::string why = run_->why_no_output(); !why.empty()) throw UseError(why);
  work([&] { run_->sample(frame); });
}

void Run::set_data(const std::string& name, std::optional<std::string> bytes, bool json) {
  require_idle();
  require_open();
  std::optional<UserData> data;
  if (bytes) {
    data = {json ? UserData::Kind::json : UserData::Kind::bytes, *std::move(bytes)};
  }
  work([&] { run_->set_data(name, std::move(data)); });
}

py::dict Run::data() {
  require_idle();
  py::dict out;
  for (const auto& [name, data] : run_->data()) {
    const py::bytes bytes(data.bytes);
    out[text(name)] = py::make_tuple(data.kind == UserData::Kind::json, bytes);
  }
  return out;
}

std::optional<double> Run::velocities_set() {
  require_idle();
  return run_->velocities_set();
}

py::list Run::warnings() const {
  py::list out;
  for (const std::string& warning : warnings_) out.append(text(warning));
  return out;
}

void Run::save(const std::string& path, bool force) {
  work([&] {
    runs::require_writable(path, force, path, "force=True");
    runs::write_state(run_->simulation(), run_->scene(), run_->data(), path, force);
  });
}

void Run::checkpoint() {
  require_idle();
  require_open();
  if (const std::string why = run_->why_not_saved(); !why.empty()) throw UseError(why);
  work([&] { run_->save_checkpoint(); });
}

void Run::close() {
  if (closed_) return;
  work([&] {
    closed_ = true;  // also where that fails
    run_->close();
  });
}

py::tuple Run::state() {
  State state;
  work([&] {
    run_->simulation().copy(state);
    state.species.resize(state.size());  // of one species all are 0
  });
  const OwnBodies& bodies = state.own_bodies;
  py::object own = py::none();
  // Bodies that grow are as their species say now, unless these differ.
  if (run_->simulation().composition().has_own_sizes())
    own = py::make_tuple(read_only(bodies.length), read_only(bodies.diameter),
                         read_only(bodies.mass), read_only(bodies.inertia));
  return py::make_tuple(read_only(state.position), read_only(state.velocity),
                        read_only(state.orientation), read_only(state.angular_velocity),
                        read_only(state.image), read_only(state.id), read_only(state.species), own);
}

namespace {

// Adds the numbers of a result under their names.
template <class Sums>
void add_numbers(py::dict& to, const Sums& sums) {
  sums.for_each([&](const Described& number, const auto& value) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
      to[number.name] = value;
    } else {
      to[number.name] = read_only(value.data(), {static_cast<py::ssize_t>(value.size())});
    }
  });
}

template <class Sums>
py::dict numbers_of(const Sums& sums) {
  py::dict out;
  add_numbers(out, sums);
  return out;
}

}  // namespace

py::dict Run::totals() {
  Totals totals;
  work([&] { totals = run_->simulation().totals(); });
  return numbers_of(totals);
}

py::list Run::species_totals() {
  std::vector<SpeciesTotals> totals;
  work([&] { totals = run_->simulation().species_totals(); });
  const Composition& composition = run_->simulation().composition();
  py::list out;
  for (std::size_t index = 0; index < totals.size(); ++index) {
    out.append(py::make_tuple(text(composition[index].name), numbers_of(totals[index])));
  }
  return out;
}

py::dict Run::collisions_by_pair() {
  require_idle();
  const Composition& composition = run_->simulation().composition();
  const std::vector<std::uint64_t> counts = run_->simulation().collisions_by_pair();
  py::dict out;
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      out[text(pair_name(composition, a, b))] = counts[composition.pair_index(a, b)];
    }
  }
  return out;
}

py::list Run::wall_totals() {
  require_idle();
  py::list out;
  for (const WallTotals& wall : run_->simulation().wall_totals()) {
    py::dict sums;
    sums["axis"] = text(axis_name(wall));
    sums["side"] = text(side_name(wall));
    add_numbers(sums, wall);
    out.append(sums);
  }
  return out;
}

py::dict Run::rod_totals() {
  require_idle();
  const observe::RodTotals rods = runs::rod_totals(run_->scene(), run_->simulation());
  py::dict out = numbers_of(rods);
  out["pressure_meaning"] = rods.pressure_meaning;
  return out;
}

py::object Run::sliding_contacts() {
  require_idle();
  const auto contacts = run_->simulation().sliding_contacts();
  return contacts ? py::object(numbers_of(*contacts)) : py::none();
}

py::object Run::growth() {
  require_idle();
  const auto growth = run_->simulation().growth();
  return growth ? py::object(numbers_of(*growth)) : py::none();
}

py::object Run::flow() {
  State state;
  work([&] {
    if (run_->scene().shear) run_->simulation().copy(state);
  });
  if (state.peculiar_velocity.empty() && state.shear_rate == 0 && state.slide == 0)
    return py::none();
  return py::make_tuple(state.slide, state.shear_rate, read_only(state.peculiar_velocity));
}

py::tuple Run::box() {
  require_idle();
  const std::array<double, 3> box = run_->simulation().box(), low = run_->simulation().low();
  return py::make_tuple(read_only(box.data(), {3}), read_only(low.data(), {3}));
}

py::object Run::stress() {
  require_idle();
  const auto stress = run_->simulation().stress();
  return stress ? py::object(numbers_of(*stress)) : py::none();
}

py::dict Run::energy_budget() {
  require_idle();
  return numbers_of(run_->simulation().energy_budget());
}

py::dict Run::counters() {
  require_idle();
  const Counters& counters = run_->simulation().counters();
  py::dict out;
  for (const Counters::Named& counter : Counters::all) out[counter.name] = counters.*counter.value;
  return out;
}

namespace {

py::dict columns_of(const Bodies& bodies) {
  py::list names;
  for (const std::string& name : bodies.names) names.append(text(name));
  py::dict out;
  out["name"] = std::move(names);
  out["length"] = bodies.length;
  out["diameter"] = bodies.diameter;
  out["mass"] = bodies.mass;
  out["k"] = bodies.k;
  out["inertia"] = bodies.inertia;
  return out;
}

}  // namespace

py::dict Run::facts() {
  require_idle();
  const Scene& scene = run_->scene();
  const Simulation& simulation = run_->simulation();
  const Composition& composition = simulation.composition();
  py::dict out;
  out["title"] = text(scene.title);
  out["text"] = text(scene.text);
  out["file"] = text(scene.output.file);
  out["count"] = scene.needles.count;
  out["box"] = read_only(scene.needles.box.data(), {3});
  out["moving_walls"] = scene.has_moving_walls();
  if (composition.is_mixture()) {
    add_species(out, composition);
  } else {
    out["k"] = composition[0].k;
    out["epsilon"] = composition.restitution(0, 0).epsilon;
    out["beta"] = composition.restitution(0, 0).beta;
    out["length"] = composition[0].length;
    out["mass"] = composition[0].mass;
    if (composition.has_width()) out["diameter"] = composition[0].diameter;
    if (is_rough_sphere(composition[0])) out["q"] = composition[0].q;
    if (!composition.all_meet()) out["meet"] = composition.meets(0, 0);
  }
  out["differ"] = composition.has_own_sizes();
  out["turn"] = composition.turning_share() > 0;
  out["bodies"] = columns_of(bodies_of(composition));
  out["search"] = simulation.search();
  out["queue"] = simulation.queue();
  out["isa"] = simulation.isa();
  out["effects"] = simulation.effects();
  out["threads"] = scene.engine.threads.value_or(1);
  return out;
}

double Run::time() {
  require_idle();
  return run_->simulation().time();
}

double Run::mean_free_time() {
  require_idle();
  return run_->simulation().mean_free_time();
}

std::string Run::hash() {
  require_idle();
  return run_->simulation().trajectory_hash();
}

}  // namespace needlework::python
