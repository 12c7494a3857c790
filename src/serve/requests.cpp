#include "src/serve/requests.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/json/base64.h"
#include "src/json/results.h"
#include "src/json/shallow_json.h"
#include "src/runs/bodies_of_needles.h"
#include "src/runs/capabilities.h"
#include "src/runs/limits.h"
#include "src/runs/load_checkpoint.h"
#include "src/runs/output_path.h"
#include "src/runs/state_file.h"
#include "src/scene/adopt_state.h"
#include "src/scene/confinement.h"
#include "src/scene/printable.h"
#include "src/serve/collisions.h"
#include "src/serve/fields.h"
#include "src/serve/prediction.h"

namespace needlework::serve {

using json::base64_of;
using json::parse_shallow;
using json::text_of;
namespace {

// What a state answers, and what a simulation is created from.
constexpr std::array<std::string_view, 17> state_arrays{"position",
                                                        "velocity",
                                                        "orientation",
                                                        "angular_velocity",
                                                        "image",
                                                        "needle_id",
                                                        "species",
                                                        "bodies",
                                                        "length",
                                                        "diameter",
                                                        "mass",
                                                        "inertia",
                                                        "box",
                                                        "low",
                                                        "peculiar_velocity",
                                                        "slide",
                                                        "shear_rate"};

/// Infinity and NaN, which JSON does not have, become null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json numbers(const std::array<double, 3>& values) {
  return {number(values[0]), number(values[1]), number(values[2])};
}

Json summary_of(const runs::PreparedRun& run) {
  const Simulation& simulation = run.simulation();
  Json answer;
  json::add_numbers(answer, simulation.totals());
  answer["trajectory_hash"] = simulation.trajectory_hash();
  if (!run.scene().species.empty()) json::add_species(answer, simulation);
  if (simulation.composition().has_width()) json::add_rods(answer, run.scene(), simulation);
  if (!run.scene().walls.empty()) json::add_walls(answer, simulation);
  if (acts_on_single_needles(run.scene())) json::add_energy_budget(answer, simulation);
  json::add_contacts(answer, simulation);
  json::add_growth(answer, simulation);
  json::add_stress(answer, simulation);
  return answer;
}

Json json_of(const Bodies& bodies) {
  Json out = Json::object();
  if (!bodies.names.empty()) out["name"] = bodies.names;
  out["length"] = bodies.length;
  out["diameter"] = bodies.diameter;
  for (const auto& [name, column] :
       {std::pair("mass", &bodies.mass), {"inertia", &bodies.inertia}}) {
    out[name] = Json::array();
    for (const double each : *column) out[name].push_back(number(each));  // null: fixed
  }
  out["k"] = bodies.k;
  return out;
}

/// The columns with the names of their fields.
template <class Own>
auto columns_of(Own& own) {
  return std::array{std::pair("length", &own.length), std::pair("diameter", &own.diameter),
                    std::pair("mass", &own.mass), std::pair("inertia", &own.inertia)};
}

/// The state that the request carries; none if it carries no array.
std::optional<State> state_in(const Json& request) {
  State state;
  const auto read = [](auto given, auto& rows) {
    if (given) rows = std::move(*given);
    return given.has_value();
  };
  const bool position = read(vectors_in(request, "position"), state.position);
  const bool orientation = read(vectors_in(request, "orientation"), state.orientation);
  const bool velocity = read(vectors_in(request, "velocity"), state.velocity);
  const bool peculiar = read(vectors_in(request, "peculiar_velocity"), state.peculiar_velocity);
  const bool angular_velocity =
      read(vectors_in(request, "angular_velocity"), state.angular_velocity);
  const bool image = read(images_in(request, "image"), state.image);
  const bool id = read(ids_in(request, "needle_id"), state.id);
  const bool species = read(species_in(request, "species"), state.species);
  const bool bodies = read(bodies_in(request, "bodies"), state.bodies);
  const bool box = read(three_in(request, "box"), state.box);
  const bool low = read(three_in(request, "low"), state.low);
  const bool slide = read(number_in(request, "slide"), state.slide);
  const bool shear_rate = read(number_in(request, "shear_rate"), state.shear_rate);
  const auto own = columns_of(state.own_bodies);
  const bool has_own =
      std::ranges::any_of(own, [&](const auto& column) { return request.contains(column.first); });
  if (!(position || orientation || velocity || peculiar || angular_velocity || image || id ||
        species || bodies || box || low || slide || shear_rate || has_own)) {
    return std::nullopt;
  }
  if (!position || !orientation) {
    throw RequestError("position, orientation: expected both, where a state is given");
  }
  if (velocity && peculiar) throw RequestError("velocity, peculiar_velocity: expected one of them");
  for (const auto& [field, column] : own) read(numbers_in(request, field, state.size()), *column);
  if (!velocity && !peculiar) state.velocity.resize(state.size());
  if (!angular_velocity) state.angular_velocity.resize(state.size());
  // A state takes no rows of these for absent ones.
  for (const auto& [field, given, rows] :
       {std::tuple("image", image, state.image.size()),
        {"peculiar_velocity", peculiar, state.peculiar_velocity.size()},
        {"needle_id", id, state.id.size()},
        {"species", species, state.species.size()}}) {
    if (!given || rows == state.size()) continue;
    throw RequestError(fmt::format("{}: {} rows: expected {}", field, rows, state.size()));
  }
  return state;
}

runs::LoadedScene scene_in(const Json& request) {
  const auto text = text_in(request, "scene"), path = text_in(request, "path");
  if (text.has_value() == path.has_value()) {
    throw RequestError("scene, path: expected one of them: the text of a scene, or a file's name");
  }
  std::optional<State> state = state_in(request);
  const Provided provided{.state = state.has_value(), .end = true};
  Scene scene = text ? parse_scene(*text, "scene", {}, provided) : read_scene(*path, {}, provided);
  if (!state) return runs::complete_scene(std::move(scene));
  if (state->box == std::array<double, 3>{}) state->box = scene.needles.box;
  return runs::complete_scene(std::move(scene), std::move(*state));
}

/// The conditions counted by `count`, from the start or from now. What is wrong with them is a
/// fault of the request.
template <class Count>
Scene::Until counted(const runs::Limits& limits, const runs::PreparedRun& run, Count count) {
  try {
    return count(limits, run.simulation());
  } catch (const InputError& error) {
    throw RequestError(error.what());
  }
}

runs::Limits limits_in(const Json& request) {
  return {.time = number_in(request, "time"),
          .collisions = count_in(request, "collisions"),
          .collisions_per_needle = number_in(request, "collisions_per_needle"),
          .energy_ratio = number_in(request, "energy_ratio"),
          .wall_s = number_in(request, "wall_s")};
}

/// Passes on interruptions, and progress where the front end wants it.
class Monitor : public runs::RunMonitor {
 public:
  Monitor(const Json& request, const Connection& connection)
      : connection_(connection), every_(number_in(request, "progress_s")), next_(every_) {
    if (every_ && !(*every_ >= 0)) {
      throw RequestError(fmt::format("progress_s = {}: expected a number >= 0", *every_));
    }
    if (request.contains("id")) id_ = request["id"];
  }

