// Extended XYZ: a line for each needle, and a comment line with the box and the names of the
// columns. https://github.com/libAtoms/extxyz describes the format.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "src/io/formats/configuration.h"
#include "src/io/formats/frame_writer.h"

namespace needlework::io {

/// Whether a file with this beginning can be in this format.
bool is_xyz(std::string_view beginning);

/// Reads a frame, counted from 0, or the last one. It must have Lattice (rectangular, or with a
/// tilt xy) and the columns pos, velo (or velocities, or momenta and masses), director or
/// orientation (a unit vector, or a quaternion x, y, z, w) and angular_velocity; id and masses are
/// optional. Length, mass, k, epsilon and beta are taken from the comment line, or the first two,
/// diameter and moment of inertia from the columns length, masses, diameter and inertia, which may
/// differ within a species. Numbers are not changed, but for what is rounded: see NeedleReader.
/// Throws IoError if the file cannot be read, and InputError, "PATH: line N: reason".
Configuration read_xyz(const std::string& path, std::optional<std::size_t> wanted = {});

/// Writes frames from which read_xyz() reads the same numbers. The chemical species is X. By the
/// columns orientation, a quaternion (x, y, z, w), and aspherical_shape, OVITO draws needles.
std::unique_ptr<FrameWriter> write_xyz(const std::string& path, bool force,
                                       const Material& material);

}  // namespace needlework::io
