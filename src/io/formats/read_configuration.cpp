#include "src/io/formats/read_configuration.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <system_error>

#include "needlework/error.h"
#include "src/io/formats/dynamo.h"
#include "src/io/formats/lammps.h"
#include "src/io/formats/xyz.h"

namespace needlework::io {
namespace {

struct Format {
  bool (*fits)(std::string_view beginning);
  Configuration (*read)(const std::string& path);
};

constexpr Format formats[] = {{is_dynamo, read_dynamo},
                              {is_xyz, read_xyz},
                              {is_lammps_dump, read_lammps_dump},
                              {is_lammps_data, read_lammps_data}};

// Empty for what cannot be read.
std::string beginning_of(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  std::ifstream file(path, std::ios::binary);
  std::string text(4096, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

}  // namespace

bool is_configuration(std::string_view beginning) {
  for (const Format& format : formats) {
    if (format.fits(beginning)) return true;
  }
  return false;
}

Configuration read_configuration(const std::string& path) {
  const std::string beginning = beginning_of(path);
  for (const Format& format : formats) {
    if (format.fits(beginning)) return format.read(path);
  }
  if (beginning.empty()) return read_dynamo(path);  // which says why there is nothing to read
  throw InputError(fmt::format(
      "{}: expected a configuration of DynamO, extended XYZ, or a dump or data file of LAMMPS",
      path));
}

}  // namespace needlework::io
