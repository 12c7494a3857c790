// Frames for ParaView: a collection that lists a VTK file for each frame with its time.
#pragma once

#include <memory>
#include <string>

#include "src/io/formats/frame_writer.h"
#include "src/io/formats/material.h"

namespace needlework::io {

/// Writes NAME.pvd and, in the folder NAME beside it, frame-00000.vtu and so on, and the outline of
/// the box as box-00000.vtu, with a further one only where the box changes.
///
/// A frame is an UnstructuredGrid with one VTK_LINE for each needle, from one end to the other.
/// Both ends have the point data id, speed (of the centre), spin (size of the angular velocity) and
/// species, and where bodies of a species differ length and mass; each line has the cell data
/// velocity, orientation and angular_velocity. Numbers are those of the state. The time of a frame
/// is its number if its file has no times.
///
/// Throws IoError if the collection or the folder exists, unless `force` is true; then files of the
/// same names are replaced, and others in the folder stay. Files that were new are removed if
/// publish() is not reached.
std::unique_ptr<FrameWriter> write_pvd(const std::string& path, bool force,
                                       const Material& material);

}  // namespace needlework::io
