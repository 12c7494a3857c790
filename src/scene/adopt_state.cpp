#include "src/scene/adopt_state.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "src/scene/check.h"
#include "src/scene/own_bodies.h"
#include "src/scene/printable.h"
#include "src/scene/section.h"
#include "src/scene/validity.h"

namespace needlework {
namespace {

std::string source_of_state(const Scene& scene) {
  return scene.initial.file.empty() ? "the state" : printable(scene.initial.file);
}

bool agrees(double given, double expected) {
  return std::abs(given - expected) <= 1e-12 * std::abs(expected);
}

// In the form in which the scene says it.
std::string key_of_body(const Scene& scene, std::string_view key, std::size_t n) {
  std::string short_form = fmt::format("needles.{}", key);
  const bool is_short = scene.species.empty() || scene.places.contains(short_form);
  return is_short ? short_form : key_of_entry(fmt::format("species.{}", key), n);
}

// Whether the scene says this of a species. One that is built in code says what is not the default.
bool is_said(const Scene& scene, std::string_view key, std::size_t n, bool is_default) {
  if (scene.text.empty()) return !is_default;
  return scene.places.contains(key_of_body(scene, key, n));
}

struct Dimension {
  const char* key;
  std::vector<double> Bodies::*known;
  double Species::*value;
};
constexpr Dimension dimensions[] = {{"length", &Bodies::length, &Species::length},
                                    {"diameter", &Bodies::diameter, &Species::diameter},
                                    {"mass", &Bodies::mass, &Species::mass}};

[[noreturn]] void refuse(const Scene& scene, const std::string& place,
                         const std::string& expected) {
  throw InputError(
      fmt::format("{}: expected {}, as in {}", place, expected, source_of_state(scene)));
}

void require_agreement(const Scene& scene, const char* key, std::size_t n, double given,
                       double expected) {
  if (agrees(given, expected)) return;
  refuse(scene, place_of(scene, key_of_body(scene, key, n), fmt::to_string(given)),
         fmt::to_string(expected));
}

double k_with(double inertia, const Species& body) { return k_of(body.mass, body.length, inertia); }

// What a state says of the k of a body whose other dimensions are known.
std::optional<double> known_k(const Scene& scene, const Species& body, std::size_t n,
                              const Bodies& bodies) {
  const double inertia = n < bodies.inertia.size() ? bodies.inertia[n] : 0;
  const bool is_inertia_known = inertia > 0 && std::isfinite(inertia);
  if (bodies.k.empty())
    return is_inertia_known ? std::optional(k_with(inertia, body)) : std::nullopt;
  const double k = bodies.k[n];
  if (is_inertia_known && !agrees(k_with(inertia, body), k)) {
    throw InputError(fmt::format("{}: inertia = {} of its bodies: expected {}, as with their k",
                                 source_of_state(scene), inertia,
                                 inertia_of_rod(body.mass, body.length, k)));
  }
  return k;
}

// k of a body whose other dimensions are known.
double adopted_k(const Scene& scene, const Species& body, std::size_t n, const Bodies& bodies) {
  const double by_inertia = body.given_inertia ? k_with(*body.given_inertia, body) : 0;
  const bool is_k_said = is_said(scene, "k", n, body.k == Species{}.k);
  if (const auto known = known_k(scene, body, n, bodies)) {
    const double k = *known;
    if (body.given_inertia && !agrees(by_inertia, k)) {
      require_agreement(scene, "inertia", n, *body.given_inertia,
                        inertia_of_rod(body.mass, body.length, k));
    } else if (is_k_said && !body.given_inertia) {
      require_agreement(scene, "k", n, body.k, k);
    }
    return k;
  }
  if (body.given_inertia) return by_inertia;
  return is_k_said || !(body.diameter > 0) ? body.k : homogeneous_k(body.length, body.diameter);
}

// Of a rough sphere. What the scene says, or leaves to the default, has all digits. Fixed ones have
// an infinite one, and that of the scene moves nothing.
void adopt_inertia_of_sphere(const Scene& scene, Species& body, std::size_t n,
                             const Bodies& bodies) {
  const double expected = n < bodies.inertia.size() ? bodies.inertia[n]
                          : n < bodies.q.size() ? inertia_of(bodies.q[n], body.mass, body.diameter)
                                                : 0;
  if (!(expected > 0) || std::isinf(expected)) return;
  if (body.given_inertia)
    return require_agreement(scene, "inertia", n, *body.given_inertia, expected);
  const Species made = scene.composition()[n < scene.species.size() ? n : 0];
  if (made.q > 0 && agrees(made.q, q_of(body.mass, body.diameter, expected))) return;
  body.given_inertia = expected;
}

// Whether bodies are fixed, which files say by an infinite mass. Where the scene is silent, they
// may overlap each other, as they are where they are.
bool adopt_fixed(const Scene& scene, Species& body, std::size_t n, bool expected) {
  if (!scene.species.empty() && body.fixed != expected) {
    refuse(scene, place_of(scene, key_of_entry("species.fixed", n), body.fixed ? "true" : "false"),
           expected ? "true" : "false");
  }
  body.fixed = expected;
  if (scene.species.empty()) body.overlap = expected;
  return expected;
}

// Files of smooth spheres say 0, those of fixed bodies what they like.
void require_inertia(const Scene& scene, const Species& body, double inertia) {
  if (body.fixed) return;
  const char* expected = !(inertia >= 0)                   ? "a number of at least 0"
                         : std::isinf(inertia)             ? "a finite number"
                         : inertia == 0 && body.has_axis() ? "a number above 0"
                                                           : nullptr;
  if (expected) {
    throw InputError(fmt::format("{}: inertia = {} of its bodies: expected {}",
                                 source_of_state(scene), inertia, expected));
  }
}

Species completed(const Scene& scene, Species body, std::size_t n, const Bodies& bodies) {
  if (!bodies.names.empty() && !scene.species.empty() && body.name != bodies.names[n]) {
    const auto quoted = [](const std::string& name) { return '"' + printable(name) + '"'; };
    refuse(scene, place_of(scene, key_of_entry("species.name", n), quoted(body.name)),
           quoted(bodies.names[n]));
  }
  for (const auto& [key, known, value] : dimensions) {
    if ((bodies.*known).empty()) continue;
    const double expected = (bodies.*known)[n];
    if (known == &Bodies::mass && adopt_fixed(scene, body, n, std::isinf(expected))) continue;
    if (is_said(scene, key, n, body.*value == Species{}.*value))
      require_agreement(scene, key, n, body.*value, expected);
    body.*value = expected;
  }
  if (n < bodies.inertia.size()) require_inertia(scene, body, bodies.inertia[n]);
  if (body.has_axis()) {
    body.k = adopted_k(scene, body, n, bodies);
    body.given_inertia.reset();
  } else {
    adopt_inertia_of_sphere(scene, body, n, bodies);
  }
  return body;
}

// Of what a state says whose bodies are alike.
void require_nothing_drawn(const Scene& scene, const Bodies& bodies) {
  for (std::size_t n = 0; n < scene.species.size(); ++n) {
    for (const auto& [key, known, value] : dimensions) {
      const std::vector<double>& numbers = bodies.*known;
      const auto its =
          std::ranges::find(drawn_quantities, std::string_view(key), &DrawnQuantity::name);
      const auto& distribution = scene.species[n].drawn.*its->member;
      if (n >= numbers.size() || !distribution) continue;
      const std::string name = key_of_entry(fmt::format("species.{}", its->keys[0]), n);
      refuse(scene, place_of(scene, name, name_of(distribution->shape)),
             fmt::to_string(numbers[n]));
    }
  }
}

void require_one_number_a_species(const Scene& scene, const Bodies& bodies) {
  for (const auto& [name, size] : {std::pair("names", bodies.names.size()),
                                   {"length", bodies.length.size()},
                                   {"diameter", bodies.diameter.size()},
                                   {"mass", bodies.mass.size()},
                                   {"k", bodies.k.size()},
                                   {"q", bodies.q.size()},
                                   {"inertia", bodies.inertia.size()}}) {
    if (size == 0 || size == bodies.species()) continue;
    throw InputError(
        fmt::format("{}: {} of its bodies: {} of them: expected {}, one for each species",
                    source_of_state(scene), name, size, bodies.species()));
  }
}

void require_as_many_species(const Scene& scene, const Bodies& bodies) {
  const std::size_t given = scene.species.size(), known = bodies.species();
  if (given == 0 || known == 0 || given == known) return;
  std::vector<std::string> names;
  for (const std::string& name : bodies.names) names.push_back(printable(name));
  refuse(scene,
         place_of(scene, key_of_entry("species.name", given - 1),
                  '"' + printable(scene.species.back().name) + '"'),
         fmt::format("{} [[species]]{}{}, not {}", known, names.empty() ? "" : ": ",
                     fmt::join(names, ", "), given));
}

void adopt_counts_of_species(Scene& scene, const State& state) {
  if (scene.species.size() == 1) scene.species.front().count = state.size();
  if (scene.species.size() < 2) return;
  if (state.species.empty()) {
    const std::size_t known = state.bodies.species();
    if (scene.composition().count() == state.size()) return;
    if (known < 2) return;
    throw InputError(fmt::format("{}: {} species: expected one that says which needle is of which",
                                 source_of_state(scene), known));
  }
  std::vector<std::uint64_t> counts(scene.species.size());
  for (const SpeciesIndex index : state.species) {
    if (index >= counts.size()) {
      throw InputError(
          fmt::format("{}: a needle of species {}: expected an index below {}, as there "
                      "are so many [[species]]",
                      source_of_state(scene), index, counts.size()));
    }
    ++counts[index];
  }
  for (std::size_t n = 0; n < counts.size(); ++n) {
    Species& species = scene.species[n];
    if (species.count != 0 && species.count != counts[n]) {
      throw InputError(fmt::format("species.count = {} of {}: expected {}, as in {}", species.count,
                                   species.name, counts[n], source_of_state(scene)));
    }
    species.count = counts[n];
  }
}

void adopt_count_and_box(Scene& scene, const State& state) {
  require_count(scene, state.size());
  Scene::Needles& needles = scene.needles;
  const std::string source = source_of_state(scene);
  const bool given = needles.box != std::array<double, 3>{};
  const auto text = [](const std::array<double, 3>& box) {
    return fmt::format("[{}]", fmt::join(box, ", "));
  };
  if (given && !std::equal(needles.box.begin(), needles.box.end(), state.box.begin(), agrees)) {
    refuse(scene, place_of(scene, "needles.box", text(needles.box)), text(state.box));
  }
  needles.count = state.size();
  adopt_counts_of_species(scene, state);
  needles.box = state.box;
  scene.places.emplace("needles.count", fmt::format("{}: {} needles", source, needles.count));
}

}  // namespace

void require_count(const Scene& scene, std::size_t count) {
  const std::uint64_t given = scene.needles.count;
  if (given == 0 || given == count) return;
  refuse(scene, place_of(scene, "needles.count", fmt::to_string(given)), fmt::to_string(count));
}

void adopt_bodies(Scene& scene, const Bodies& bodies) {
  require_one_number_a_species(scene, bodies);
  require_as_many_species(scene, bodies);
  const bool listed = !scene.species.empty();
  std::vector<Species> all = scene.species;
  if (!listed) {
    Species body;
    body.k = scene.needles.k;
    body.diameter = scene.needles.diameter;
    all.assign(std::max<std::size_t>(1, bodies.species()), body);
  }
  for (std::size_t n = 0; n < all.size(); ++n) {
    all[n] = completed(scene, std::move(all[n]), n, bodies);
    if (listed) continue;
    all[n].name = !bodies.names.empty() ? bodies.names[n]
                  : all.size() == 1     ? "needles"
                                        : fmt::format("needles {}", n + 1);
  }
  // The short form has a length and a mass of 1, and moves.
  const bool is_short = all.size() == 1 && all[0].length == 1 && all[0].mass == 1 && !all[0].fixed;
  if (!listed && is_short) {
    scene.needles.k = all[0].k;
    scene.needles.diameter = all[0].diameter;
  } else {
    scene.species = std::move(all);
  }
}

// Rows that say of each body what its species says, as files of bodies that grow have them.
static void drop_equal_rows(State& state) {
  const Bodies& bodies = state.bodies;
  const auto are_equal = [&](const std::vector<double>& rows, const std::vector<double>& known) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::size_t species = state.species.empty() ? 0 : state.species[i];
      if (species >= known.size() || rows[i] != known[species]) return false;
    }
    return true;
  };
  const OwnBodies& own = state.own_bodies;
  if (are_equal(own.length, bodies.length) && are_equal(own.diameter, bodies.diameter) &&
      are_equal(own.mass, bodies.mass) && are_equal(own.inertia, bodies.inertia))
    state.own_bodies = {};
}

