// Which particles, and which pairs of them, elements of DynamO speak of.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/io/formats/dynamo_parts.h"
#include "src/io/formats/lines.h"

namespace needlework::io::dynamo {
namespace {

std::size_t read_id(const XmlElement& element, const char* attribute, std::size_t particles) {
  const double id = element.number(attribute);
  if (!(id >= 0 && id < static_cast<double>(particles) && id == std::floor(id))) {
    element.reject(attribute, fmt::format("the number of one of {} particles, from 0", particles));
  }
  return static_cast<std::size_t>(id);
}

void read_list(const XmlElement& range, std::size_t particles, std::vector<IdInterval>& out) {
  range.require_only({"Type"}, {"ID"});
  for (auto each = range.first("ID"); each; each = each->next()) {
    each->require_only({"val"}, {});
    const std::size_t id = read_id(*each, "val", particles);
    // Ids in a row are one interval.
    if (!out.empty() && out.back().end == id) {
      ++out.back().end;
    } else {
      out.push_back({id, id + 1});
    }
  }
}

void read_single_range(const XmlElement& range, std::size_t particles,
                       std::vector<IdInterval>& out) {
  range.require_word("Type", {"All", "Ranged", "List", "Union"},
                     "All, Ranged, List or Union: other ranges cannot be carried over");
  const std::string_view type = range.text("Type");
  if (type == "List") return read_list(range, particles, out);
  if (type == "All") {
    range.require_only({"Type"}, {});
    if (particles > 0) out.push_back({0, particles});
    return;
  }
  if (type == "Union") {
    range.reject("Type", "All, Ranged or List inside of a union");
  }
  range.require_only({"Type", "Start", "End"}, {});
  const std::size_t start = read_id(range, "Start", particles);
  const std::size_t last = read_id(range, "End", particles);
  if (last < start) range.reject("End", fmt::format("a number >= {}, which is Start", start));
  out.push_back({start, last + 1});
}

std::vector<IdInterval> read_intervals(const XmlElement& range, std::size_t particles) {
  std::vector<IdInterval> out;
  if (range.has("Type") && range.text("Type") == "Union") {
    range.require_only({"Type"}, {"IDRange"});
    for (auto part = range.first("IDRange"); part; part = part->next()) {
      read_single_range(*part, particles, out);
    }
  } else {
    read_single_range(range, particles, out);
  }
  std::ranges::sort(out, {}, &IdInterval::begin);
  for (std::size_t n = 1; n < out.size(); ++n) {
    if (out[n].begin >= out[n - 1].end) continue;
    range.reject(fmt::format("particle {} twice: expected it once", out[n].begin));
  }
  return out;
}

// Where earlier programs had an attribute, it is the only range that is known.
bool has_attribute(const XmlElement& element, const char* range, const char* earlier) {
  if (!element.has("Range")) {
    element.child(range);  // the only one
    return false;
  }
  if (element.first(range)) element.reject("Range", "this or the element, not both");
  element.require_word("Range", {earlier},
                       fmt::format("{}, or an element {}: other ranges as an attribute cannot be "
                                   "carried over",
                                   earlier, range));
  return true;
}

}  // namespace

std::vector<IdInterval> read_range(const XmlElement& element, std::size_t particles) {
  if (!has_attribute(element, "IDRange", "All")) {
    return read_intervals(element.child("IDRange"), particles);
  }
  if (particles == 0) return {};
  return {{0, particles}};
}

void SpeciesOfParticles::add(const XmlElement& element, const std::string& name) {
  const std::size_t index = names_.size();
  if (index == most_species) {
    element.reject(fmt::format("one species more than {}: expected at most as many", most_species));
  }
  names_.push_back(name);
  counts_.push_back(0);
  for (const IdInterval& each : read_range(element, of_.size())) {
    for (std::size_t id = each.begin; id < each.end; ++id) {
      if (of_[id] != most_species) {
        element.reject(fmt::format("particle {} is of {}, too: expected one species for each", id,
                                   quotation(names_[of_[id]])));
      }
      of_[id] = static_cast<SpeciesIndex>(index);
    }
    counts_[index] += each.end - each.begin;
  }
  if (index == 0 || counts_[index] > 0) return;
  element.reject("no particle is of this species: expected some");
}

void SpeciesOfParticles::require_all(const XmlElement& genus) const {
  const auto none = std::ranges::find(of_, most_species);
  if (none == of_.end()) return;
  genus.reject(fmt::format("particle {} is of no species: expected one species for each",
                           none - of_.begin()));
}

std::vector<SpeciesIndex> SpeciesOfParticles::column() const {
  return species() > 1 ? of_ : std::vector<SpeciesIndex>{};
}

std::vector<std::size_t> SpeciesOfParticles::in_range(const XmlElement& element) const {
  return whole_species(element, read_range(element, of_.size()));
}

std::vector<std::size_t> SpeciesOfParticles::whole_species(
    const XmlElement& element, const std::vector<IdInterval>& range) const {
  std::vector<std::size_t> found(species());
  for (const IdInterval& each : range) {
    for (std::size_t id = each.begin; id < each.end; ++id) ++found[of_[id]];
  }
  std::vector<std::size_t> whole;
  for (std::size_t index = 0; index < species(); ++index) {
    if (found[index] == counts_[index]) whole.push_back(index);
    if (found[index] == 0 || found[index] == counts_[index]) continue;
    element.reject(
        fmt::format("a range with {} of {} particles of {}: expected all or none of a "
                    "species",
                    found[index], counts_[index], quotation(names_[index])));
  }
  return whole;
}

std::vector<bool> SpeciesOfParticles::in_pair_range(const XmlElement& element) const {
  const std::size_t count = species();
  std::vector<bool> out(count * count);
  if (has_attribute(element, "IDPairRange", "2All")) return std::vector<bool>(count * count, true);
  const XmlElement pairs = element.child("IDPairRange");
  pairs.require_word("Type", {"All", "Single", "Pair"},
                     "All, Single or Pair: other ranges cannot be carried over");
  const std::string_view type = pairs.text("Type");
  if (type == "All") {
    pairs.require_only({"Type"}, {});
    return std::vector<bool>(count * count, true);
  }
  pairs.require_only({"Type"}, {"IDRange"});
  std::vector<std::vector<std::size_t>> sides;
  for (auto each = pairs.first("IDRange"); each; each = each->next()) {
    sides.push_back(whole_species(*each, read_intervals(*each, of_.size())));
  }
  const std::size_t expected = type == "Pair" ? 2 : 1;
  if (sides.size() != expected) {
    pairs.reject(fmt::format("{} elements IDRange: expected {}", sides.size(), expected));
  }
  for (const std::size_t a : sides.front()) {
    for (const std::size_t b : sides.back()) out[a * count + b] = out[b * count + a] = true;
  }
  return out;
}

}  // namespace needlework::io::dynamo
