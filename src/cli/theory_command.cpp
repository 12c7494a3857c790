#include "src/cli/theory_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "needlework/diffusion.h"
#include "needlework/error.h"
#include "needlework/theory.h"
#include "src/cli/boltzmann_theory.h"
#include "src/cli/json.h"
#include "src/cli/messages.h"
#include "src/cli/mixture_theory.h"
#include "src/cli/scene_arguments.h"
#include "src/composition/sizes.h"
#include "src/observe/forecast.h"
#include "src/runs/exit_codes.h"
#include "src/runs/explanation.h"
#include "src/runs/loaded_scene.h"
#include "src/scene/confinement.h"

namespace needlework::cli {

using enum runs::ExitCode;

namespace {

constexpr double not_computed = std::numeric_limits<double>::quiet_NaN();
constexpr double largest = std::numeric_limits<double>::max();

/// An option that takes numbers, and which.
struct NumberOption {
  const char* name;
  double least, most;
  const char* expectation;
};

constexpr NumberOption epsilon_option{"--epsilon", 0.0, 1.0, "a number in [0, 1]"};
constexpr NumberOption beta_option{"--beta", -1.0, 1.0, "a number in [-1, 1]"};
constexpr NumberOption k_option{"--k", 1e-12, 1e12, "a number in [1e-12, 1e12]"};
constexpr NumberOption q_option{"--q", least_q, greatest_q,
                                "a number in [1e-9, 2/3], at which all mass is at the surface"};
constexpr NumberOption t_rot0_option{"--t-rot0", 0.0, largest, "a finite number, 0 or more"};
constexpr NumberOption tau_option{"--tau", 0.0, largest, "a finite number, 0 or more"};
constexpr NumberOption time_option{"--time", 0.0, largest, "a finite number, 0 or more"};
constexpr NumberOption density_option{"--density", 0.0, 1e12, "a number in [0, 1e12]"};
constexpr NumberOption density_of_spheres_option{
    "--density", 0.0, std::numbers::sqrt2,
    "a number in [0, 2^1/2], as spheres of diameter 1 are never denser"};
constexpr NumberOption needles_option{"--needles", 64, 1e9, "a number from 64 to 1e9"};
constexpr NumberOption seed_option{"--seed", 0, 0x1p53, "a whole number from 0 to 2^53"};
constexpr NumberOption tc_option{"--tc", 0.0, largest, "a finite number, 0 or more"};

/// What the predictions are for.
struct Question {
  theory::Gas gas;
  std::optional<double> q;  ///< of rough spheres, of diameter 1, which have no k
  theory::Temperatures initial;
  std::optional<double> density;  ///< [L^-3]
  std::vector<double> taus;

  double scale() const { return tau_scale(initial.t_tr); }
  double tau_at(double time) const { return theory_time_scale(*density) * scale() * time; }
};

struct Predictions : Question {
  double ratio;            ///< T_tr / T_rot in the end, NaN in an elastic gas
  double equipartition_k;  ///< NaN for rough bodies, where it depends on epsilon and beta
  std::vector<theory::Temperatures> curve;
  std::vector<double> collisions;  ///< per needle

  std::optional<theory::Transport> transport;  ///< of smooth elastic needles of a known density

