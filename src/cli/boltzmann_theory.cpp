#include "src/cli/boltzmann_theory.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "needlework/theory.h"
#include "src/cli/json.h"
#include "src/composition/pair_name.h"
#include "src/machine/available_cores.h"
#include "src/observe/forecast.h"

namespace needlework::cli {
namespace {

using boltzmann::Means, boltzmann::Measured, boltzmann::Pairs, boltzmann::Result, boltzmann::Sample,
    boltzmann::Settings;
using Json = nlohmann::ordered_json;

double initial_t_tr(const Composition& composition) {
  std::vector<theory::Temperatures> each;
  for (const Species& species : composition.species())
    each.push_back({species.t_tr, species.t_rot});
  return theory::mean_of_species(composition, each).t_tr;
}

struct Answer {
  Settings settings;
  std::optional<double> density;
  Result result;
  /// Of kinetic theory, at the same times: of each species, and of all needles.
  std::vector<std::vector<theory::Temperatures>> gaussian;

  const Composition& composition() const { return settings.composition; }
  bool has_encounters() const { return settings.pairs == Pairs::encounters; }
  double share_met_before() const {
    const auto contacts = static_cast<double>(result.met_before + result.encounters);
    return static_cast<double>(result.met_before) / contacts;
  }
  double tau(const Sample& sample) const {
    return sample.tau * tau_scale(initial_t_tr(composition()));
  }
  theory::Temperatures gaussian_of_all(std::size_t n) const {
    return theory::mean_of_species(composition(), gaussian[n]);
  }
};

// What `of` finds in each sample, with its error, under this name.
template <class Of>
void put(Json& json, const std::string& name, const Answer& answer, const Of& of) {
  Json values = Json::array(), errors = Json::array();
  for (const Sample& sample : answer.result.samples) {
    const Measured& found = of(sample);
    values.push_back(number(found.value));
    errors.push_back(number(found.error));
  }
  json[name] = std::move(values);
  json[name + "_error"] = std::move(errors);
}

// Of all needles or of a species, which `means_of` finds in a sample.
template <class MeansOf>
void put_means(Json& json, const Answer& answer, const MeansOf& means_of) {
  for (const auto& [name, member] : {std::pair("t_tr", &Means::t_tr),
                                     {"t_rot", &Means::t_rot},
                                     {"energy", &Means::energy},
                                     {"collisions_per_needle", &Means::collisions},
                                     {"excess_tr", &Means::excess_tr},
                                     {"excess_rot", &Means::excess_rot},
                                     {"excess_mixed", &Means::excess_mixed}}) {
    put(json, name, answer, [&](const Sample& sample) { return means_of(sample).*member; });
  }
}

template <class TemperaturesAt>
Json theory_json(const Answer& answer, const TemperaturesAt& at) {
  Json json;
  for (std::size_t n = 0; n < answer.gaussian.size(); ++n) {
    const theory::Temperatures now = at(n);
    json["t_tr"].push_back(number(now.t_tr));
    json["t_rot"].push_back(number(now.t_rot));
    json["energy"].push_back(number(now.energy()));
  }
  return json;
}

void put_species(Json& json, const Answer& answer) {
  const Composition& composition = answer.composition();
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      put(json["collisions_between"], pair_name(composition, a, b), answer,
          [index = composition.pair_index(a, b)](const Sample& sample) {
            return sample.collisions_between[index];
          });
    }
  }
  for (std::size_t s = 0; s < composition.size(); ++s) {
    Json& of = json["species"][composition[s].name];
    put_means(of, answer, [s](const Sample& sample) { return sample.species[s]; });
    of["theory"] = theory_json(answer, [&](std::size_t n) { return answer.gaussian[n][s]; });
  }
}

