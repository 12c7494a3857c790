// What H5MD files say of their bodies.
#pragma once

#include <cstddef>

#include "needlework/state.h"
#include "src/io/source.h"

namespace needlework::io {

/// The bodies of a file, as /parameters describes them: length, mass, k, diameter, inertia, of each
/// species
/// in a mixture, and then the names, species. Where that has no mass, it is that of the particles.
/// What has the attribute `assumed` is left out: the file that
/// it was imported from does not say it. Throws InputError, "PATH: /DATASET...: expected ...", for
/// numbers that no body has.
Bodies read_bodies(const Source& source);

/// Whether each needle has numbers of its own: the particles then have a length.
bool has_own_bodies(const Source& source);
/// These numbers, none where those of a species are the same. Throws InputError for other than one
/// number for each, or numbers that no body has.
OwnBodies read_own_bodies(const Source& source, std::size_t needles);

/// The mass of the particles of each species, 0 of a species without any; nothing if the file does
/// not hold masses. Throws InputError if those of a species differ.
std::vector<double> masses_by_species(const Source& source);

/// Makes the bodies of a state larger by this factor of growth, with numbers of each needle, as
/// whoever has read those of the species from the file has them as at the start.
void enlarge(State& state, double scale);

}  // namespace needlework::io
