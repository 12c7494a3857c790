// What the rows of a table say of the bodies of needles: numbers of their species or, where those
// of a species differ, of their own.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "src/io/formats/configuration.h"
#include "src/io/formats/lines.h"

namespace needlework::io {

/// The columns of these numbers, of which any may be absent.
struct BodyPlaces {
  std::optional<std::size_t> length, diameter, mass, k, inertia;
  /// In place of a mass: that of a sphere over its volume, of which the length is the diameter.
  std::optional<std::size_t> density;
};

class BodyColumns {
 public:
  explicit BodyColumns(const BodyPlaces& places) : places_(places) {}

  /// Takes the numbers of the next needle. Throws InputError for one that no body has, and for one
  /// that makes it another kind of body than the first of its species: a sphere, or fixed.
  void read(const Row& row, std::size_t species);

  /// That of the needle which was taken last.
  double length_of(std::size_t species, const Material& material) const {
    return length_.rows.empty() ? number_of(material.length, species, Species{}.length)
                                : length_.rows.back();
  }

  /// Once all needles are read: makes these numbers those of the species, if bodies of a species
  /// are alike, and otherwise those of State::own_bodies, all of them, with means for the species.
  /// Throws InputError where bodies are alike, and not as the material says.
  void settle(Configuration& configuration) const;

 private:
  struct Column {
    const char* name;
    std::vector<double> Material::*of_species;
    std::vector<double> rows = {};
  };
  /// The first needle of a species.
  struct First {
    std::size_t needle;
    Row place;  ///< without fields
  };

  void add(Column& column, const Row& row, double value);
  bool vary(const Column& column) const;
  void adopt(const Column& column, Material& material) const;
  void find_k(Material& material) const;
  OwnBodies all_of(const Material& material) const;
  void adopt_means(const OwnBodies& own, Material& material) const;
  std::vector<double>& sized(std::vector<double>& numbers, const Material& material) const;

  BodyPlaces places_;
  std::vector<std::size_t> species_;         ///< of each needle
  std::vector<std::optional<First>> first_;  ///< by species
  Column length_{"length", &Material::length}, diameter_{"diameter", &Material::diameter},
      mass_{"mass", &Material::mass}, k_{"k", &Material::k},
      inertia_{"inertia", &Material::inertia};
};

}  // namespace needlework::io
