#include "src/scene/own_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <tuple>
#include <utility>

#include "needlework/error.h"
#include "src/box/own_numbers.h"
#include "src/machine/stop_request.h"
#include "src/random/needle_random.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

std::uint32_t id_of_row(const State& state, std::size_t row) {
  return state.id.empty() ? static_cast<std::uint32_t>(row) : state.id[row];
}

// The rows in the order of ids.
std::vector<std::size_t> rows_by_id(const State& state) {
  std::vector<std::size_t> rows(state.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  if (!state.id.empty())
    std::ranges::sort(rows, {}, [&](std::size_t row) { return state.id[row]; });
  return rows;
}

void require_numbers(const OwnBodies& bodies, std::size_t count) {
  for (const auto& [what, column] : named_columns(bodies)) {
    if (column->empty() || column->size() == count) continue;
    throw InputError(fmt::format("state: {} rows of {}: expected {}", column->size(), what, count));
  }
}

// The first number that no body of a scene has.
std::optional<WrongBody> wrong_number_of(const BodyNumbers& body) {
  const auto range_of = [](const ValueRange& range) {
    return fmt::format("from {:g} to {:g}{}", range.least, range.greatest,
                       range.or_zero ? ", or 0" : "");
  };
  if (!lengths.holds(body.length)) return WrongBody{0, "length", body.length, range_of(lengths)};
  if (!lengths.holds(body.diameter))
    return WrongBody{0, "diameter", body.diameter, range_of(lengths)};
  if (body.length == 0 && body.diameter == 0)
    return WrongBody{0, "length", body.length,
                     "one above 0, or a diameter, which makes it a sphere"};
  if (!masses.holds(body.mass)) return WrongBody{0, "mass", body.mass, range_of(masses)};
  if (body.length == 0) {
    if (body.inertia == 0 || is_inertia_of_sphere(body)) return {};
    return WrongBody{0, "inertia", body.inertia, expected_inertia_of_sphere};
  }
  const double k = k_of(body.mass, body.length, body.inertia);
  if (range_of_k.holds(k)) return {};
  return WrongBody{0, "inertia", body.inertia,
                   fmt::format("one with which k = m L^2 / (2 I) is {}", range_of(range_of_k))};
}

// `usual` is another body of the species.
void require_in_range(const State& state, std::size_t row, const BodyNumbers& body,
                      const BodyNumbers& usual) {
  const auto refuse = [&](std::string_view what, double value, const std::string& expected) {
    throw InputError(fmt::format("state: needle {}: {} = {}: expected {}", id_of_row(state, row),
                                 what, value, expected));
  };
  if (const auto wrong = wrong_number_of(body))
    refuse(wrong->quantity, wrong->value, wrong->expected);
  const auto compare = [&](std::string_view what, double value, double others) {
    if ((value > 0) == (others > 0)) return;
    refuse(what, value,
           others > 0 ? "a number above 0, as others of its species have"
                      : "0, as for others of its species");
  };
  compare("length", body.length, usual.length);
  compare("diameter", body.diameter, usual.diameter);
}

// Makes the bodies of a species by seed and id.
class BodyMaker {
 public:
  BodyMaker(const Species& species, std::uint64_t seed) : species_(species), seed_(seed) {
    for (std::size_t n = 0; n < drawn_quantities.size(); ++n) {
      const auto& distribution = species.drawn.*drawn_quantities[n].member;
      if (!distribution) continue;
      if (is_spread(*distribution))
        quantiles_[n].emplace(*distribution);
      else
        numbers_[n] = distribution->mean ? distribution->mean : distribution->least;
    }
  }

  // What is known of a body otherwise.
  struct Given {
    std::optional<double> length = {}, diameter = {}, mass = {}, inertia = {};
  };

  // Whether all bodies are alike.
  bool is_one() const {
    return std::ranges::none_of(quantiles_, [](const auto& each) { return each.has_value(); });
  }
  BodyNumbers body(std::uint64_t id) const { return body(id, Given{}); }
  BodyNumbers body(std::uint64_t id, const Given& given) const {
    BodyNumbers out;
    const auto first_of = [](const std::optional<double>& given_number,
                             const std::optional<double>& drawn_number, double otherwise) {
      return given_number ? *given_number : drawn_number.value_or(otherwise);
    };
    out.length = first_of(given.length, drawn(0, id), species_.length);
    out.diameter = first_of(
        given.diameter, species_.drawn.aspect ? out.length / *species_.drawn.aspect : drawn(1, id),
        species_.diameter);
    out.mass =
        first_of(given.mass,
                 species_.drawn.density ? *species_.drawn.density * substance(out) : drawn(2, id),
                 species_.mass);
    if (!(out.length > 0 || species_.q > 0)) {
      out.inertia = 0;
    } else if (given.inertia && (out.length > 0 || *given.inertia > 0)) {
      out.inertia = *given.inertia;
    } else if (const auto inertia = drawn(4, id); inertia || species_.given_inertia) {
      out.inertia = inertia ? *inertia : *species_.given_inertia;
    } else if (out.length == 0) {
      out.inertia = inertia_of(species_.q, out.mass, out.diameter);
    } else {
      out.inertia = inertia_of_rod(out.mass, out.length, drawn_k(out, id));
    }
    return out;
  }

 private:
  static bool is_spread(const Distribution& distribution) {
    if (distribution.shape == Distribution::Shape::powerlaw)
      return distribution.least != distribution.greatest;
    return distribution.width.value_or(0) > 0;
  }
  std::optional<double> drawn(std::size_t quantity, std::uint64_t id) const {
    if (!quantiles_[quantity]) return numbers_[quantity];
    return (*quantiles_[quantity])(NeedleRandom(seed_, id, RandomFor::size, quantity).bits());
  }
  double drawn_k(const BodyNumbers& body, std::uint64_t id) const {
    if (const auto k = drawn(3, id)) return *k;
    const bool is_homogeneous = species_.drawn.homogeneous && body.diameter > 0;
    return is_homogeneous ? homogeneous_k(body.length, body.diameter) : species_.k;
  }
  // What a density counts: the length of a needle, the volume of others.
  static double substance(const BodyNumbers& body) {
    if (body.diameter == 0) return body.length;
    return Species{.length = body.length, .diameter = body.diameter}.volume();
  }

  const Species species_;
  const std::uint64_t seed_;
  std::array<std::optional<Quantiles>, drawn_quantities.size()> quantiles_;
  std::array<std::optional<double>, drawn_quantities.size()> numbers_;
};

// The species that `make` makes, which takes a while, or the same as when it was last asked for.
template <class Make>
Species remembered(const Species& species, std::uint64_t seed, std::uint64_t first,
                   const Make& make) {
  struct Known {
    Species asked;
    std::uint64_t seed, first;
    Species made;
  };
  const auto is_same = [&](const Known& known) {
    const Species& a = known.asked;
    return known.seed == seed && known.first == first && a.drawn == species.drawn &&
           a.count == species.count && a.length == species.length &&
           a.diameter == species.diameter && a.mass == species.mass && a.k == species.k &&
           a.q == species.q && a.given_inertia == species.given_inertia;
  };
  static std::mutex mutex;
  static std::vector<Known> all;
  constexpr std::size_t most = 16;
  {
    const std::lock_guard lock(mutex);
    const auto found = std::ranges::find_if(all, is_same);
    if (found != all.end()) {
      Species out = species;
      const Species& made = found->made;
      out.length = made.length;
      out.diameter = made.diameter;
      out.mass = made.mass;
      out.k = made.k;
      out.q = made.q;
      out.given_inertia.reset();
      out.sizes = made.sizes;
      return out;
    }
  }
  const Species made = make();
  const std::lock_guard lock(mutex);
  if (all.size() == most) all.erase(all.begin());
  all.push_back({species, seed, first, made});
  return made;
}

}  // namespace

