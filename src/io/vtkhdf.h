// Export of needles as lines, for ParaView and VTK.
#pragma once

#include <string>

#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework::io {

/// Writes a state as a VTKHDF file of version 1.0. It contains an UnstructuredGrid with one
/// VTK_LINE for each needle, from r - L u/2 to r + L u/2, where L is its length, and with the cell
/// data id, velocity, orientation and angular_velocity. Where there are diameters of the species,
/// the point data `radius` makes a tube of each line; where bodies of a species differ, there are
/// the point data `length` and `mass`. VTK 9.1, ParaView 5.10 and later versions can read it.
/// ParaView recognises the format by the file extension .vtkhdf.
///
/// An existing file is replaced if `force` is true. The file appears under its name when it is
/// complete. Throws IoError, "PATH: reason", if it cannot be written.
void write_vtkhdf(const std::string& path, bool force, const State& state,
                  const std::vector<double>& lengths = {1.0},
                  const std::vector<double>& diameters = {});

}  // namespace needlework::io