  double time(std::size_t i) const { return taus[i] / (theory_time_scale(*density) * scale()); }
};

double number_of(const NumberOption& option, std::string_view text) {
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_number = error == std::errc() && end == digits.data() + digits.size();
  if (!is_number || !(value >= option.least && value <= option.most)) {
    throw std::invalid_argument(
        fmt::format("{} {}: expected {}", option.name, text, option.expectation));
  }
  return value;
}

// The option's number, or else the scene's; without both it is missing.
double choose(const NumberOption& option, const std::optional<std::string>& text,
              const std::optional<double>& of_scene) {
  if (text) return number_of(option, *text);
  if (of_scene) return *of_scene;
  throw std::invalid_argument(
      fmt::format("{} is missing: expected {}, or a scene (see needlework "
                  "theory --help)",
                  option.name, option.expectation));
}

// Those who ask for rough spheres without a scene ask for nothing of needles.
void require_spheres(const TheoryArguments& arguments) {
  if (!arguments.q) return;
  const auto refuse = [&](const char* expected) {
    throw std::invalid_argument(fmt::format("--q {}: expected {}", *arguments.q, expected));
  };
  if (!arguments.scene.empty()) refuse("none beside a scene, which says what its bodies are");
  if (arguments.k) refuse("either --q or --k, not both: spheres or needles");
  if (!arguments.boltzmann.empty()) refuse("none beside --boltzmann, which simulates thin needles");
  if (!arguments.beta || number_of(beta_option, *arguments.beta) == -1)
    refuse("--beta above -1 beside it, as nothing turns smooth spheres");
}

// By decades, from a tenth of the mean free time to the end that is expected, or five decades on.
std::vector<double> usual_times(const runs::Explanation& scene) {
  if (!std::isfinite(scene.mean_free_time)) return {};
  const double first = std::floor(std::log10(scene.mean_free_time));
  double last = first + 5;
  if (scene.expected && std::isfinite(scene.expected->time) && scene.expected->time > 0) {
    last = std::max(first, std::ceil(std::log10(scene.expected->time)));
  }
  std::vector<double> times{0};
  for (double decade = first; decade <= last; ++decade) times.push_back(std::pow(10, decade));
  return times;
}

// Takes out of the values of an option what is a scene: these options take all that follows them.
void take_scene(std::vector<std::string>& values, std::string& scene) {
  if (!scene.empty() || values.empty() || !values.back().ends_with(".toml")) return;
  scene = values.back();
  values.pop_back();
}

Question question_of(const TheoryArguments& arguments,
                     const std::optional<runs::LoadedScene>& loaded) {
  Question question;
  std::optional<double> epsilon, k, beta = -1.0, t_tr = 1.0, t_rot = 1.0;
  std::vector<double> usual;
  if (loaded) {
    const runs::Explanation scene(*loaded);
    const Composition composition = loaded->scene.composition();
    epsilon = composition.restitution(0, 0).epsilon;
    beta = composition.restitution(0, 0).beta;
    k = composition[0].k;
    t_tr = scene.initial.t_tr;
    t_rot = scene.initial.t_rot;
    question.density = runs::theory_density_of(loaded->scene);
    usual = usual_times(scene);
  } else if (!arguments.overrides.empty()) {
    throw std::invalid_argument(
        fmt::format("--set {}: expected a scene that it changes", arguments.overrides[0]));
  }
  question.gas.epsilon = choose(epsilon_option, arguments.epsilon, epsilon);
  if (arguments.q)
    question.q = number_of(q_option, *arguments.q);
  else
    question.gas.k = choose(k_option, arguments.k, k);
  question.gas.beta = choose(beta_option, arguments.beta, beta);
  question.initial = {.t_tr = *t_tr, .t_rot = choose(t_rot0_option, arguments.t_rot0, t_rot)};
  if (arguments.density) {
    question.density =
        number_of(question.q ? density_of_spheres_option : density_option, *arguments.density);
  }
  for (const std::string& tau : arguments.taus) {
    question.taus.push_back(number_of(tau_option, tau));
  }
  for (const std::string& time : arguments.times) {
    const double value = number_of(time_option, time);
    if (!question.density) {
      throw std::invalid_argument(fmt::format(
          "--time {}: expected --density N beside it, or a scene: tau = (2/3) sqrt(pi) n t, times "
          "the root of the initial T_tr",
          time));
    }
    question.taus.push_back(question.tau_at(value));
  }
  if (question.taus.empty()) {
    for (const double time : usual) question.taus.push_back(question.tau_at(time));
  }
  return question;
}

Predictions predictions_of_spheres(const Question& question) {
  const Restitution rule{question.gas.epsilon, question.gas.beta};
  Predictions result{
      question, theory::asymptotic_ratio_of_spheres(*question.q, rule), not_computed, {}, {}, {}};
  const Composition spheres({{.count = 2, .length = 0, .diameter = 1, .q = *question.q}}, rule);
  // Each has one partner, at the density at which tau is the time.
  theory::MixtureCurve curve(spheres, theory_time_scale(1), std::array{question.initial});
  std::vector<std::size_t> order(question.taus.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t n) { return question.taus[n]; });
  result.curve.resize(order.size());
  result.collisions.resize(order.size());
  for (const std::size_t n : order) {
    result.curve[n] = theory::mean_of_species(spheres, curve.at(question.taus[n]));
    result.collisions[n] = curve.collisions_per_needle();
  }
  return result;
}

Predictions predictions_of(const TheoryArguments& arguments,
                           const std::optional<runs::LoadedScene>& loaded) {
  const Question question = question_of(arguments, loaded);
  if (question.q) return predictions_of_spheres(question);
  Predictions result{question, not_computed, not_computed, {}, {}, {}};
  result.ratio = theory::asymptotic_ratio(result.gas);
  if (result.gas.beta == -1.0) result.equipartition_k = theory::equipartition_k();
  const bool is_elastic = result.gas.epsilon == 1 && result.gas.beta == -1;
  const double temperature = result.initial.energy() / 2.5;
  if (is_elastic && result.density && temperature > 0) {
    result.transport = theory::uncorrelated_transport(*result.density, temperature, result.gas.k);
  }
  std::vector<double> scaled = result.taus;
  for (double& tau : scaled) tau /= result.scale();
  result.curve = theory::cooling_curve(result.gas, result.initial, scaled);
  result.collisions = theory::collisions_per_needle(result.gas, result.initial, scaled);
  return result;
}

/// NaN becomes null, and numbers keep all their digits.
std::string json_of(const Predictions& predictions) {
  nlohmann::ordered_json json{{"epsilon", predictions.gas.epsilon}, {"beta", predictions.gas.beta}};
  if (predictions.q)
    json["q"] = *predictions.q;
  else
    json["k"] = predictions.gas.k;
  json["c"] = number(predictions.ratio);
  if (!predictions.q) json["k_star"] = number(predictions.equipartition_k);
  json["tau"] = predictions.taus;
  std::vector<double> t_tr, t_rot, energy, times;
  for (std::size_t i = 0; i < predictions.taus.size(); ++i) {
    t_tr.push_back(predictions.curve[i].t_tr);
    t_rot.push_back(predictions.curve[i].t_rot);
    energy.push_back(predictions.curve[i].energy());
    if (predictions.density) times.push_back(predictions.time(i));
  }
  json["t_tr"] = t_tr;
  json["t_rot"] = t_rot;
  json["energy"] = energy;
  if (predictions.density) {
    json["density"] = *predictions.density;
    json["time"] = times;
    json["collisions_per_needle"] = predictions.collisions;
  }
  if (predictions.transport) {
    const theory::Transport& transport = *predictions.transport;
    json["diffusion"] = {{"d", number(transport.diffusion)},
                         {"d_rot", number(transport.rotational_diffusion)},
                         {"velocity_decay", transport.velocity_decay},
                         {"angular_velocity_decay", transport.angular_velocity_decay}};
  }
  return json_text(json) + "\n";
}

std::string table_text(const Predictions& predictions) {
  const theory::Gas& gas = predictions.gas;
  std::string text = fmt::format("epsilon {}, beta {}, ", gas.epsilon, gas.beta);
  text += predictions.q ? fmt::format("q {}", *predictions.q) : fmt::format("k {}", gas.k);
  if (predictions.density) text += fmt::format(", density {:.6g}", *predictions.density);
  text += std::isnan(predictions.ratio)
              ? std::string("\nelastic: T_tr/T_rot tends to 1, and nothing cools\n")
              : fmt::format("\nT_tr/T_rot tends to c = {:.10g}\n", predictions.ratio);
  if (!std::isnan(predictions.equipartition_k)) {
    text += fmt::format("c = 1, equipartition, for every epsilon at k = {:.10g}\n",
                        predictions.equipartition_k);
  }
  if (predictions.transport) {
    text += fmt::format(
        "in equilibrium, without correlations: D = {:.10g}, D_rot = {:.10g}\n"
        "<v(0).v(t)> decays at the rate {:.10g} at first, <w(0).w(t)> at {:.10g}\n",
        predictions.transport->diffusion, predictions.transport->rotational_diffusion,
        predictions.transport->velocity_decay, predictions.transport->angular_velocity_decay);
  }
  if (predictions.taus.empty()) return text;

  text += fmt::format("\n{}{:>16}  {:>16}  {:>16}  {:>16}\n",
                      predictions.density ? fmt::format("{:>12}  ", "time") : "", "tau", "T_tr",
                      "T_rot", "energy");
  for (std::size_t i = 0; i < predictions.taus.size(); ++i) {
    const theory::Temperatures& now = predictions.curve[i];
    if (predictions.density) text += fmt::format("{:>12.6g}  ", predictions.time(i));
    text += fmt::format("{:>16.10g}  {:>16.10g}  {:>16.10g}  {:>16.10g}\n", predictions.taus[i],
                        now.t_tr, now.t_rot, now.energy());
  }
  return text;
}

// Of a mixture: all but the times comes from the scene.
std::vector<double> times_of_mixture(const TheoryArguments& arguments,
                                     const runs::LoadedScene& loaded) {
  const auto refuse = [](const char* option, const std::string& value) {
    throw std::invalid_argument(
        fmt::format("{} {}: expected none beside a scene of several species", option, value));
  };
  for (const auto& [option, value] : {std::pair(&epsilon_option, &arguments.epsilon),
                                      {&beta_option, &arguments.beta},
                                      {&k_option, &arguments.k},
                                      {&t_rot0_option, &arguments.t_rot0},
                                      {&density_option, &arguments.density}}) {
    if (*value) refuse(option->name, **value);
  }
  if (!arguments.taus.empty()) refuse("--tau", arguments.taus.front());
  if (const char* beyond = runs::beyond_cooling_theory(loaded.scene.composition())) {
    if (arguments.times.empty()) return {};
    throw std::invalid_argument(fmt::format(
        "--time {}: expected none, as the theory of a gas that cools does not apply to {}",
        arguments.times.front(), beyond));
  }
  std::vector<double> times;
  for (const std::string& time : arguments.times) times.push_back(number_of(time_option, time));
  return times.empty() ? usual_times(runs::Explanation(loaded)) : times;
}

/// A gas to simulate.
struct Simulated {
  Composition composition;
  std::optional<double> density;  ///< [L^-3]
  std::vector<double> taus;
  double rate_of_scene = not_computed;  ///< collisions per needle and time, at T_tr = 1
};

// The same gas with these temperatures of its species.
Composition at_temperatures(const Composition& composition,
                            const std::vector<theory::Temperatures>& temperatures) {
  std::vector<Species> species = composition.species();
  for (std::size_t n = 0; n < species.size(); ++n) {
    species[n].t_tr = temperatures[n].t_tr;
    species[n].t_rot = temperatures[n].t_rot;
  }
  Composition out(std::move(species), {});
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      out.set_restitution(a, b, composition.restitution(a, b));
      out.set_meets(a, b, composition.meets(a, b));
    }
  }
  return out;
}

