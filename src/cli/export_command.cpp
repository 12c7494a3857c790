#include "src/cli/export_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/cli/file_kind.h"
#include "src/cli/frame_choice.h"
#include "src/cli/messages.h"
#include "src/io/formats/export_formats.h"
#include "src/runs/exit_codes.h"
#include "src/runs/output_path.h"

namespace needlework::cli {

using enum runs::ExitCode;

namespace {

// The usual endings of names of the formats, or of those that hold several frames.
std::string endings(bool many) {
  std::vector<std::string_view> all;
  for (const io::ExportFormat& format : io::export_formats()) {
    if (format.many || !many) all.push_back(format.endings.front());
  }
  return fmt::format("{}", fmt::join(all, ", "));
}

io::Material read_material(const std::string& path, const io::ExportFormat& format) {
  io::Material material = io::read_material(path);
  if (format.whole_material) io::require_complete(material, path);
  return material;
}

// What DynamO does otherwise than the file that is exported to it.
void warn_of_other_motion(const io::Material& material, const std::string& path) {
  const auto rough = std::ranges::find_if(material.beta, [](double beta) { return beta != -1; });
  if (rough != material.beta.end()) {
    print_warning(fmt::format("{}: beta = {} is left out: {} of DynamO are smooth", path, *rough,
                              io::has_width(material) ? "spheres" : "lines"));
  }
  // Spheres are those of DynamO, and so are their walls.
  if (io::has_width(material)) return;
  if (io::differ_in_inertia(material)) {
    print_warning(
        fmt::format("{}: species differ in mass or moment of inertia: DynamO takes both numbers of "
                    "the first of two lines for the other one, too",
                    path));
  }
  if (!material.walls.empty()) {
    print_warning(
        fmt::format("{}: walls of DynamO stop balls of the needles' length around their "
                    "centres, not tips",
                    path));
  }
}

// Walls of every format are at rest, and thermal ones those of DynamO alone, which refuses walls
// that move.
void warn_of_walls(const io::Material& material, const std::string& path,
                   const io::ExportFormat& format) {
  if (format.whole_material) return;
  std::vector<std::string> moving, thermal;
  for (const Scene::Wall& wall : io::single_walls(material.walls)) {
    const std::string name = wall.axis + "-" + wall.side;
    if (wall.motion && (io::moves(*wall.motion) || io::slides(*wall.motion)))
      moving.push_back(name);
    if (wall.temperature) thermal.push_back(name);
  }
  for (const auto& [key, names] : {std::pair{"motion", moving}, {"temperature", thermal}}) {
    if (names.empty()) continue;
    print_warning(fmt::format("{}: walls.{} of {} is left out: {} has no place for it", path, key,
                              fmt::join(names, ", "), format.what));
  }
}

// Spheres of DynamO are points, which do not turn. Those that are smooth here do not turn either,
// and their directors say nothing.
void warn_of_turning_spheres(const State& state, const io::Material& material,
                             const std::string& path, const io::ExportFormat& format) {
  if (!format.whole_material || !io::are_spheres(material)) return;
  const bool turn = std::ranges::any_of(state.angular_velocity,
                                        [](const auto& w) { return w != std::array<double, 3>{}; });
  const bool are_rough =
      std::ranges::any_of(material.inertia, [](double inertia) { return inertia > 0; });
  if (!turn && !are_rough) return;
  print_warning(
      fmt::format("{}: angular velocities, {}directors of the spheres are left out: "
                  "those of DynamO do not turn",
                  path, are_rough ? "moments of inertia and " : "and "));
}

// Where a file says nothing of its species, all needles are alike.
void require_known_species(State& state, const io::Material& material, const std::string& path) {
  const std::size_t count = material.species();
  if (count == 1) state.species.clear();
  for (const SpeciesIndex index : state.species) {
    if (index < count) continue;
    throw InputError(
        fmt::format("{}: a needle of species {}: expected an index below {}", path, index, count));
  }
}

// Other formats have no place for a box that walls have moved, or readers that take it to begin at
// 0: positions count from the low edges.
void count_from_low_edges(State& state) {
  for (std::array<double, 3>& position : state.position)
    for (std::size_t axis = 0; axis < 3; ++axis) position[axis] -= state.low[axis];
  state.low = {};
}

void export_frames(const ExportArguments& arguments, const io::ExportFormat& format) {
  const auto file = read_file(arguments.from, FileKind::h5md,
                              [&] { return std::make_unique<io::FrameFile>(arguments.from); });
  const std::string otherwise = format.many ? "all" : "last";
  const FrameRange range =
      chosen_frames(arguments.frame.empty() ? otherwise : arguments.frame, file->count());
  const io::Material material = read_material(arguments.from, format);
  const auto writer = format.open(arguments.to, arguments.force, material);
  if (format.whole_material) warn_of_other_motion(material, arguments.from);
  warn_of_walls(material, arguments.from, format);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    State state = file->read(i);
    require_known_species(state, material, arguments.from);
    count_from_low_edges(state);
    warn_of_turning_spheres(state, material, arguments.from, format);
    writer->add({i, file->time(i), std::move(state)});
  }
  writer->publish();
}

}  // namespace

std::vector<std::string> names_of_export_formats() {
  std::vector<std::string> names;
  for (const io::ExportFormat& format : io::export_formats()) {
    if (names.empty() || names.back() != format.name) names.emplace_back(format.name);
  }
  return names;
}

int run(const ExportArguments& arguments) {
  const std::string& to = arguments.to;
  runs::require_writable(to, arguments.force, to);
  runs::require_other_file(to, arguments.from, to);
  const bool many = arguments.frame == "all";
  const io::ExportFormat* format = io::find_export_format(arguments.format, to, many);
  if (!format) {
    print_error(
        fmt::format("OUT {}: expected a name that ends in {}, or --to", to, endings(false)));
    return bad_usage;
  }
  if (many && !format->many) {
    print_error(
        fmt::format("--frame all: {} holds one frame: expected first, last or a number, or "
                    "a name that ends in {}",
                    format->what, endings(true)));
    return bad_usage;
  }
  if (!io::has_ending_of(*format, to)) {
    print_warning(fmt::format("OUT {}: will be {} nevertheless: expected a name that ends in {}",
                              to, format->what, format->endings.front()));
  }
  export_frames(arguments, *format);
  return ok;
}

}  // namespace needlework::cli
