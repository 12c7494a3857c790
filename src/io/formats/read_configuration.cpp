#include "src/io/formats/read_configuration.h"

#include <fmt/format.h>

#include "needlework/error.h"
#include "src/io/formats/compression.h"
#include "src/io/formats/dynamo.h"
#include "src/io/formats/input_text.h"
#include "src/io/formats/lammps.h"
#include "src/io/formats/lines.h"
#include "src/io/formats/xyz.h"

namespace needlework::io {
namespace {

using FrameNumber = std::optional<std::size_t>;

template <Configuration (*read)(const std::string&)>
Configuration read_only_frame(const std::string& path, FrameNumber frame) {
  if (frame.value_or(0) > 0) refuse_frame(path, *frame, 1);
  return read(path);
}

struct Format {
  bool (*fits)(std::string_view beginning);
  Configuration (*read)(const std::string& path, FrameNumber frame);
};

constexpr Format formats[] = {{is_dynamo, read_only_frame<read_dynamo>},
                              {is_xyz, read_xyz},
                              {is_lammps_dump, read_lammps_dump},
                              {is_lammps_data, read_only_frame<read_lammps_data>}};

// Of the text, decompressed if need be.
std::string beginning_of(const std::string& path) {
  std::string text(4096, '\0');
  text.resize(InputText(path).read(text.data(), text.size()));
  return text;
}

}  // namespace

bool is_configuration(std::string_view beginning) {
  if (compression_of_content(beginning) != Compression::none) return true;
  for (const Format& format : formats) {
    if (format.fits(beginning)) return true;
  }
  return false;
}

Configuration read_configuration(const std::string& path, std::optional<std::size_t> frame) {
  const std::string beginning = beginning_of(path);
  for (const Format& format : formats) {
    if (format.fits(beginning)) return format.read(path, frame);
  }
  throw InputError(fmt::format(
      "{}: expected a configuration of DynamO, extended XYZ, or a dump or data file of LAMMPS",
      path));
}

}  // namespace needlework::io
