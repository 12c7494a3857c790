#include "src/cli/import_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "needlework/parse.h"
#include "needlework/simulation.h"
#include "src/cli/file_kind.h"
#include "src/cli/messages.h"
#include "src/io/formats/read_configuration.h"
#include "src/io/formats/text_file.h"
#include "src/runs/exit_codes.h"
#include "src/runs/loaded_scene.h"
#include "src/runs/output_path.h"
#include "src/scene/adopt_state.h"
#include "src/scene/printable.h"

namespace needlework::cli {

using enum runs::ExitCode;

namespace {

namespace fs = std::filesystem;

constexpr double assumed_collisions_per_needle = 10;

// A string in TOML, for which that of JSON in ASCII serves. The text must be UTF-8.
std::string toml(const std::string& text) {
  constexpr int in_one_line = -1;
  std::string quoted = nlohmann::json(text).dump(in_one_line);
  for (auto at = quoted.find('\x7f'); at != quoted.npos; at = quoted.find('\x7f', at)) {
    quoted.replace(at, 1, "\\u007f");  // which JSON allows, and TOML does not
  }
  return quoted;
}

// The name of the state in a scene. Unlike a title, it must be exact.
std::string path_in_toml(const std::string& path) {
  try {
    return toml(path);
  } catch (const nlohmann::json::type_error&) {  // it is not UTF-8
    throw IoError(fmt::format(
        "--out {}: cannot be named in a scene: expected a folder whose full name is UTF-8",
        printable(fs::path(path).parent_path().string())));
  }
}

void warn_of_what_is_assumed(const io::Material& material, const std::string& path) {
  const Scene::Species species;
  const Scene::Collisions collisions;
  const double k = io::has_width(material) ? io::species_of(material).front().k : species.k;
  for (const auto& [name, values, assumed] :
       {std::tuple("length", &material.length, species.length),
        std::tuple("mass", &material.mass, species.mass), std::tuple("k", &material.k, k),
        std::tuple("epsilon", &material.epsilon, collisions.epsilon)}) {
    if (!values->empty()) continue;
    print_warning(
        fmt::format("{}: {} is not in the file: {} is assumed", printable(path), name, assumed));
  }
}

void warn_of_walls(const io::Configuration& read, const std::string& path) {
  if (!read.material.walls.empty() || read.state.periodic == std::array{true, true, true}) return;
  print_warning(
      fmt::format("{}: the box is not periodic along all axes, and nothing says what ends it: "
                  "walls at rest with epsilon = 1 are assumed",
                  printable(path)));
}

void warn_of_flow(const State& state, const std::string& path) {
  if (state.slide == 0 || state.shear_rate != 0) return;
  print_warning(
      fmt::format("{}: the box is tilted along x, and nothing says at which rate it is sheared: "
                  "shear.rate = 0 is assumed, so that it stays tilted",
                  printable(path)));
}

void warn_of_roundings(const io::Configuration& read, const std::string& path) {
  const io::Roundings& roundings = read.roundings;
  if (roundings.needles == 0) return;
  print_warning(
      fmt::format("{}: {} of {} needles were projected: their directors were not of length 1, or "
                  "their angular velocities not normal to them, by up to {:.2g}, as rounding does",
                  printable(path), roundings.needles, read.state.size(), roundings.largest));
}

// Such as bodies that overlap, which only an edited state will not have.
void warn_of_bad_state(const Scene& scene, const State& state, const std::string& path) {
  try {
    require_simulable(scene, state);
  } catch (const InputError& error) {
    print_warning(fmt::format("{}: cannot be run as it is: {}", printable(path), error.what()));
  }
}

// The species with the counts of their needles.
Composition counted(const io::Configuration& read, const std::string& from) {
  Composition composition = io::composition_of(read.material, printable(from));
  if (composition.size() > 1 && read.state.species.empty() && read.state.size() > 0) {
    throw InputError(
        fmt::format("{}: {} species: expected a column that says which needle is of "
                    "which",
                    printable(from), composition.size()));
  }
  std::vector<std::uint64_t> counts(composition.size());
  for (std::size_t i = 0; i < read.state.size(); ++i) {
    const std::size_t index = io::species_at(read.state, i);
    if (index >= counts.size()) {
      throw InputError(fmt::format("{}: a needle of species {}: expected an index below {}",
                                   printable(from), index, counts.size()));
    }
    ++counts[index];
  }
  for (std::size_t i = 0; i < counts.size(); ++i) composition.set_count(i, counts[i]);
  return composition;
}

std::string species_text(const Composition& composition, const io::Configuration& read) {
  const std::vector<bool> differ = io::which_differ(read.state, composition.size());
  const bool is_length_known = !read.material.length.empty();
  std::string text;
  for (std::size_t n = 0; n < composition.size(); ++n) {
    const Species& each = composition[n];
    text +=
        fmt::format("[[species]]\nname = {}\ncount = {}\n", toml(printable(each.name)), each.count);
    if (differ[n]) {
      text += "# each body has the length, diameter, mass and moment of inertia of the state\n";
    } else {
      text += fmt::format("length = {}\n", each.length);
      const double inertia = io::number_of(read.material.inertia, n, 0);
      const bool is_rough_sphere = !each.has_axis() && inertia > 0;
      const auto shape = is_rough_sphere ? std::pair("inertia", inertia) : std::pair("k", each.k);
      if (!each.fixed)
        text += fmt::format("mass = {}\n{} = {}\n", each.mass, shape.first, shape.second);
      // A state of unknown length says no diameter either.
      const bool is_said = each.diameter > 0 || !is_length_known;
      if (is_said) text += fmt::format("diameter = {}\n", each.diameter);
    }
    if (each.fixed) text += "fixed = true\n";
    if (each.fixed && composition.has_width())
      text += "overlap = true  # not from the file: they are as they are\n";
    text += '\n';
  }
  return text;
}

std::string rule_text(const Restitution& rule, const std::optional<double>& contact_time) {
  const double smooth = Scene::Collisions{}.beta;
  return fmt::format("epsilon = {}\n{}{}", rule.epsilon,
                     rule.beta == smooth ? "" : fmt::format("beta = {}\n", rule.beta),
                     contact_time ? fmt::format("tc = {}\n", *contact_time) : "");
}

// What differs from the rule of the first species.
std::string pairs_text(const Composition& composition) {
  std::string text;
  const Restitution first = composition.restitution(0, 0);
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      const Restitution rule = composition.restitution(a, b);
      const bool meet = composition.meets(a, b);
      const bool are_fixed = composition[a].fixed && composition[b].fixed;
      if (are_fixed || (meet && rule == first)) continue;
      const std::string how =
          meet ? fmt::format("epsilon = {}\nbeta = {}", rule.epsilon, rule.beta) : "meet = false";
      text +=
          fmt::format("[[pairs]]\nbetween = [{}, {}]\n{}\n\n", toml(printable(composition[a].name)),
                      toml(printable(composition[b].name)), how);
    }
  }
  return text;
}

