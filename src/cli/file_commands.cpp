#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "src/cli/commands.h"
#include "src/cli/export_command.h"
#include "src/cli/frame_choice.h"
#include "src/cli/import_command.h"
#include "src/cli/info_command.h"
#include "src/cli/options.h"
#include "src/cli/report_command.h"
#include "src/cli/view_command.h"
#include "src/picture/needle_values.h"

namespace needlework::cli {
namespace {

void add_info_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("info", "list what an H5MD file holds");
  const auto arguments = std::make_shared<InfoArguments>();
  command->add_option("FILE.h5", arguments->file, "H5MD file")->required();
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

CLI::Validator frame_choice(bool all) {
  return {[all](const std::string& text) -> std::string {
            if (is_frame_choice(text) && (all || text != "all")) return "";
            return fmt::format("{}: expected a number from 0, first{}", text,
                               all ? ", last or all" : " or last");
          },
          "FRAME"};
}

void add_import_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("import", "make a scene and a state from a foreign file");
  const auto arguments = std::make_shared<ImportArguments>();
  command
      ->add_option("FILE", arguments->from,
                   "configuration of DynamO, extended XYZ, dump or data file of LAMMPS, also with "
                   ".bz2 or .gz")
      ->required();
  command->add_option("--out", arguments->folder, "folder for scene.toml and state.h5")
      ->option_text("DIR")
      ->required();
  command->add_option("--frame", arguments->frame, "which frame, counted from 0 (default: last)")
      ->option_text("N|first|last")
      ->check(frame_choice(false));
  add_force(*command, arguments->force);
  command->footer(
      R"(Nothing is rescaled. What needles do not have is an error that names its place.
Such files have no end of the run: set one in [until] of scene.toml.
docs/formats.md describes all formats.

Examples:
  needlework import config.xml.bz2 --out lines
  needlework run lines/scene.toml --out lines/run.h5)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_export_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("export", "write frames of an H5MD file for another program");
  const auto arguments = std::make_shared<ExportArguments>();
  command->add_option("FILE.h5", arguments->from, "H5MD file")->required();
  command->add_option("OUT", arguments->to, "file to write; its ending is that of its format")
      ->option_text("FILE")
      ->required();
  add_choice(command->add_option("--to", arguments->format, "format, whatever the ending of OUT"),
             names_of_export_formats());
  command
      ->add_option("--frame", arguments->frame,
                   "which frames, counted from 0 (default: all, or the last where a format holds "
                   "one)")
      ->option_text("N|first|last|all")
      ->check(frame_choice(true));
  add_force(*command, arguments->force);
  command->footer(R"(Formats:
  vtkhdf  .vtkhdf             one frame   ParaView and VTK
  pvd     .pvd                all frames  ParaView; one .vtu file for each in a folder beside it
  xyz     .xyz, .extxyz       all frames  extended XYZ: ASE, OVITO
  lammps  .dump, .lammpstrj   all frames  dump of LAMMPS
  lammps  .data, .lmp         one frame   data file of LAMMPS
  dynamo  .xml                one frame   configuration of DynamO

The last four are compressed where .gz or .bz2 follows the ending.

Examples:
  needlework export run.h5 run.pvd
  needlework export run.h5 start.xml.bz2 --frame first)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_report_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("report", "show runs, sweeps and benchmarks in a browser");
  const auto request = std::make_shared<report::Request>();
  command
      ->add_option("FILES", request->files,
                   "H5MD files of runs, summary.h5 of sweeps, results of bench --json")
      ->option_text("FILE...")
      ->required();
  command->add_option("-o,--out", request->out, "page to write")
      ->option_text("FILE.html")
      ->required();
  command->add_option("--title", request->title, "title of the page (default: that of the run)")
      ->option_text("TEXT");
  command->add_option("--needles", request->limits.needles, "most needles shown of a frame")
      ->option_text("N")
      ->check(number_in(1, 1000000))
      ->capture_default_str();
  command->add_option("--frames", request->limits.frames, "most frames shown of a run")
      ->option_text("N")
      ->check(number_in(1, 100000))
      ->capture_default_str();
  add_force(*command, request->force);
  command->footer(
      R"(The page holds its data and needs no network. Of all frames of a run it holds at
most 600000 needles together. docs/report.md says what it shows.

Examples:
  needlework report run.h5 -o run.html
  needlework report sweep/summary.h5 bench.json -o results.html --title Results)");
  command->callback([request, &exit_code] { exit_code = run(*request); });
}

void add_view_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("view", "draw the needles of an H5MD file as PNG or SVG");
  const auto arguments = std::make_shared<ViewArguments>();
  picture::NeedlePicture& picture = arguments->picture;
  command->add_option("FILE.h5", arguments->from, "H5MD file")->required();
  command->add_option("-o,--out", arguments->to, "picture to write")
      ->option_text("FILE.png|FILE.svg")
      ->required();
  command
      ->add_option("--frame,--frames", arguments->frame,
                   "which frame, counted from 0; all writes FILE-00000.png and so on")
      ->option_text("N|first|last|all")
      ->check(frame_choice(true))
      ->capture_default_str();
  command->add_option("--colour,--color", picture.colour, "what colours show: a name listed below")
      ->option_text("NAME")
      ->check(one_of(picture::quantities()))
      ->capture_default_str();
  add_choice(command->add_option("--projection", arguments->projection, "how distance is shown")
                 ->capture_default_str(),
             {"perspective", "orthographic"});
  command
      ->add_option("--azimuth", picture.camera.azimuth,
                   "direction of view: from the x axis towards the y axis")
      ->option_text("DEGREES")
      ->check(number_in(-360.0, 360.0))
      ->capture_default_str();
  command
      ->add_option("--elevation", picture.camera.elevation,
                   "direction of view: above the plane of x and y")
      ->option_text("DEGREES")
      ->check(number_in(-90.0, 90.0))
      ->capture_default_str();
  for (const auto& [name, size] :
       {std::pair{"--width", &picture.width}, {"--height", &picture.height}}) {
    command->add_option(name, *size, "size of the picture, from 300 to 8000")
        ->option_text("PIXELS")
        ->check(number_in(300, 8000))
        ->capture_default_str();
  }
  add_choice(command->add_option("--background", arguments->background, "colour of the background")
                 ->capture_default_str(),
             {"dark", "light"});
  add_force(*command, arguments->force);
  command->footer(
      R"(Needles at a side of the periodic box are drawn whole, with centres inside. Walls
are lattices where they are seen from inside, else outlines. An open side has no
edges; the picture reaches to the needle farthest beyond it.

Colours, in sheared gases of velocities beside the flow:
  speed, spin     over the root mean square
  vx, vy, vz      component of the velocity, over its root mean square
  flow-x, -y, -z  component of the mean velocity in the ball of density, over
                  (T_tr / m)^1/2
  alignment       3 cos^2 - 1 of the angle between needle and velocity
  density         centres in a ball around the needle that holds 30 others in
                  the mean, over that mean
  species         index of the species, from 0
  orientation     angle to the mean axis of all needles, in degrees
  none            all needles alike

Examples:
  needlework view run.h5 -o needles.png
  needlework view run.h5 -o flow.svg --frame first --colour flow-x --background light)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace

void add_file_commands(CLI::App& app, int& exit_code) {
  add_info_command(app, exit_code);
  add_import_command(app, exit_code);
  add_export_command(app, exit_code);
  add_report_command(app, exit_code);
  add_view_command(app, exit_code);
}

}  // namespace needlework::cli