// Bodies with an axis do not turn about it. A file that does not say which have one is checked
// here.
static void require_no_spin_about_axes(const Scene& scene, const State& state) {
  constexpr double tolerance = 1e-6;
  const Composition composition = scene.composition();
  for (std::size_t i = 0; i < state.angular_velocity.size(); ++i) {
    const std::size_t species = state.species.empty() ? 0 : state.species[i];
    if (species >= composition.size() || !composition[species].has_axis()) continue;
    const auto &u = state.orientation[i], &w = state.angular_velocity[i];
    const double along = u[0] * w[0] + u[1] * w[1] + u[2] * w[2],
                 size = std::hypot(w[0], w[1], w[2]);
    if (std::abs(along) <= tolerance * size) continue;
    throw InputError(fmt::format(
        "{}: needle {}: angular velocity ({}, {}, {}), of which {:.4g} is along its director: "
        "expected none, within {} of its length",
        place_of(scene, "initial.file", source_of_state(scene)), state.id.empty() ? i : state.id[i],
        w[0], w[1], w[2], along, tolerance));
  }
}

void adopt_state(Scene& scene, State& state) {
  if (state.scale) drop_equal_rows(state);
  if (state.own_bodies.empty()) require_nothing_drawn(scene, state.bodies);
  adopt_bodies(scene, state.bodies);
  require_ranges(scene, Aspect::bodies);
  require_rules(scene, Aspect::species | Aspect::bodies | Aspect::pairs | Aspect::effects);
  adopt_count_and_box(scene, state);
  adopt_spheres(scene, state);
  if (lacks_numbers(scene, state)) state.own_bodies = all_numbers_of(scene, state);
  add_inertia_of_spheres(scene, state);
  adopt_own_bodies(scene, state);
  require_rules(scene, Aspect::sizes | Aspect::walls);
  if (!scene.initial.file.empty()) require_no_spin_about_axes(scene, state);
  if (scene.places.contains("needles.box")) require_rules(scene, Aspect::room);
}

