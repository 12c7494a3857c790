// Reads the files of other programs, whose format shows in their first lines.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "src/io/formats/configuration.h"

namespace needlework::io {

/// Whether a file with this beginning is in one of the formats that are read, or compressed, so
/// that only reading it tells.
bool is_configuration(std::string_view beginning);

/// Reads a configuration of DynamO, a data file of LAMMPS, or a frame of an extended XYZ file or of
/// a dump of LAMMPS, counted from 0; without a number the last one. Throws IoError if the file
/// cannot be read, and InputError, "PATH: PLACE: reason", for content that cannot be used. The
/// message may quote it with its control characters.
Configuration read_configuration(const std::string& path, std::optional<std::size_t> frame = {});

}  // namespace needlework::io
