// The command `needlework theory`: what kinetic theory predicts for a gas.
#include "src/cli/theory_command.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "needlework/theory.h"
#include "src/cli/json.h"
#include "src/cli/messages.h"
#include "src/runs/exit_codes.h"

namespace needlework::cli {

using enum runs::ExitCode;

namespace {

constexpr double largest = std::numeric_limits<double>::max();

/// A flag that takes numbers, and which.
struct NumberFlag {
  const char* name;
  double least, most;
  const char* expectation;
};

constexpr NumberFlag epsilon_flag{"--epsilon", 0.0, 1.0, "a number in [0, 1]"};
constexpr NumberFlag beta_flag{"--beta", -1.0, 1.0, "a number in [-1, 1]"};
constexpr NumberFlag k_flag{"--k", 1e-12, 1e12, "a number in [1e-12, 1e12]"};
constexpr NumberFlag t_rot0_flag{"--t-rot0", 0.0, largest, "a finite number, 0 or more"};
constexpr NumberFlag tau_flag{"--tau", 0.0, largest, "a finite number, 0 or more"};

struct Predictions {
  theory::Gas gas;
  double ratio;            ///< T_tr / T_rot in the end, NaN in an elastic gas
  double equipartition_k;  ///< NaN for rough needles, where it depends on epsilon and beta
  std::vector<double> taus;
  std::vector<theory::Temperatures> curve;
};

double number_of(const NumberFlag& flag, std::string_view text) {
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_number = error == std::errc() && end == digits.data() + digits.size();
  if (!is_number || !(value >= flag.least && value <= flag.most)) {
    throw std::invalid_argument(
        fmt::format("{} {}: expected {}", flag.name, text, flag.expectation));
  }
  return value;
}

Predictions predictions_of(const TheoryArguments& arguments) {
  Predictions result{};
  result.gas = {.k = number_of(k_flag, arguments.k),
                .epsilon = number_of(epsilon_flag, arguments.epsilon),
                .beta = number_of(beta_flag, arguments.beta)};
  const theory::Temperatures initial{.t_tr = 1.0,
                                     .t_rot = number_of(t_rot0_flag, arguments.t_rot0)};
  for (const std::string& tau : arguments.taus) result.taus.push_back(number_of(tau_flag, tau));

  result.ratio = theory::asymptotic_ratio(result.gas);
  result.equipartition_k = result.gas.beta == -1.0 ? theory::equipartition_k()
                                                   : std::numeric_limits<double>::quiet_NaN();
  result.curve = theory::cooling_curve(result.gas, initial, result.taus);
  return result;
}

/// NaN becomes null, and numbers keep all their digits.
std::string json_of(const Predictions& predictions) {
  nlohmann::ordered_json json{{"epsilon", predictions.gas.epsilon},
                              {"beta", predictions.gas.beta},
                              {"k", predictions.gas.k},
                              {"c", predictions.ratio},
                              {"k_star", predictions.equipartition_k},
                              {"tau", predictions.taus}};
  std::vector<double> t_tr, t_rot, energy;
  for (const theory::Temperatures& now : predictions.curve) {
    t_tr.push_back(now.t_tr);
    t_rot.push_back(now.t_rot);
    energy.push_back(now.energy());
  }
  json["t_tr"] = t_tr;
  json["t_rot"] = t_rot;
  json["energy"] = energy;
  return json_text(json) + '\n';
}

std::string table_text(const Predictions& predictions) {
  const auto& [gas, ratio, equipartition_k, taus, curve] = predictions;
  std::string text = fmt::format("epsilon {}, beta {}, k {}\n", gas.epsilon, gas.beta, gas.k);
  text += std::isnan(ratio) ? std::string("elastic: T_tr/T_rot tends to 1, and nothing cools\n")
                            : fmt::format("T_tr/T_rot tends to {:.10g}\n", ratio);
  if (!std::isnan(equipartition_k)) {
    text += fmt::format("equipartition for every epsilon at k = {:.10g}\n", equipartition_k);
  }
  if (taus.empty()) return text;

  text += fmt::format("\n{:>16}  {:>16}  {:>16}  {:>16}\n", "tau", "T_tr", "T_rot", "energy");
  for (std::size_t i = 0; i < taus.size(); ++i) {
    text += fmt::format("{:>16.10g}  {:>16.10g}  {:>16.10g}  {:>16.10g}\n", taus[i], curve[i].t_tr,
                        curve[i].t_rot, curve[i].energy());
  }
  return text;
}

}  // namespace

int run(const TheoryArguments& arguments) {
  try {
    const Predictions predictions = predictions_of(arguments);
    const std::string text = arguments.json ? json_of(predictions) : table_text(predictions);
    std::fputs(text.c_str(), stdout);
    return ok;
  } catch (const std::invalid_argument& error) {
    print_error(error.what());
    return bad_usage;
  }
}

}  // namespace needlework::cli
