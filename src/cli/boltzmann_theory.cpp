#include "src/cli/boltzmann_theory.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "src/cli/json.h"
#include "src/machine/available_cores.h"
#include "src/observe/forecast.h"

namespace needlework::cli {
namespace {

using boltzmann::Measured, boltzmann::Pairs, boltzmann::Result, boltzmann::Sample,
    boltzmann::Settings;
using Json = nlohmann::ordered_json;

struct Answer {
  Settings settings;
  std::optional<double> density;
  Result result;
  std::vector<theory::Temperatures> gaussian;  ///< of kinetic theory, at the same times

  bool has_encounters() const { return settings.pairs == Pairs::encounters; }
  double share_met_before() const {
    const auto contacts = static_cast<double>(result.met_before + result.encounters);
    return static_cast<double>(result.met_before) / contacts;
  }
};

Json json_of(const Answer& answer) {
  const Settings& settings = answer.settings;
  Json json{{"pairs", answer.has_encounters() ? "encounters" : "single"},
            {"epsilon", settings.gas.epsilon},
            {"beta", settings.gas.beta},
            {"k", settings.gas.k},
            {"needles", settings.needles},
            {"seed", settings.seed}};
  if (answer.has_encounters()) json["tc"] = settings.contact_time;
  json["tau"] = Json::array();
  if (answer.density) {
    json["density"] = *answer.density;
    json["time"] = Json::array();
  }
  for (const Sample& sample : answer.result.samples) {
    json["tau"].push_back(sample.tau);
    if (answer.density) json["time"].push_back(sample.tau / theory_time_scale(*answer.density));
  }
  for (const auto& [name, member] : {std::pair("t_tr", &Sample::t_tr),
                                     {"t_rot", &Sample::t_rot},
                                     {"energy", &Sample::energy},
                                     {"collisions_per_needle", &Sample::collisions},
                                     {"excess_tr", &Sample::excess_tr},
                                     {"excess_rot", &Sample::excess_rot},
                                     {"excess_mixed", &Sample::excess_mixed}}) {
    Json values = Json::array(), errors = Json::array();
    for (const Sample& sample : answer.result.samples) {
      values.push_back(number((sample.*member).value));
      errors.push_back(number((sample.*member).error));
    }
    json[name] = std::move(values);
    json[std::string(name) + "_error"] = std::move(errors);
  }
  for (const theory::Temperatures& now : answer.gaussian) {
    json["theory"]["t_tr"].push_back(now.t_tr);
    json["theory"]["t_rot"].push_back(now.t_rot);
    json["theory"]["energy"].push_back(now.energy());
  }
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

std::string table_of(const Answer& answer) {
  const Settings& settings = answer.settings;
  std::string text = fmt::format(
      "epsilon {}, beta {}, k {}: Boltzmann equation, {} needles, seed {}, {}\n",
      settings.gas.epsilon, settings.gas.beta, settings.gas.k, settings.needles, settings.seed,
      answer.has_encounters() ? fmt::format("encounters, t_c {:.3g}", settings.contact_time)
                              : "single collisions");
  text += "In brackets: standard errors. theory: kinetic theory, for Gaussian velocities.\n\n";
  text += fmt::format("{}{:>10}  {:>21}  {:>11}  {:>21}  {:>11}  {:>21}  {:>21}\n",
                      answer.density ? fmt::format("{:>12}  ", "time") : "", "tau", "T_tr",
                      "theory", "T_rot", "theory", "energy", "collisions/needle");
  for (std::size_t n = 0; n < answer.gaussian.size(); ++n) {
    const Sample& sample = answer.result.samples[n];
    if (answer.density) {
      text += fmt::format("{:>12.6g}  ", sample.tau / theory_time_scale(*answer.density));
    }
    text += fmt::format("{:>10.6g}  {:>21}  {:>11.6g}  {:>21}  {:>11.6g}  {:>21}  {:>21}\n",
                        sample.tau, with_error(sample.t_tr), answer.gaussian[n].t_tr,
                        with_error(sample.t_rot), answer.gaussian[n].t_rot,
                        with_error(sample.energy), with_error(sample.collisions));
  }
  text += fmt::format("\n{:>10}  {:>21}  {:>21}  {:>21}\n", "tau", "excess of v^4", "excess of w^4",
                      "excess of v^2 w^2");
  for (const Sample& sample : answer.result.samples) {
    text +=
        fmt::format("{:>10.6g}  {:>21}  {:>21}  {:>21}\n", sample.tau, with_error(sample.excess_tr),
                    with_error(sample.excess_rot), with_error(sample.excess_mixed));
  }
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

}  // namespace

std::string boltzmann_theory_of(const Settings& settings, const std::vector<double>& taus,
                                std::optional<double> density, bool json) {
  const Answer answer{settings, density,
                      boltzmann::simulate(settings, taus, available_cores().usable()),
                      theory::cooling_curve(settings.gas, settings.initial, taus)};
  return json ? json_text(json_of(answer)) + "\n" : table_of(answer);
}

}  // namespace needlework::cli