Simulated mixture_of(const TheoryArguments& arguments, const runs::LoadedScene& loaded) {
  const Composition composition = loaded.scene.composition();
  if (composition.has_width()) {
    throw std::invalid_argument(
        fmt::format("--boltzmann {}: expected a scene of thin needles, not of rods of finite width",
                    arguments.boltzmann));
  }
  if (const char* beyond = runs::beyond_cooling_theory(composition)) {
    throw std::invalid_argument(
        fmt::format("--boltzmann {}: expected a scene without {}", arguments.boltzmann, beyond));
  }
  if (!runs::has_mixture_theory(composition)) {
    throw InputError(fmt::format("{} species: expected at most {}, which theory follows",
                                 composition.size(), theory::most_species_of_theory));
  }
  const double volume = runs::volume_of(loaded.scene);
  const auto count = static_cast<double>(composition.count());
  const auto initial = runs::temperatures_by_species(loaded);
  const double t_tr = theory::mean_of_species(composition, initial).t_tr;
  Simulated out{
      .composition = at_temperatures(composition, initial), .density = count / volume, .taus = {}};
  for (const double time : times_of_mixture(arguments, loaded)) {
    out.taus.push_back(theory_time_scale(*out.density) * tau_scale(t_tr) * time);
  }
  double collisions = 0;
  for (const double each : theory::mixture_rates(composition, volume, initial).collisions) {
    collisions += each;
  }
  out.rate_of_scene = 2 * collisions / count / std::sqrt(t_tr);
  return out;
}

