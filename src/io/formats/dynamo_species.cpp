// Species of DynamO and their interactions, of which the first that holds a pair is that of it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "src/io/formats/dynamo_parts.h"
#include "src/io/formats/lines.h"

namespace needlework::io::dynamo {
namespace {

// The mean of two diameters and a decimal that says it are within three roundings of each other.
constexpr double rounding_of_mean = 4 * 0x1p-53;

struct Genus {
  SpeciesOfParticles particles;
  bool of_spheres = false;             // points are the centres of spheres
  std::vector<long double> inertia{};  // of each species for a unit of mass, with digits beyond
                                       // those of a double: only these may lead back to a given k
};

void read_body(const XmlElement& species, Genus& genus, Material& material) {
  species.require_word("Type", {"SphericalTop", "Lines", "Point"},
                       "SphericalTop, Lines or Point: other particles cannot be carried over");
  species.require_only({"Type", "Name", "IntName", "Mass", "InertiaConstant", "Range"},
                       {"IDRange"});
  const bool is_sphere = species.text("Type") == "Point";
  if (material.names.empty()) genus.of_spheres = is_sphere;
  if (is_sphere != genus.of_spheres) {
    species.reject("Type", fmt::format("{}, as of the species before: lines and points never meet",
                                       is_sphere ? "SphericalTop or Lines" : "Point"));
  }
  const std::string name(species.text("Name"));
  if (std::ranges::find(material.names, name) != material.names.end()) {
    species.reject("Name", "one that no other species has");
  }
  genus.particles.add(species, name);
  material.names.push_back(name);
  material.mass.push_back(common_number(species, "Mass"));
  if (!(material.mass.back() > 0)) species.reject("Mass", "a number > 0");
  if (is_sphere) return;
  positive_number(species, "InertiaConstant");
  genus.inertia.push_back(
      std::strtold(std::string(species.text("InertiaConstant")).c_str(), nullptr));
}

Genus read_genus(const XmlElement& simulation, std::size_t particles, Material& material) {
  const XmlElement element = simulation.child("Genus");
  element.require_only({}, {"Species"});
  Genus genus{SpeciesOfParticles(particles)};
  if (!element.first("Species")) element.child("Species");
  for (auto each = element.first("Species"); each; each = each->next()) {
    read_body(*each, genus, material);
  }
  genus.particles.require_all(element);
  return genus;
}

// How two species collide.
struct Contact {
  XmlElement element;
  double size;  // the length of both lines, or the distance of two centres
  double epsilon;
};

class Contacts {
 public:
  Contacts(const XmlElement& simulation, const Genus& genus);

  const Contact& at(std::size_t a, std::size_t b) const { return *all_[a * species_ + b]; }
  double length() const;
  std::vector<double> diameters() const;

 private:
  void read(const XmlElement& interaction);
  std::string names_of(std::size_t a, std::size_t b) const {
    return fmt::format("{} and {}", quotation(genus_.particles.name(a)),
                       quotation(genus_.particles.name(b)));
  }

  const Genus& genus_;
  std::size_t species_;
  const char* size_;
  std::vector<std::optional<Contact>> all_;  // of each two species, in rows
};

Contacts::Contacts(const XmlElement& simulation, const Genus& genus)
    : genus_(genus),
      species_(genus.particles.species()),
      size_(genus.of_spheres ? "Diameter" : "Length"),
      all_(species_ * species_) {
  const XmlElement interactions = simulation.child("Interactions");
  interactions.require_only({}, {"Interaction"});
  if (!interactions.first("Interaction")) interactions.child("Interaction");
  for (auto each = interactions.first("Interaction"); each; each = each->next()) read(*each);
  for (std::size_t a = 0; a < species_; ++a) {
    for (std::size_t b = a; b < species_; ++b) {
      if (all_[a * species_ + b]) continue;
      interactions.reject(
          fmt::format("none of {}: expected one for each two species", names_of(a, b)));
    }
  }
}

void Contacts::read(const XmlElement& interaction) {
  if (genus_.of_spheres) {
    interaction.require_word("Type", {"HardSphere"},
                             "HardSphere, as of points: other interactions cannot be carried over");
  } else {
    interaction.require_word("Type", {"Lines"},
                             "Lines, as of particles that turn: other interactions cannot be "
                             "carried over");
  }
  // A CaptureMap lists which pairs are near each other, and follows from the positions.
  interaction.require_only({"Type", "Name", size_, "Elasticity", "Range"},
                           {"IDPairRange", "CaptureMap"});
  const std::vector<bool> pairs = genus_.particles.in_pair_range(interaction);
  const double size = common_number(interaction, size_);
  if (!(size > 0)) interaction.reject(size_, "a number > 0");
  const Contact contact{interaction, size, elasticity_of(interaction)};
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    if (pairs[n] && !all_[n]) all_[n] = contact;
  }
}

// An interaction has one length for both lines.
double Contacts::length() const {
  const double length = at(0, 0).size;
  for (std::size_t a = 0; a < species_; ++a) {
    for (std::size_t b = a; b < species_; ++b) {
      if (at(a, b).size == length) continue;
      at(a, b).element.reject(
          size_, fmt::format("{} for {}, as for {}: lines that meet have one length", length,
                             names_of(a, b), names_of(0, 0)));
    }
  }
  return length;
}

std::vector<double> Contacts::diameters() const {
  std::vector<double> out;
  for (std::size_t a = 0; a < species_; ++a) out.push_back(at(a, a).size);
  for (std::size_t a = 0; a < species_; ++a) {
    for (std::size_t b = a + 1; b < species_; ++b) {
      const double mean = 0.5 * (out[a] + out[b]);
      if (std::abs(at(a, b).size - mean) <= rounding_of_mean * mean) continue;
      at(a, b).element.reject(
          size_, fmt::format("{}, the mean of {}, the diameters of {}", mean,
                             fmt::format("{} and {}", out[a], out[b]), names_of(a, b)));
    }
  }
  return out;
}

}  // namespace

SpeciesOfParticles read_species(const XmlElement& simulation, std::size_t particles,
                                Configuration& configuration) {
  Material& material = configuration.material;
  Genus genus = read_genus(simulation, particles, material);
  const Contacts contacts(simulation, genus);
  const std::size_t count = genus.particles.species();
  if (genus.of_spheres) {
    material.diameter = contacts.diameters();
    material.length.assign(count, 0);
    material.k.assign(count, Species{}.k);
  } else {
    const double length = contacts.length();
    material.length.assign(count, length);
    const long double square = static_cast<long double>(length) * length;
    for (const long double inertia : genus.inertia) {
      material.k.push_back(static_cast<double>(square / (2 * inertia)));
    }
    if (differ_in_inertia(material)) {
      configuration.notes.push_back(
          "species differ in mass or moment of inertia: DynamO takes both numbers of the first of "
          "two lines for the other one, too; here each has its own");
    }
  }
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) {
      material.epsilon.push_back(contacts.at(a, b).epsilon);
    }
  }
  material.beta = {-1};  // the impulse is normal to both lines
  configuration.state.species = genus.particles.column();
  return std::move(genus.particles);
}

}  // namespace needlework::io::dynamo