// The walls that end the box. Where a file says no more than that it is not periodic along an axis,
// they are assumed at both ends.
std::vector<Scene::Wall> walls_of(const io::Configuration& read, const std::string& from) {
  std::vector<Scene::Wall> walls = read.material.walls;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char name = "xyz"[axis];
    const bool walled =
        io::wall_at(read.material, axis, false) || io::wall_at(read.material, axis, true);
    if (walled != read.state.periodic[axis]) continue;
    if (walled || !walls.empty()) {
      throw InputError(
          fmt::format("{}: {} along {}, with walls {}: expected walls along the axes "
                      "that are not periodic, and no others",
                      printable(from), walled ? "periodic" : "not periodic", name,
                      walled ? "there" : "along others"));
    }
  }
  if (!walls.empty()) return walls;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (read.state.periodic[axis]) continue;
    Scene::Wall& wall = walls.emplace_back();
    wall.axis = std::string(1, "xyz"[axis]);
    wall.side = "both";
  }
  return walls;
}

std::string walls_text(const std::vector<Scene::Wall>& walls,
                       const std::array<double, 3>& gravity) {
  std::string text;
  for (const Scene::Wall& wall : walls) {
    text += fmt::format("[[walls]]\naxis = \"{}\"\nside = \"{}\"\n", wall.axis, wall.side);
    text += wall.temperature ? fmt::format("temperature = {}\n\n", *wall.temperature)
                             : fmt::format("epsilon = {}\n\n", wall.epsilon);
  }
  if (gravity == std::array<double, 3>{}) return text;
  return text + fmt::format("[forces]\ngravity = [{}]\n\n", fmt::join(gravity, ", "));
}

// A sheared box. Where a file does not say the rate of the flow, the box stays tilted as it is.
std::string shear_text(const State& state) {
  if (state.slide == 0 && state.shear_rate == 0) return "";
  return fmt::format("[shear]\nrate = {}{}\n\n", state.shear_rate,
                     state.shear_rate == 0 ? "  # not from the file" : "");
}