Json json_of(const Answer& answer) {
  const Settings& settings = answer.settings;
  Json json{{"pairs", answer.has_encounters() ? "encounters" : "single"}};
  if (!answer.composition().is_mixture()) {
    const Restitution& rule = answer.composition().restitution(0, 0);
    json["epsilon"] = rule.epsilon;
    json["beta"] = rule.beta;
    json["k"] = answer.composition()[0].k;
  }
  json["needles"] = settings.needles;
  json["seed"] = settings.seed;
  if (answer.has_encounters()) json["tc"] = settings.contact_time;
  json["tau"] = Json::array();
  if (answer.density) {
    json["density"] = *answer.density;
    json["time"] = Json::array();
  }
  for (const Sample& sample : answer.result.samples) {
    json["tau"].push_back(answer.tau(sample));
    if (answer.density) json["time"].push_back(sample.tau / theory_time_scale(*answer.density));
  }
  put_means(json, answer, [](const Sample& sample) -> const Means& { return sample; });
  json["theory"] = theory_json(answer, [&](std::size_t n) { return answer.gaussian_of_all(n); });
  if (answer.composition().is_mixture()) put_species(json, answer);
  if (answer.has_encounters()) {
    json["encounters"] = answer.result.encounters;
    json["met_before"] = answer.result.met_before;
    json["tc_collisions"] = answer.result.tc_collisions;
    json["unfinished"] = answer.result.unfinished;
    json["encounters_of"] = answer.result.encounters_of;
  }
  return json;
}

std::string with_error(const Measured& a) {
  return fmt::format("{:.6g} ({:.1g})", a.value, a.error);
}

std::string heading(const Answer& answer) {
  const Settings& settings = answer.settings;
  std::string text;
  if (!answer.composition().is_mixture()) {
    const Restitution& rule = answer.composition().restitution(0, 0);
    text = fmt::format("epsilon {}, beta {}, k {}", rule.epsilon, rule.beta,
                       answer.composition()[0].k);
  } else {
    text = fmt::format("{} species", answer.composition().size());
  }
  text += fmt::format(
      ": Boltzmann equation, {} needles, seed {}, {}\n", settings.needles, settings.seed,
      answer.has_encounters() ? fmt::format("encounters, t_c {:.3g}", settings.contact_time)
                              : "single collisions");
  return text + "In brackets: standard errors. theory: kinetic theory, for Gaussian velocities.\n";
}

// Means of all needles or of a species, and the temperatures of theory, at each time.
template <class MeansOf, class TemperaturesAt>
std::string course_table(const Answer& answer, const MeansOf& means_of, const TemperaturesAt& at) {
  std::string text =
      fmt::format("{}{:>10}  {:>21}  {:>11}  {:>21}  {:>11}  {:>21}  {:>21}\n",
                  answer.density ? fmt::format("{:>12}  ", "time") : "", "tau", "T_tr", "theory",
                  "T_rot", "theory", "energy", "collisions/needle");
  for (std::size_t n = 0; n < answer.gaussian.size(); ++n) {
    const Sample& sample = answer.result.samples[n];
    const Means& means = means_of(sample);
    const theory::Temperatures gaussian = at(n);
    if (answer.density) {
      text += fmt::format("{:>12.6g}  ", sample.tau / theory_time_scale(*answer.density));
    }
    text += fmt::format("{:>10.6g}  {:>21}  {:>11.6g}  {:>21}  {:>11.6g}  {:>21}  {:>21}\n",
                        answer.tau(sample), with_error(means.t_tr), gaussian.t_tr,
                        with_error(means.t_rot), gaussian.t_rot, with_error(means.energy),
                        with_error(means.collisions));
  }
  text += fmt::format("\n{:>10}  {:>21}  {:>21}  {:>21}\n", "tau", "excess of v^4", "excess of w^4",
                      "excess of v^2 w^2");
  for (const Sample& sample : answer.result.samples) {
    const Means& means = means_of(sample);
    text += fmt::format("{:>10.6g}  {:>21}  {:>21}  {:>21}\n", answer.tau(sample),
                        with_error(means.excess_tr), with_error(means.excess_rot),
                        with_error(means.excess_mixed));
  }
  return text;
}