Simulated gas_of(const TheoryArguments& arguments, const std::optional<runs::LoadedScene>& loaded) {
  const Question question = question_of(arguments, loaded);
  Simulated out{boltzmann::one_species(question.gas, question.initial), question.density,
                question.taus};
  if (loaded) {
    const theory::Temperatures scaled{1, question.initial.t_rot / question.initial.t_tr};
    out.rate_of_scene =
        theory::collision_rate(runs::density_of(loaded->scene), scaled, question.gas.k);
  }
  return out;
}

// The contact time of the scene in units of L (m / T_tr)^1/2.
std::optional<double> contact_time_of(const Scene& scene, double rate) {
  if (scene.collisions.tc) {
    throw std::invalid_argument(
        fmt::format("--tc is missing: expected a number, as collisions.tc = {:g} does not follow "
                    "the temperature",
                    *scene.collisions.tc));
  }
  if (!scene.collisions.tc_relative) return std::nullopt;
  return *scene.collisions.tc_relative / rate;
}

std::string boltzmann_text(const TheoryArguments& arguments,
                           const std::optional<runs::LoadedScene>& loaded) {
  Simulated gas = loaded && !loaded->scene.composition().is_needle_gas()
                      ? mixture_of(arguments, *loaded)
                      : gas_of(arguments, loaded);
  boltzmann::Settings settings{.composition = gas.composition};
  if (arguments.boltzmann == "encounters") settings.pairs = boltzmann::Pairs::encounters;
  if (arguments.tc) {
    settings.contact_time = number_of(tc_option, *arguments.tc);
  } else if (loaded && settings.pairs == boltzmann::Pairs::encounters) {
    settings.contact_time =
        contact_time_of(loaded->scene, gas.rate_of_scene).value_or(settings.contact_time);
  }
  if (arguments.needles) {
    settings.needles = static_cast<std::uint64_t>(number_of(needles_option, *arguments.needles));
  }
  if (arguments.seed) {
    settings.seed = static_cast<std::uint64_t>(number_of(seed_option, *arguments.seed));
  } else if (loaded) {
    settings.seed = loaded->scene.needles.seed;
  }
  if (gas.taus.empty()) gas.taus = {0, 1, 2, 5, 10};
  std::ranges::sort(gas.taus);
  return boltzmann_theory_of(settings, gas.taus, gas.density, arguments.json);
}

