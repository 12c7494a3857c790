// Configuration files of DynamO, the event-driven simulator, with hard lines.
//
// Their format is that of version 1.5.0, https://dynamomd.com/index.php/reference.html. A line is a
// particle of a species that is a spherical top, of which InertiaConstant is the moment of inertia
// for a unit of mass. Its director is the direction into which the quaternion U turns (0, 0, 1);
// its angular velocity O is in the frame of the box, as are position P and velocity V. The box has
// its centre in the origin.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "src/io/formats/configuration.h"
#include "src/io/formats/frame_writer.h"

namespace needlework::io {

/// Whether a text with this beginning can be a configuration, which is XML.
bool is_dynamo(std::string_view beginning);

/// Reads a configuration of lines, or of points with hard spheres, in Newtonian dynamics, with or
/// without gravity, in a box that is periodic along axes without walls. Along axes with walls,
/// positions are counted from the low wall, or so that the high one is at the edge. It may be
/// compressed. Positions, velocities and angular velocities are those of the file bit for bit; a
/// director is within 4 * 2^-53 of that of the quaternion, in each component. Files of earlier
/// programs, in which U is the director itself and ranges are attributes, are read as well. There
/// may be several species, which are numbered in the order of the file: lines of one length, or
/// spheres that touch at the mean of their diameters.
///
/// Throws IoError if the file cannot be read, and InputError, "PATH: line N: ELEMENT ATTRIBUTE =
/// VALUE: expected ...", for text that is not such a configuration and for all that needles do not
/// have: other interactions, ranges that cut species, other boundaries, walls that are oblique,
/// thermostats, numbers that differ between the particles of a species.
Configuration read_dynamo(const std::string& path);

/// Writes one frame as a configuration, in which each particle has its director as an element
/// Director besides. DynamO does not read that; read_dynamo() does, and so reads the same director
/// bit for bit. The material must be complete; see require_complete(). Throws InputError for rods
/// of finite width, needles of several lengths, species whose bodies differ or are fixed, species
/// without needles, walls that move, and open sides that DynamO has no boundary for.
std::unique_ptr<FrameWriter> write_dynamo(const std::string& path, bool force,
                                          const Material& material);

}  // namespace needlework::io
