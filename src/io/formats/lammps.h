// Files of LAMMPS: data files with one frame, and dump files with many.
//
// Needles are atoms of the style `hybrid sphere dipole`, because that has a direction and an
// angular velocity: the dipole moment is the director, the diameter is the length. Ids are counted
// from 1. Dumps of rods of finite width have both length and diameter; data files have no room for
// the two. https://docs.lammps.org/read_data.html and https://docs.lammps.org/dump.html describe
// the formats.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "src/io/formats/configuration.h"
#include "src/io/formats/frame_writer.h"

namespace needlework::io {

/// Whether a file with this beginning can be a dump, or a data file.
bool is_lammps_dump(std::string_view beginning);
bool is_lammps_data(std::string_view beginning);

/// Reads a frame, counted from 0, or the last one of a dump in text with a box that is rectangular
/// or has a tilt xy (pp, ff between two walls, fs or sf where one side is open) and the columns vx,
/// vy, vz, mux, muy, muz (a unit vector) or a quaternion w, i, j, k, omegax, omegay, omegaz or
/// angmomx, angmomy, angmomz, and one set of positions: x, y, z; scaled xs, ys, zs; unwrapped xu,
/// yu, zu; or both, xsu, ysu, zsu. id, ix, iy, iz, diameter (with a column length: that of rods;
/// else the length of needles), mass (inf of fixed needles), k or inertia, which may differ within
/// a species, and fx, fy, fz are optional; gravity is what gives all needles the same acceleration.
/// Numbers are not changed, except that scaled positions are multiplied by the edges, unwrapped
/// ones are wrapped into the box and counted in the images, and what is rounded is projected as
/// NeedleReader says. Throws IoError if the file cannot be read, and InputError, "PATH: line N:
/// reason".
Configuration read_lammps_dump(const std::string& path, std::optional<std::size_t> wanted = {});
/// Reads a data file with `Atoms # hybrid sphere dipole` and `Velocities`. Length, mass, k, epsilon
/// and beta are taken from the first line, where write_lammps_data() writes them; without a mass
/// there, it follows from the densities, but for a rounding.
Configuration read_lammps_data(const std::string& path);

/// The boundary of an axis as LAMMPS has it: pp, or along an axis that is not periodic f at a wall
/// and s at an open side; ff where the walls are not known.
std::string lammps_boundary(const State& state, const Material& material, std::size_t axis);

/// Writes frames from which the functions above read the same numbers. A dump has the number of the
/// frame as its time step, gravity as forces, and neither times nor k and epsilon; by its
/// quaternion and shape OVITO draws needles.
std::unique_ptr<FrameWriter> write_lammps_dump(const std::string& path, bool force,
                                               const Material& material);
/// Writes one frame. Throws InputError, "PATH: reason", for rods of finite width, fixed bodies, and
/// species with bodies of several k.
std::unique_ptr<FrameWriter> write_lammps_data(const std::string& path, bool force,
                                               const Material& material);

}  // namespace needlework::io