Bodies bodies_of(const Composition& composition, double scale) {
  Bodies bodies;
  for (const Species& each : composition.species()) {
    if (composition.is_mixture()) bodies.names.push_back(each.name);
    for (const auto& [key, known, value] : dimensions) {
      (bodies.*known)
          .push_back(value == &Species::mass ? each.mass_or_infinity() : each.*value * scale);
    }
    bodies.k.push_back(each.k * (scale * scale));
    bodies.inertia.push_back(each.inertia_or_infinity());
  }
  return bodies;
}

std::string warning_of_unknown_bodies(const Scene& scene, const Bodies& bodies) {
  const Composition composition = scene.composition();
  std::vector<std::string> unknown;
  const auto add_if = [&](bool is_unknown, const char* key) {
    if (is_unknown) unknown.emplace_back(key);
  };
  for (std::size_t n = 0; n < composition.size() && unknown.empty(); ++n) {
    const Species& body = composition[n];
    for (const auto& [key, known, value] : dimensions) {
      const bool is_default = body.*value == Species{}.*value;
      const bool has_none = body.fixed && value == &Species::mass;
      add_if(!has_none && (bodies.*known).empty() && !is_said(scene, key, n, is_default), key);
    }
    const bool is_k_said = is_said(scene, "k", n, body.k == Species{}.k) ||
                           is_said(scene, "inertia", n, true) || !body.has_axis();
    add_if(bodies.k.empty() && bodies.inertia.empty() && !is_k_said, "k");
  }
  if (unknown.empty()) return "";
  return fmt::format(
      "{}: says no {} of its bodies, and neither does the scene: the default is taken",
      place_of(scene, "initial.file", printable(scene.initial.file)), fmt::join(unknown, ", no "));
}

}  // namespace needlework
