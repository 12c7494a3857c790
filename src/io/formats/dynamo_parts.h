// The parts of a configuration of DynamO, each of which has a file.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "needlework/composition.h"
#include "src/io/formats/configuration.h"
#include "src/io/formats/xml.h"

namespace needlework::io::dynamo {

/// What any part reads. All throw InputError, "PATH: line N: ELEMENT ...: expected ...".
std::array<double, 3> read_vector(const XmlElement& parent, const char* name);
std::array<double, 3> vector_of(const XmlElement& element);
double positive_number(const XmlElement& element, const char* attribute);
/// A number that is the same for all particles: masses, lengths and elasticities can also be the
/// names of properties, which differ between particles.
double common_number(const XmlElement& element, const char* attribute);
double elasticity_of(const XmlElement& element);

/// Particles `begin` to `end` - 1.
struct IdInterval {
  std::size_t begin = 0, end = 0;
};

/// The particles of the child IDRange of an element, in order and none twice. In files of earlier
/// programs there is an attribute Range instead, which must be All.
std::vector<IdInterval> read_range(const XmlElement& element, std::size_t particles);

/// Which particle is of which species.
class SpeciesOfParticles {
 public:
  /// For so many particles, none of which has a species yet.
  explicit SpeciesOfParticles(std::size_t particles) : of_(particles, most_species) {}

  /// Adds a species, whose range is in `element`. Throws InputError if one of its particles has
  /// another species.
  void add(const XmlElement& element, const std::string& name);
  /// Throws InputError if a particle has no species or, in a mixture, a species no particle.
  void require_all(const XmlElement& genus) const;

  std::size_t species() const { return names_.size(); }
  const std::string& name(std::size_t index) const { return names_[index]; }
  /// Of State::species.
  std::vector<SpeciesIndex> column() const;

  /// The species whose particles are in the range of an element. Throws InputError if it holds some
  /// particles of a species, but not all.
  std::vector<std::size_t> in_range(const XmlElement& element) const;
  /// For each two species whether a pair range, the child IDPairRange of an element, holds their
  /// pairs, in rows.
  std::vector<bool> in_pair_range(const XmlElement& element) const;

 private:
  std::vector<std::size_t> whole_species(const XmlElement& element,
                                         const std::vector<IdInterval>& range) const;

  std::vector<SpeciesIndex> of_;     // of each particle; most_species: none yet
  std::vector<std::size_t> counts_;  // of each species
  std::vector<std::string> names_;
};

/// Reads Genus and Interactions: the material and the species of so many particles.
SpeciesOfParticles read_species(const XmlElement& simulation, std::size_t particles,
                                Configuration& configuration);

/// Reads BC and Locals: the walls, from which positions along their axes are counted then.
void read_walls(const XmlElement& simulation, const SpeciesOfParticles& species,
                Configuration& configuration);

}  // namespace needlework::io::dynamo
