// Needles as lines, for ParaView and VTK.
#pragma once

#include <string>

#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework::io {

/// Writes a state as a VTKHDF file, version 1.0: an UnstructuredGrid with one VTK_LINE for each
/// needle, from r - u/2 to r + u/2 around the centre as given, and with the cell data id, velocity,
/// orientation and angular_velocity. Opens in VTK 9.1 and ParaView 5.10 and later; ParaView goes by
/// the extension .vtkhdf.
///
/// An existing file is replaced if `force`; the file appears complete or not at all. Throws
/// IoError, "PATH: reason", if it cannot be written.
void write_vtkhdf(const std::string& path, bool force, const State& state);

}  // namespace needlework::io