bool is_inertia_of_sphere(const BodyNumbers& body) {
  const double q = q_of(body.mass, body.diameter, body.inertia);
  return q >= least_q && q <= greatest_q;
}

BodyNumbers numbers_of(const Species& species) {
  return {species.length, species.diameter, species.mass, species.inertia()};
}

namespace {

// The species of the needle in each row.
std::vector<SpeciesIndex> species_of_rows(const Composition& composition, const State& state) {
  std::vector<SpeciesIndex> by_id = composition.in_order_of_id(state.species);
  const bool is_by_row = !state.species.empty() || state.id.empty();
  if (is_by_row || by_id.size() != state.size()) return by_id;
  std::vector<SpeciesIndex> out(state.size());
  const std::vector<std::size_t> rows = rows_by_id(state);
  for (std::size_t n = 0; n < rows.size(); ++n) out[rows[n]] = by_id[n];
  return out;
}

// The numbers of a row. Those of fixed bodies move nothing; files have infinite ones.
BodyNumbers body_of_row(const OwnBodies& own, std::size_t row, const Species& species) {
  BodyNumbers out = numbers_of(species);
  const auto take = [&](double& to, const std::vector<double>& column) {
    if (!column.empty()) to = column[row];
  };
  take(out.length, own.length);
  take(out.diameter, own.diameter);
  take(out.mass, own.mass);
  take(out.inertia, own.inertia);
  if (species.fixed) {
    if (std::isinf(out.mass)) out.mass = species.mass;
    out.inertia = inertia_of_rod(out.mass, out.length, species.k);
  }
  if (out.length == 0) {
    // Files of smooth spheres say 0.
    if (species.q == 0)
      out.inertia = 0;
    else if (out.inertia == 0)
      out.inertia = inertia_of(species.q, out.mass, out.diameter);
  }
  return out;
}

// Whether the scene says the moments of inertia of a species, by k or by themselves.
bool says_inertia(const Scene& scene, std::size_t n) {
  if (scene.species.empty())
    return scene.text.empty() ? scene.needles.k != Species{}.k : scene.places.contains("needles.k");
  const Species& its = scene.species[n];
  if (its.given_inertia || its.drawn.k || its.drawn.inertia) return true;
  if (scene.text.empty()) return its.k != Species{}.k && !its.drawn.homogeneous;
  return scene.places.contains(key_of_entry("species.k", n));
}

// The species as the scene has them, before means are taken.
std::vector<Species> species_to_draw(const Scene& scene, const OwnBodies& own) {
  const Composition composition = scene.composition();
  std::vector<Species> out = scene.species.empty() ? composition.species() : scene.species;
  for (std::size_t n = 0; n < out.size(); ++n) {
    out[n] = as_drawn(out[n], composition[n]);
    const bool are_shaped = !own.diameter.empty() && own.inertia.empty();
    if (are_shaped && !says_inertia(scene, n)) out[n].drawn.homogeneous = true;
  }
  return out;
}

bool is_complete(const OwnBodies& own) {
  return std::ranges::none_of(named_columns(own),
                              [](const auto& column) { return column.second->empty(); });
}

bool draws(const Scene& scene, const State& state) {
  return state.own_bodies.empty() && state.size() > 0 &&
         std::ranges::any_of(
             scene.species,
             [](const Species& its) { return its.drawn != DrawnSizes{} && !its.sizes; }) &&
         scene.composition().has_own_sizes();
}

}  // namespace