  bool is_due(double elapsed) const override { return next_ && elapsed >= *next_; }
  void show(const runs::Progress& progress) override {
    next_ = progress.elapsed + *every_;
    connection_.notify({{"id", id_},
                        {"progress", number(progress.fraction)},
                        {"time", progress.now.time},
                        {"collisions", progress.now.collisions}});
  }
  bool stop_requested() const override { return connection_.interrupted(); }

 private:
  const Connection& connection_;
  std::optional<double> every_, next_;
  Json id_;
};

/// Sends the collisions of an advance, or all that happens, to a front end that asks for them, up
/// to `batch` in a line.
class Stream {
 public:
  Stream(runs::PreparedRun& run, const Json& request, const Connection& connection) : run_(run) {
    const auto batch = count_in(request, "batch");
    const bool all = flag_in(request, "happenings");
    auto fields = names_in(request, "fields", report_fields(all));
    if (!batch) {
      if (fields) throw RequestError("fields: expected batch, too: how many collisions to send");
      if (all) throw RequestError("happenings: expected batch, too: how many to send");
      return;
    }
    if (*batch == 0 || *batch > most) {
      throw RequestError(fmt::format("batch = {}: expected 1 to {}", *batch, most));
    }
    if (!fields) fields = usual_fields(all);
    const Json id = request.contains("id") ? request["id"] : Json();
    const auto send = [fields = *fields, id, &connection](auto reports) {
      Json line{{"id", id}, {"batch", reports.size()}};
      line.update(as_arrays(reports, fields));
      connection.notify(line);
    };
    if (all) {
      run_.on_happenings(*batch, send);
    } else {
      run_.on_collisions(*batch, send);
    }
  }
  ~Stream() {
    run_.on_collisions(1, {});
    run_.on_happenings(1, {});
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

 private:
  static constexpr std::uint64_t most = 1000000;
  runs::PreparedRun& run_;
};

Json drive(runs::PreparedRun& run, const Scene::Until& until, const Json& request,
           const Connection& connection) {
  Monitor monitor(request, connection);
  const Stream stream(run, request, connection);
  Json answer{{"stop", name_of(run.advance(until, monitor))}};
  answer.update(summary_of(run));
  return answer;
}

}  // namespace

const std::map<std::string, Requests::Handler> Requests::handlers = {
    {"create", &Requests::create},
    {"advance", &Requests::advance},
    {"run_until", &Requests::run_until},
    {"totals", &Requests::totals},
    {"state", &Requests::state},
    {"velocities", &Requests::velocities},
    {"close", &Requests::close},
    {"resume", &Requests::resume},
    {"checkpoint", &Requests::checkpoint},
    {"sample", &Requests::sample},
    {"data", &Requests::data},
    {"predict", &Requests::predict},
    {"version", &Requests::version}};

Json Requests::answer(const Json& request, const Connection& connection) {
  const std::optional<std::string> name = text_in(request, "do");
  const auto handler = handlers.find(name.value_or(""));
  if (handler == handlers.end()) {
    std::string known;
    for (const auto& entry : handlers) known += entry.first + ", ";
    throw RequestError(fmt::format(
        "{}: expected one of {}interrupt, quit",
        name ? fmt::format("do = \"{}\"", name->substr(0, 60)) : "do is missing", known));
  }
  return (this->*handler->second)(request, connection);
}

runs::PreparedRun& Requests::run_of(const Json& request) {
  const auto number = count_in(request, "simulation");
  if (!number)
    throw RequestError("simulation: expected the number that create or resume has returned");
  const auto found = runs_.find(static_cast<std::int64_t>(*number));
  if (found == runs_.end()) {
    throw RequestError(fmt::format(
        "simulation = {}: expected the number of a simulation that is not closed", *number));
  }
  return *found->second;
}

Json Requests::create(const Json& request, const Connection&) {
  require_only(request, {"scene", "path", "force"}, state_arrays);
  const bool force = flag_in(request, "force");
  runs::LoadedScene loaded = scene_in(request);
  runs::require_writable_output(loaded.scene, force, text_in(request, "path").value_or(""),
                                "\"force\": true");
  const std::string warning = runs::warning_of_state(loaded);
  return add(std::make_unique<runs::PreparedRun>(std::move(loaded), force), warning);
}

Json Requests::resume(const Json& request, const Connection&) {
  require_only(request, {"file"});
  const auto file = text_in(request, "file");
  if (!file) throw RequestError("file: expected the output file of a run");
  auto [saved, warning] = runs::load_checkpoint(*file);
  return add(std::make_unique<runs::PreparedRun>(std::move(saved)), warning);
}

/// Takes a run in, and returns what there is to say of it.
Json Requests::add(std::unique_ptr<runs::PreparedRun> run, const std::string& warning) {
  const Simulation& simulation = run->simulation();
  Json answer{{"simulation", next_},
              {"needles", simulation.needles()},
              {"box", numbers(run->scene().needles.box)},
              {"search", simulation.search()},
              {"isa", simulation.isa()},
              {"effects", simulation.effects()}};
  if (const std::string all = runs::joined(warning, run->warning()); !all.empty())
    answer["warning"] = all;
  runs_.emplace(next_++, std::move(run));
  return answer;
}

Json Requests::advance(const Json& request, const Connection& connection) {
  require_only(request, {"simulation", "time", "collisions", "collisions_per_needle",
                         "energy_ratio", "wall_s", "progress_s", "batch", "fields", "happenings"});
  runs::PreparedRun& run = run_of(request);
  return drive(run, counted(limits_in(request), run, runs::from_now), request, connection);
}

Json Requests::run_until(const Json& request, const Connection& connection) {
  require_only(request, {"simulation", "time", "collisions", "collisions_per_needle",
                         "energy_ratio", "wall_s", "progress_s", "batch", "fields", "happenings"});
  runs::PreparedRun& run = run_of(request);
  const auto count = [&](const runs::Limits& limits, const Simulation& simulation) {
    return runs::from_start_or_scene(limits, run.scene(), simulation);
  };
  return drive(run, counted(limits_in(request), run, count), request, connection);
}

Json Requests::totals(const Json& request, const Connection&) {
  require_only(request, {"simulation"});
  return summary_of(run_of(request));
}

Json Requests::state(const Json& request, const Connection&) {
  require_only(request, {"simulation", "file", "force", "arrays"});
  const runs::PreparedRun& run = run_of(request);
  if (const auto file = text_in(request, "file")) {
    runs::write_state(run.simulation(), run.scene(), run.data(), *file, flag_in(request, "force"));
    return {{"file", *file}};
  }
  const auto wanted = names_in(request, "arrays", state_arrays);
  State state = run.simulation().copy();
  state.species.resize(state.size());  // of one species all are 0
  Json answer{{"time", run.simulation().time()}, {"needles", state.size()}};
  const auto is_wanted = [&](std::string_view name) {
    return !wanted || std::ranges::find(*wanted, name) != wanted->end();
  };
  const auto add = [&](std::string_view name, const auto& rows) {
    if (is_wanted(name)) answer[std::string(name)] = text_of(rows);
  };
  add("position", state.position);
  add("velocity", state.velocity);
  add("orientation", state.orientation);
  add("angular_velocity", state.angular_velocity);
  add("image", state.image);
  add("needle_id", state.id);
  add("species", state.species);
  // Without a flow, velocities are beside none.
  if (wanted) {
    const bool flows = !state.peculiar_velocity.empty();
    add("peculiar_velocity", flows ? state.peculiar_velocity : state.velocity);
  }
  // All of them make a simulation of the same needles, whose bodies differ only where these do.
  const Composition& composition = run.simulation().composition();
  OwnBodies own;
  if (wanted) {
    own = runs::bodies_of_needles(run.simulation());
  } else if (composition.has_own_sizes()) {
    own = std::move(state.own_bodies);
  }
  for (const auto& [field, column] : columns_of(own))
    if (!column->empty()) add(field, *column);
  // Where walls do not move, the box is that of the scene.
  const bool moves = run.scene().has_moving_walls();
  for (const auto& [name, value] : {std::pair("box", &state.box), {"low", &state.low}})
    if (moves ? is_wanted(name) : wanted && is_wanted(name)) answer[name] = numbers(*value);
  const bool is_sheared = run.scene().shear.has_value();
  for (const auto& [name, value] :
       {std::pair("slide", state.slide), {"shear_rate", state.shear_rate}})
    if (is_sheared ? is_wanted(name) : wanted && is_wanted(name)) answer[name] = value;
  if (is_wanted("bodies"))
    answer["bodies"] = json_of(bodies_of(composition, state.scale.value_or(1)));
  return answer;
}

Json Requests::sample(const Json& request, const Connection&) {
  require_only(request, {"simulation", "frame"});
  runs::PreparedRun& run = run_of(request);
  const bool frame = flag_in(request, "frame");
  if (const std::string why = run.why_no_output(); !why.empty()) throw RequestError(why);
  run.sample(frame);
  return Json::object();
}

Json Requests::data(const Json& request, const Connection&) {
  require_only(request, {"simulation", "name", "json", "bytes", "remove"});
  runs::PreparedRun& run = run_of(request);
  const auto name = text_in(request, "name");
  const auto bytes = bytes_in(request, "bytes");
  const bool json = request.contains("json"), remove = flag_in(request, "remove");
  if (json + bytes.has_value() + remove > 1) {
    throw RequestError("json, bytes, remove: expected one of them at most");
  }
  const auto shown = [](const UserData& data) -> Json {
    if (data.kind == UserData::Kind::json) return {{"json", parse_shallow<Json>(data.bytes)}};
    return {{"bytes", base64_of(std::as_bytes(std::span(data.bytes)))}};
  };
  if (!name) {
    if (json || bytes || remove) throw RequestError("name: expected that of the data");
    Json all = Json::object();
    for (const auto& [each, data] : run.data()) all[each] = shown(data);
    return {{"data", all}};
  }
  try {
    if (json) run.set_data(*name, UserData{UserData::Kind::json, request["json"].dump()});
    if (bytes) run.set_data(*name, UserData{UserData::Kind::bytes, *bytes});
    if (remove) run.set_data(*name, std::nullopt);
  } catch (const InputError& error) {
    throw RequestError(error.what());
  }
  if (json || bytes || remove) return Json::object();
  const auto found = run.data().find(*name);
  if (found == run.data().end()) {
    throw RequestError(fmt::format("name = \"{}\": expected one that has been set",
                                   printable(*name, longest_data_name)));
  }
  return shown(found->second);
}

Json Requests::velocities(const Json& request, const Connection&) {
  require_only(request, {"simulation", "velocity", "angular_velocity"});
  runs::PreparedRun& run = run_of(request);
  const auto velocity = vectors_in(request, "velocity");
  const auto angular_velocity = vectors_in(request, "angular_velocity");
  if (!velocity) throw RequestError("velocity: expected the velocities of all needles");
  run.set_velocities(
      *velocity, angular_velocity.value_or(std::vector<std::array<double, 3>>(velocity->size())));
  Json answer = summary_of(run);
  if (!angular_velocity && run.simulation().composition().turning_share() > 0)
    answer["warning"] = runs::no_rotation_given;
  return answer;
}

Json Requests::predict(const Json& request, const Connection&) { return first_contacts(request); }

Json Requests::version(const Json& request, const Connection&) {
  require_only(request, {});
  return {{"version", NEEDLEWORK_VERSION}, {"capabilities", runs::capabilities()}};
}

Json Requests::checkpoint(const Json& request, const Connection&) {
  require_only(request, {"simulation"});
  runs::PreparedRun& run = run_of(request);
  if (const std::string why = run.why_not_saved(); !why.empty()) throw RequestError(why);
  run.save_checkpoint();
  return Json::object();
}

Json Requests::close(const Json& request, const Connection&) {
  require_only(request, {"simulation"});
  static_cast<void>(run_of(request));
  // Gone also where its file cannot be completed.
  const auto closed = runs_.extract(static_cast<std::int64_t>(*count_in(request, "simulation")));
  closed.mapped()->close();
  return Json::object();
}

}  // namespace needlework::serve
