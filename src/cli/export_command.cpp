#include "src/cli/export_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

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
  if (!format.whole_material) return material;
  io::require_complete(material, path);
  if (material.beta && *material.beta != -1) {
    print_warning(
        fmt::format("{}: beta = {} is left out: lines of DynamO are smooth", path, *material.beta));
  }
  return material;
}

void export_frames(const ExportArguments& arguments, const io::ExportFormat& format) {
  const auto file = read_file(arguments.from, FileKind::h5md,
                              [&] { return std::make_unique<io::FrameFile>(arguments.from); });
  const std::string otherwise = format.many ? "all" : "last";
  const FrameRange range =
      chosen_frames(arguments.frame.empty() ? otherwise : arguments.frame, file->count());
  const io::Material material = read_material(arguments.from, format);
  const auto writer = format.open(arguments.to, arguments.force, material);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    writer->add({i, file->time(i), file->read(i)});
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