std::string scene_text(const io::Configuration& read, const std::string& from,
                       const std::string& state_file) {
  const Composition composition = counted(read, from);
  return fmt::format(
      R"(title = {}

[needles]
box = [{}]

{}[initial]
file = {}

[collisions]
{}
{}{}{}[until]
collisions_per_needle = {}  # not from the file: choose an end
)",
      toml(printable("Imported from " + fs::path(from).filename().string())),
      fmt::join(read.state.box, ", "), species_text(composition, read), path_in_toml(state_file),
      rule_text(composition.restitution(0, 0), read.contact_time), pairs_text(composition),
      walls_text(walls_of(read, from), read.material.gravity), shear_text(read.state),
      assumed_collisions_per_needle);
}

std::optional<std::size_t> frame_number(const std::string& frame) {
  if (frame == "last") return {};
  return frame == "first" ? 0 : std::stoull(frame);
}

bool has_rough_spheres(const io::Configuration& read) {
  const std::vector<Species> species = io::species_of(read.material);
  for (std::size_t i = 0; i < read.state.size(); ++i) {
    const io::BodyOfRow body = io::body_at(species, read.state, i);
    if (body.length == 0 && body.inertia > 0 && std::isfinite(body.mass)) return true;
  }
  return false;
}

io::Configuration read_configuration(const ImportArguments& arguments) {
  try {
    io::Configuration read = io::read_configuration(arguments.from, frame_number(arguments.frame));
    // As the state says it that is written.
    if (!read.state.own_bodies.empty())
      read.state.bodies = bodies_of(io::composition_of(read.material, arguments.from));
    if (read.material.beta.empty() && has_rough_spheres(read)) {
      read.material.beta = {1};
      read.notes.emplace_back(
          "beta is not in the file: 1 is assumed, as its spheres have a moment of inertia");
    }
    return read;
  } catch (const InputError& error) {
    throw InputError(printable(error.what()));
  }
}

// Completes the scene with its state, so that a configuration that cannot be run is reported now,
// not by `run`.
Scene checked_scene(const std::string& text, State state, const std::string& from) {
  try {
    Scene scene = parse_scene(text, "scene.toml");
    adopt_state(scene, state);
    return scene;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: cannot be run: {}", printable(from), error.what()));
  }
}

// What the scene may say otherwise, as the file does not say it.
std::vector<std::string> assumed_of_bodies(const io::Material& material) {
  std::vector<std::string> names;
  for (const auto& [name, is_known] : {std::pair("species", !material.names.empty()),
                                       {"length", !material.length.empty()},
                                       {"mass", !material.mass.empty()},
                                       {"k", !material.k.empty()}}) {
    if (!is_known) names.emplace_back(name);
  }
  return names;
}

void write_state(const std::string& file, bool force, const Scene& scene,
                 const io::Configuration& read) {
  State state = read.state;
  if (scene.shear) state.peculiar_velocity = runs::peculiar_velocities(state, scene);
  io::RunInfo run;
  run.isa = "none";  // nothing was computed
  run.species = state.species;
  run.own_bodies = state.own_bodies;
  run.assumed = assumed_of_bodies(read.material);
  io::Writer writer(file, force, scene, run);
  writer.write_frame(runs::totals_of(state, scene), state);
  writer.close();
}

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    throw IoError(fmt::format("--out {}: cannot be made: {}", printable(folder),
                              error ? error.message() : "expected a folder"));
  }
}

}  // namespace

int run(const ImportArguments& arguments) {
  const io::Configuration read = read_file(arguments.from, FileKind::configuration,
                                           [&] { return read_configuration(arguments); });
  const fs::path folder(arguments.folder);
  const std::string scene_file = (folder / "scene.toml").string();
  const std::string state_file = (folder / "state.h5").string();
  const std::string text =
      scene_text(read, arguments.from, fs::absolute(state_file).lexically_normal().string());
  const Scene scene = checked_scene(text, read.state, arguments.from);

  make_folder(arguments.folder);
  for (const std::string& file : {scene_file, state_file}) {
    runs::require_writable(file, arguments.force, file);
  }
  warn_of_what_is_assumed(read.material, arguments.from);
  warn_of_walls(read, arguments.from);
  warn_of_flow(read.state, arguments.from);
  for (const std::string& note : read.notes) {
    print_warning(fmt::format("{}: {}", printable(arguments.from), note));
  }
  warn_of_roundings(read, arguments.from);
  warn_of_bad_state(scene, read.state, arguments.from);
  write_state(state_file, arguments.force, scene, read);
  io::TextFile out(scene_file, arguments.force);
  out.write(text);
  out.publish();
  return ok;
}

}  // namespace needlework::cli