bool lacks_numbers(const Scene& scene, const State& state) {
  return state.own_bodies.empty() ? draws(scene, state) : !is_complete(state.own_bodies);
}

OwnBodies all_numbers_of(const Scene& scene, const State& state) {
  const OwnBodies& own = state.own_bodies;
  if (!lacks_numbers(scene, state)) return own;
  require_numbers(own, state.size());
  const Composition composition = scene.composition();
  const std::vector<SpeciesIndex> species = species_of_rows(composition, state);
  if (composition.size() > 1 && species.size() != state.size()) return own;  // refused elsewhere
  std::vector<BodyMaker> makers;
  for (const Species& each : species_to_draw(scene, own))
    makers.emplace_back(each, scene.needles.seed);
  OwnBodies out;
  for (std::size_t row = 0; row < state.size(); ++row) {
    StopRequest::check_in_turn(row);
    const std::size_t its = composition.size() > 1 ? species[row] : 0;
    if (its >= makers.size()) return own;  // refused elsewhere
    const auto given = [row](const std::vector<double>& column) {
      return column.empty() ? std::nullopt : std::optional(column[row]);
    };
    const BodyNumbers body = makers[its].body(
        id_of_row(state, row),
        {given(own.length), given(own.diameter), given(own.mass), given(own.inertia)});
    out.length.push_back(body.length);
    out.diameter.push_back(body.diameter);
    out.mass.push_back(body.mass);
    out.inertia.push_back(body.inertia);
  }
  return out;
}

