#include "src/cli/view_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/cli/file_kind.h"
#include "src/cli/frame_choice.h"
#include "src/cli/messages.h"
#include "src/io/atomic_file.h"
#include "src/io/formats/material.h"
#include "src/runs/exit_codes.h"
#include "src/runs/output_path.h"

namespace needlework::cli {

using enum runs::ExitCode;

namespace {

// The file of a frame: of a series "needles-00012.png" for "needles.png".
std::string name_of(const std::string& to, std::size_t frame, bool series) {
  if (!series) return to;
  const std::filesystem::path path(to);
  return (path.parent_path() /
          fmt::format("{}-{:05}{}", path.stem().string(), frame, path.extension().string()))
      .string();
}

void write(const std::string& name, bool force, const std::string& bytes) {
  io::AtomicFile file(name, force);
  std::ofstream out(file.temporary(), std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw IoError(name + ": cannot be written completely: expected room for it");
  file.publish();
}

}  // namespace

int run(const ViewArguments& arguments) {
  const std::string& to = arguments.to;
  const bool is_svg = to.ends_with(".svg");
  if (!is_svg && !to.ends_with(".png")) {
    print_error(fmt::format("--out {}: expected a name that ends in .png or .svg", to));
    return bad_usage;
  }
  const bool series = arguments.frame == "all";
  if (!series) runs::require_writable(to, arguments.force, to);
  const auto file = read_file(arguments.from, FileKind::h5md,
                              [&] { return std::make_unique<io::FrameFile>(arguments.from); });
  const FrameRange range = chosen_frames(arguments.frame, file->count());
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const std::string name = name_of(to, i, series);
    runs::require_writable(name, arguments.force, name);
    runs::require_other_file(name, arguments.from, name);
  }

  picture::NeedlePicture settings = arguments.picture;
  settings.camera.orthographic = arguments.projection == "orthographic";
  settings.dark = arguments.background == "dark";
  const io::Material material = io::read_material(arguments.from);
  settings.lengths = io::lengths_of(material);
  settings.diameters = material.diameter;
  settings.walls = io::single_walls(material.walls);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    settings.time = file->time(i);
    const picture::Drawing drawing = picture::drawing_of(file->read(i), settings);
    write(name_of(to, i, series), arguments.force,
          is_svg ? picture::svg(drawing) : picture::png(drawing));
  }
  return ok;
}

}  // namespace needlework::cli