// Theory of a gas that is left to itself, in a periodic box, would look like one of any other.
void require_homogeneous(const Scene& scene, const std::string& path) {
  const char* found = nullptr;
  if (is_pushed(scene)) found = scene.shear ? "[shear]" : "[driving]";
  if (!scene.walls.empty()) found = "[[walls]]";  // gravity needs some
  if (!found) return;
  throw InputError(fmt::format(
      "{}: {}: expected none, as theory is that of a homogeneous gas which is left to itself; "
      "check knows rates between walls, and --epsilon, --k and --density give the course of a gas "
      "without them",
      path, found));
}

std::string text_of(TheoryArguments arguments) {
  take_scene(arguments.taus, arguments.scene);
  take_scene(arguments.times, arguments.scene);
  require_spheres(arguments);
  std::optional<runs::LoadedScene> loaded;
  if (!arguments.scene.empty()) {
    loaded = load_scene({.path = arguments.scene, .overrides = arguments.overrides, .engine = {}});
    require_homogeneous(loaded->scene, arguments.scene);
  }
  if (!arguments.boltzmann.empty()) return boltzmann_text(arguments, loaded);
  for (const auto& [option, value] : {std::pair("--needles", &arguments.needles),
                                      {"--seed", &arguments.seed},
                                      {"--tc", &arguments.tc}}) {
    if (*value) {
      throw std::invalid_argument(
          fmt::format("{} {}: expected --boltzmann beside it", option, **value));
    }
  }
  if (loaded && !loaded->scene.composition().is_needle_gas()) {
    return mixture_theory_of(*loaded, times_of_mixture(arguments, *loaded), arguments.json);
  }
  const Predictions predictions = predictions_of(arguments, loaded);
  return arguments.json ? json_of(predictions) : table_text(predictions);
}

}  // namespace

int run(const TheoryArguments& arguments) {
  try {
    const std::string text = text_of(arguments);
    std::fputs(text.c_str(), stdout);
    return ok;
  } catch (const std::invalid_argument& error) {
    print_error(error.what());
    return bad_usage;
  }
}

}  // namespace needlework::cli
