#include "src/cli/mixture_theory.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "needlework/error.h"
#include "needlework/theory.h"
#include "src/cli/json.h"
#include "src/composition/pair_name.h"
#include "src/runs/exact_rates.h"

namespace needlework::cli {
namespace {

using Json = nlohmann::ordered_json;

struct MixturePredictions {
  Composition composition;
  double density;  ///< of all species
  std::vector<theory::Temperatures> initial;
  theory::MixtureRates rates;  ///< at the start
  std::vector<double> times;
  std::vector<std::vector<theory::Temperatures>> curve;  ///< by time, then species
  const char* beyond;  ///< what the theory of cooling does not follow: collisions alone are known

  double volume() const { return static_cast<double>(composition.count()) / density; }
};

// Whether a fluid of these has a pressure that theories know.
bool has_pressure(const MixturePredictions& p) {
  return p.composition.has_width() && !p.composition.has_fixed();
}

// Of rods at low density. Out of equilibrium it would depend on each temperature.
std::optional<double> pressure_of(const MixturePredictions& p) {
  const double t = p.initial.front().t_tr;
  for (std::size_t n = 0; n < p.composition.size(); ++n) {
    const bool turns = p.composition[n].turns();
    if (p.initial[n].t_tr != t || (turns && p.initial[n].t_rot != t)) return std::nullopt;
  }
  if (p.composition.is_inelastic()) return std::nullopt;
  return p.density * t * (1 + p.density * theory::second_virial(p.composition));
}

// The same of spheres at every density of a fluid.
std::optional<double> pressure_of_fluid(const MixturePredictions& p) {
  if (!p.composition.are_spheres() || !pressure_of(p)) return std::nullopt;
  return p.density * p.initial.front().t_tr *
         theory::sphere_compressibility(p.composition, p.volume());
}

// Of one kind, which tend to a ratio of temperatures.
bool are_rough_spheres(const MixturePredictions& p) {
  return p.composition.size() == 1 && p.composition.are_spheres() && p.composition[0].turns();
}

double asymptotic_ratio(const MixturePredictions& p) {
  return theory::asymptotic_ratio_of_spheres(p.composition[0].q, p.composition.restitution(0, 0));
}

Json virial_json(const MixturePredictions& p) {
  const auto pressure = pressure_of(p);
  Json out{{"packing_fraction", number(p.composition.packing_fraction(p.volume()))},
           {"second_virial", number(theory::second_virial(p.composition))},
           {"pressure", pressure ? number(*pressure) : Json()}};
  if (const auto of_fluid = pressure_of_fluid(p)) out["pressure_of_fluid"] = number(*of_fluid);
  return out;
}

std::string virial_line(const MixturePredictions& p) {
  if (!has_pressure(p)) return {};
  const auto pressure = pressure_of(p), of_fluid = pressure_of_fluid(p);
  return fmt::format(
      "  second virial coefficient B = {:.8g}{}{}\n", theory::second_virial(p.composition),
      pressure ? fmt::format(", pressure n T (1 + n B) = {:.8g} at low density", *pressure) : "",
      of_fluid ? fmt::format(", {:.8g} of the fluid", *of_fluid) : "");
}

template <class Value>
Json by_species(const MixturePredictions& p, Value&& value) {
  Json out = Json::object();
  for (std::size_t n = 0; n < p.composition.size(); ++n) {
    out[p.composition[n].name] = value(n);
  }
  return out;
}

// For each of `of`, such as those at each time, what value() makes of it.
template <class All, class Value>
Json each_of(const All& of, Value&& value) {
  Json out = Json::array();
  for (const auto& one : of) out.push_back(number(value(one)));
  return out;
}

Json json_of(const MixturePredictions& p) {
  Json rates = Json::object();
  for (std::size_t a = 0; a < p.composition.size(); ++a) {
    for (std::size_t b = a; b < p.composition.size(); ++b) {
      rates[pair_name(p.composition, a, b)] =
          number(p.rates.collisions[p.composition.pair_index(a, b)]);
    }
  }
  if (p.beyond) {
    Json out{{"collisions_per_time", rates}, {"no_course_of", p.beyond}};
    if (has_pressure(p)) out["rods"] = virial_json(p);
    return out;
  }
  const auto all = [&](const std::vector<theory::Temperatures>& each) {
    return mean_of_species(p.composition, each);
  };
  Json out = {{"collisions_per_time", rates},
              {"t_tr_per_time",
               by_species(p, [&](std::size_t n) { return number(p.rates.temperatures[n].t_tr); })},
              {"t_rot_per_time",
               by_species(p, [&](std::size_t n) { return number(p.rates.temperatures[n].t_rot); })},
              {"time", p.times},
              {"t_tr", each_of(p.curve, [&](const auto& each) { return all(each).t_tr; })},
              {"t_rot", each_of(p.curve, [&](const auto& each) { return all(each).t_rot; })},
              {"energy", each_of(p.curve, [&](const auto& each) { return all(each).energy(); })},
              {"species", by_species(p, [&](std::size_t n) -> Json {
                 return {
                     {"t_tr", each_of(p.curve, [&](const auto& each) { return each[n].t_tr; })},
                     {"t_rot", each_of(p.curve, [&](const auto& each) { return each[n].t_rot; })}};
               })}};
  if (has_pressure(p)) out["rods"] = virial_json(p);
  if (are_rough_spheres(p)) out["c"] = number(asymptotic_ratio(p));
  return out;
}

// The species of the short form has no name.
Composition with_names(Composition composition) {
  if (!composition[0].name.empty()) return composition;
  Species named = composition[0];
  named.name = "needles";
  composition.set_species(0, named);
  return composition;
}

std::string mixture_table(const MixturePredictions& p) {
  std::string text =
      p.composition.has_width() ? "at the start, as at low density\n" : "at the start\n";
  for (std::size_t a = 0; a < p.composition.size(); ++a) {
    for (std::size_t b = a; b < p.composition.size(); ++b) {
      text += fmt::format("  {:<24}{:>14.8g} collisions per time\n", pair_name(p.composition, a, b),
                          p.rates.collisions[p.composition.pair_index(a, b)]);
    }
  }
  if (p.beyond) {
    return text + virial_line(p) +
           fmt::format("\nno course: the theory of a gas that cools does not apply to {}\n",
                       p.beyond);
  }
  for (std::size_t n = 0; n < p.composition.size(); ++n) {
    text +=
        fmt::format("  {:<24}T_tr = {:.6g} changes by {:.6g} per time, T_rot = {:.6g} by {:.6g}\n",
                    p.composition[n].name, p.initial[n].t_tr, p.rates.temperatures[n].t_tr,
                    p.initial[n].t_rot, p.rates.temperatures[n].t_rot);
  }
  text += virial_line(p);
  if (are_rough_spheres(p) && p.composition.is_inelastic())
    text += fmt::format("  T_tr/T_rot tends to c = {:.10g}\n", asymptotic_ratio(p));
  if (p.times.empty()) return text;
  text += fmt::format("\n{:>12}  {:>16}", "time", "energy");
  for (const Species& each : p.composition.species()) {
    text += fmt::format("  {:>16}  {:>16}", "T_tr " + each.name, "T_rot " + each.name);
  }
  text += "\n";
  for (std::size_t i = 0; i < p.times.size(); ++i) {
    text += fmt::format("{:>12.6g}  {:>16.10g}", p.times[i],
                        mean_of_species(p.composition, p.curve[i]).energy());
    for (const theory::Temperatures& each : p.curve[i]) {
      text += fmt::format("  {:>16.10g}  {:>16.10g}", each.t_tr, each.t_rot);
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::string mixture_theory_of(const runs::LoadedScene& loaded, const std::vector<double>& times,
                              bool json) {
  const Composition composition = loaded.scene.composition();
  if (!runs::has_mixture_theory(composition)) {
    throw InputError(fmt::format("{} species: expected at most {}, which theory follows",
                                 composition.size(), theory::most_species_of_theory));
  }
  const double volume = runs::volume_of(loaded.scene);
  MixturePredictions predictions{composition,
                                 static_cast<double>(composition.count()) / volume,
                                 runs::temperatures_by_species(loaded),
                                 {},
                                 times,
                                 {},
                                 runs::beyond_cooling_theory(composition)};
  if (predictions.beyond) {
    predictions.rates.collisions = runs::initial_rates_by_pair(loaded);
  } else {
    predictions.rates = theory::mixture_rates(composition, volume, predictions.initial);
    predictions.curve = theory::mixture_cooling(composition, volume, predictions.initial, times);
  }
  if (json) return json_text(json_of(predictions)) + "\n";
  predictions.composition = with_names(predictions.composition);
  return mixture_table(predictions);
}

}  // namespace needlework::cli