std::string species_tables(const Answer& answer) {
  const Composition& composition = answer.composition();
  std::string text;
  for (std::size_t s = 0; s < composition.size(); ++s) {
    text += fmt::format("\n{}\n", composition[s].name) +
            course_table(
                answer, [s](const Sample& sample) -> const Means& { return sample.species[s]; },
                [&](std::size_t n) { return answer.gaussian[n][s]; });
  }
  text += fmt::format("\n{:<24}  {:>32}\n", "species", "collisions over all needles");
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      const auto& last = answer.result.samples.back().collisions_between;
      text += fmt::format("{:<24}  {:>32}\n", pair_name(composition, a, b),
                          with_error(last[composition.pair_index(a, b)]));
    }
  }
  return text;
}

std::string table_of(const Answer& answer) {
  std::string text = heading(answer) + "\n";
  const bool is_mixture = answer.composition().is_mixture();
  if (is_mixture) text += "all needles\n";
  text += course_table(
      answer, [](const Sample& sample) -> const Means& { return sample; },
      [&](std::size_t n) { return answer.gaussian_of_all(n); });
  if (is_mixture) text += species_tables(answer);
  if (!answer.has_encounters() || answer.result.encounters == 0) return text;
  const auto of = static_cast<double>(answer.result.encounters);
  text += fmt::format("\n{} encounters; of all contacts {:.3g} are not the first of their pair\n",
                      answer.result.encounters, answer.share_met_before());
  if (answer.result.unfinished > 0) {
    text += fmt::format("{} encounters were given up after very many collisions or steps\n",
                        answer.result.unfinished);
  }
  text += fmt::format("\n{:>10}  {:>12}  {:>12}\n", "collisions", "encounters", "share");
  const std::vector<std::uint64_t>& counts = answer.result.encounters_of;
  for (std::size_t n = 0; n < counts.size(); ++n) {
    if (counts[n] == 0) continue;
    const bool last = n + 1 == counts.size();
    text += fmt::format("{:>10}  {:>12}  {:>12.4g}\n", fmt::format("{}{}", n + 1, last ? "+" : ""),
                        counts[n], static_cast<double>(counts[n]) / of);
  }
  return text;
}

// At the same times. One species needs no density.
std::vector<std::vector<theory::Temperatures>> gaussian_of(const Composition& composition,
                                                           std::optional<double> density,
                                                           const std::vector<double>& taus) {
  if (composition.is_mixture()) {
    std::vector<theory::Temperatures> initial;
    for (const Species& each : composition.species()) initial.push_back({each.t_tr, each.t_rot});
    std::vector<double> times;
    for (const double tau : taus) times.push_back(tau / theory_time_scale(density.value()));
    const double volume = static_cast<double>(composition.count()) / density.value();
    return theory::mixture_cooling(composition, volume, initial, times);
  }
  const Restitution& rule = composition.restitution(0, 0);
  std::vector<std::vector<theory::Temperatures>> out;
  for (const theory::Temperatures& now :
       theory::cooling_curve({composition[0].k, rule.epsilon, rule.beta},
                             {composition[0].t_tr, composition[0].t_rot}, taus)) {
    out.push_back({now});
  }
  return out;
}

}  // namespace

double tau_scale(double initial_t_tr) { return initial_t_tr > 0 ? std::sqrt(initial_t_tr) : 1; }

std::string boltzmann_theory_of(const Settings& settings, const std::vector<double>& taus,
                                std::optional<double> density, bool json) {
  std::vector<double> of_theory = taus;
  for (double& tau : of_theory) tau /= tau_scale(initial_t_tr(settings.composition));
  const Answer answer{settings, density,
                      boltzmann::simulate(settings, of_theory, available_cores().usable()),
                      gaussian_of(settings.composition, density, of_theory)};
  return json ? json_text(json_of(answer)) + "\n" : table_of(answer);
}

}  // namespace needlework::cli