std::vector<BodyNumbers> own_bodies_of(const Composition& composition, const State& state) {
  std::vector<BodyNumbers> out;
  if (state.own_bodies.empty()) {
    if (state.size() == 0 || !composition.has_own_sizes()) return out;
    throw InputError(
        "state: no numbers of its bodies: expected length, mass and moment of inertia of each, as "
        "bodies of a species differ");
  }
  require_numbers(state.own_bodies, state.size());
  const std::vector<SpeciesIndex> species = species_of_rows(composition, state);
  if (species.size() != state.size() && composition.size() > 1) return out;  // refused elsewhere
  std::vector<std::optional<BodyNumbers>> usual(composition.size());
  out.reserve(state.size());
  for (std::size_t row = 0; row < state.size(); ++row) {
    const std::size_t its = composition.size() > 1 ? species[row] : 0;
    if (its >= composition.size()) return {};  // refused elsewhere
    out.push_back(body_of_row(state.own_bodies, row, composition[its]));
    if (!usual[its]) usual[its] = out.back();
    require_in_range(state, row, out.back(), *usual[its]);
  }
  return out;
}

Species as_drawn(const Species& given, const Species& made) {
  Species out = given;
  const bool is_rough_sphere = made.turns() && !made.has_axis();
  out.q = !is_rough_sphere ? 0 : given.q > 0 ? given.q : q_of_homogeneous;
  return out;
}

Species completed(const Species& species, std::uint64_t seed, std::uint64_t first) {
  if (species.sizes || species.drawn == DrawnSizes{}) return species;
  const bool is_wrong = std::ranges::any_of(drawn_quantities, [&](const DrawnQuantity& each) {
    const auto& distribution = species.drawn.*each.member;
    return distribution && what_is_wrong(*distribution);
  });
  if (is_wrong) return species;
  const BodyMaker maker(species, seed);
  if (maker.is_one()) {
    Species out = species;
    const BodyNumbers body = maker.body(0);
    out.length = body.length;
    out.diameter = body.diameter;
    out.mass = body.mass;
    out.set_inertia(body.inertia);
    out.given_inertia.reset();
    return out;
  }
  if (species.count == 0) {
    // Without a body whose number this would be, it has the size that one would have.
    Species out = species;
    if (!out.has_axis() && out.diameter == 0) out.diameter = maker.body(first).diameter;
    return out;
  }
  return remembered(species, seed, first, [&] {
    SizesOfBodies sizes;
    for (std::uint64_t n = 0; n < species.count; ++n) {
      StopRequest::check_in_turn(n);
      sizes.add(maker.body(first + n));
    }
    return sizes.complete(species);
  });
}

std::optional<WrongBody> wrong_body_of(const Species& species, std::uint64_t seed,
                                       std::uint64_t first) {
  if (species.sizes || species.drawn == DrawnSizes{} || species.count == 0) return {};
  const BodyMaker maker(species, seed);
  const std::uint64_t count = maker.is_one() ? 1 : species.count;
  for (std::uint64_t n = 0; n < count; ++n) {
    StopRequest::check_in_turn(n);
    if (auto wrong = wrong_number_of(maker.body(first + n))) {
      wrong->id = first + n;
      return wrong;
    }
  }
  return {};
}

