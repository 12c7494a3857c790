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
  CLI::App* command = app.add_subcommand(
      "import", "make a scene and a state of a configuration of another program");
  const auto arguments = std::make_shared<ImportArguments>();
  command
      ->add_option("FILE", arguments->from,
                   "configuration of DynamO, extended XYZ, or dump or data file of LAMMPS, also "
                   "compressed with bzip2 or gzip")
      ->required();
  command->add_option("--out", arguments->folder, "folder for scene.toml and state.h5")
      ->option_text("DIR")
      ->required();
  command->add_option("--frame", arguments->frame, "first, last or a number from 0; last if absent")
      ->check(frame_choice(false));
  command->add_flag("--force", arguments->force, "replace existing files");
  command->footer(R"(Nothing is rescaled. What needles do not have, such as other interactions,
is an error that names its place. Of several frames the last is taken unless --frame
says which. The end of the run is not in such a file: choose one in [until] of scene.toml.

Examples:
  needlework import config.xml.bz2 --out lines
  needlework run lines/scene.toml --out lines/run.h5)");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_export_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("export", "write frames of an H5MD file in the format of another program");
  const auto arguments = std::make_shared<ExportArguments>();
  command->add_option("FILE.h5", arguments->from, "H5MD file to read")->required();
  command->add_option("OUT", arguments->to, "file to write; its ending is that of its format")
      ->option_text("FILE")
      ->required();
  add_choice(command->add_option("--to", arguments->format, "format, whatever the ending of OUT"),
             names_of_export_formats());
  command
      ->add_option("--frame", arguments->frame,
                   "which frames, counted from 0; by default all, or the last where a format holds "
                   "one")
      ->option_text("N|first|last|all")
      ->check(frame_choice(true));
  command->add_flag("--force", arguments->force, "replace existing files");
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
  CLI::App* command =
      app.add_subcommand("report", "write runs, sweeps and benchmarks as one page for a browser");
  const auto request = std::make_shared<report::Request>();
  command
      ->add_option("FILES", request->files,
                   "H5MD files of runs, summary.h5 of sweeps, results of benchmarks in JSON")
      ->option_text("FILE...")
      ->required();
  command->add_option("-o,--out", request->out, "page to write")
      ->option_text("FILE.html")
      ->required();
  command->add_option("--title", request->title, "title of the page, by default that of the run")
      ->option_text("TEXT");
  command->add_option("--needles", request->limits.needles, "most needles shown of a frame")
      ->option_text("N")
      ->check(number_in(1, 1000000))
      ->capture_default_str();
  command->add_option("--frames", request->limits.frames, "most frames shown of a run")
      ->option_text("N")
      ->check(number_in(1, 100000))
      ->capture_default_str();
  command->add_flag("--force", request->force, "replace an existing page");
  command->footer(R"(The page holds its data and needs no network: charts with a table behind each,
and the needles of the frames in three dimensions. Of long runs it shows a part,
and says so: at most 600000 needles in all frames together.

Examples:
  needlework report run.h5 -o run.html
  needlework report sweep/summary.h5 bench.json -o results.html --title Results)");
  command->callback([request, &exit_code] { exit_code = run(*request); });
}

void add_view_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("view", "draw the needles of an H5MD file, without a display");
  const auto arguments = std::make_shared<ViewArguments>();
  picture::NeedlePicture& picture = arguments->picture;
  command->add_option("FILE.h5", arguments->from, "H5MD file to read")->required();
  command->add_option("-o,--out", arguments->to, "picture to write, PNG or SVG by its ending")
      ->option_text("FILE.png|FILE.svg")
      ->required();
  command
      ->add_option("--frame,--frames", arguments->frame,
                   "which frame, counted from 0; all writes FILE-00000.png and so on")
      ->option_text("N|first|last|all")
      ->check(frame_choice(true))
      ->capture_default_str();
  add_choice(
      command->add_option("--colour,--color", picture.colour, "what the colours of needles show")
          ->capture_default_str(),
      picture::quantities());
  add_choice(command->add_option("--projection", arguments->projection, "how distance is shown")
                 ->capture_default_str(),
             {"perspective", "orthographic"});
  command
      ->add_option("--azimuth", picture.camera.azimuth,
                   "where one looks from: degrees from the x axis towards the y axis")
      ->option_text("DEGREES")
      ->check(number_in(-360.0, 360.0))
      ->capture_default_str();
  command
      ->add_option("--elevation", picture.camera.elevation,
                   "degrees above the plane of x and y, from -90 to 90")
      ->option_text("DEGREES")
      ->check(number_in(-90.0, 90.0))
      ->capture_default_str();
  for (const auto& [name, size] :
       {std::pair{"--width", &picture.width}, {"--height", &picture.height}}) {
    command->add_option(name, *size, "size of the picture in pixels, from 300 to 8000")
        ->option_text("PIXELS")
        ->check(number_in(300, 8000))
        ->capture_default_str();
  }
  add_choice(command->add_option("--background", arguments->background, "colour of the ground")
                 ->capture_default_str(),
             {"dark", "light"});
  command->add_flag("--force", arguments->force, "replace existing files");
  command->footer(R"(Needles are drawn whole where they reach across a side of the periodic box,
with their centres inside. Far ones are thinner and closer to the ground.
Walls are lattices where one looks at them from inside, else outlines, at the
place of that time. A side that is open has no edges, and the picture reaches to
the needle that is farthest beyond it.

Colours:
  speed, spin  speed and angular speed, as multiples of the root mean square
  vx, vy, vz   a component of the velocity, as a multiple of its root mean square
  flow-x, ...  a component of the mean velocity of a needle and those in the ball
               of density, in units of (T_tr / m)^1/2
  alignment    3 cos^2 - 1 of the angle between needle and velocity
  density      centres in a ball around the centre that holds 30 others in the
               mean, as a multiple of that mean
  none         all needles alike

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