std::vector<BodyNumbers> drawn_bodies(const Scene& scene) {
  std::vector<BodyNumbers> out;
  const Composition composition = scene.composition();
  if (!composition.has_own_sizes()) return out;
  out.reserve(composition.count());
  for (std::size_t its = 0; its < scene.species.size(); ++its) {
    const Species species = as_drawn(scene.species[its], composition[its]);
    const BodyMaker maker(species, scene.needles.seed);
    for (std::uint64_t n = 0; n < species.count; ++n) {
      StopRequest::check_in_turn(n);
      out.push_back(maker.body(out.size()));
    }
  }
  return out;
}

Members members_of(const Composition& composition, const State& state) {
  std::vector<SpeciesIndex> species = composition.in_order_of_id(state.species);
  if (!composition.is_mixture()) species.assign(state.size(), 0);
  return {composition, std::move(species), own_bodies_of(composition, state)};
}

Members drawn_members(const Scene& scene) {
  Composition composition = scene.composition();
  std::vector<SpeciesIndex> species = composition.in_order_of_id();
  return {std::move(composition), std::move(species), drawn_bodies(scene)};
}

OwnBodies columns_of(const std::vector<BodyNumbers>& bodies) {
  OwnBodies out;
  for (const BodyNumbers& body : bodies) {
    out.length.push_back(body.length);
    out.diameter.push_back(body.diameter);
    out.mass.push_back(body.mass);
    out.inertia.push_back(body.inertia);
  }
  return out;
}

// Gives a scene in the short form the one species that it has, with the name of that of files.
static void make_explicit(Scene& scene, const Composition& composition) {
  if (!scene.species.empty()) return;
  scene.species = composition.species();
  if (scene.species[0].name.empty()) scene.species[0].name = "needles";
}

void adopt_spheres(Scene& scene, const State& state) {
  const std::vector<double>& length = state.own_bodies.length;
  if (length.size() != state.size() || std::ranges::count(length, 0) == 0) return;
  const Composition composition = scene.composition();
  const std::vector<SpeciesIndex> species = species_of_rows(composition, state);
  if (species.size() != state.size() && composition.size() > 1) return;  // refused elsewhere
  std::vector<bool> are_spheres(composition.size());
  for (std::size_t row = 0; row < length.size(); ++row) {
    const std::size_t its = composition.size() > 1 ? species[row] : 0;
    if (its < are_spheres.size() && length[row] == 0) are_spheres[its] = true;
  }
  make_explicit(scene, composition);
  for (std::size_t n = 0; n < are_spheres.size(); ++n)
    if (are_spheres[n]) scene.species[n].length = 0;
}

void add_inertia_of_spheres(const Scene& scene, State& state) {
  std::vector<double>& inertia = state.own_bodies.inertia;
  if (std::ranges::count(inertia, 0) == 0) return;
  const Composition composition = scene.composition();
  const std::vector<BodyNumbers> bodies = own_bodies_of(composition, state);
  for (std::size_t row = 0; row < bodies.size(); ++row)
    if (inertia[row] == 0) inertia[row] = bodies[row].inertia;
}

void adopt_own_bodies(Scene& scene, const State& state) {
  if (state.own_bodies.empty()) return;
  const Composition composition = scene.composition();
  const std::vector<BodyNumbers> bodies = own_bodies_of(composition, state);
  if (bodies.empty()) return;
  const std::vector<SpeciesIndex> species = species_of_rows(composition, state);
  std::vector<SizesOfBodies> sizes(composition.size());
  for (const std::size_t row : rows_by_id(state))
    sizes[composition.size() > 1 ? species[row] : 0].add(bodies[row]);
  make_explicit(scene, composition);
  for (std::size_t n = 0; n < sizes.size(); ++n) {
    if (sizes[n].count() > 0) scene.species[n] = sizes[n].complete(scene.species[n]);
  }
  if (scene.species.size() == 1) scene.species[0].count = state.size();
}

}  // namespace needlework
