#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include "kernels/default_arithmetic.h"
#include "needlework/boltzmann.h"
#include "src/boltzmann/pool.h"

namespace needlework::boltzmann {
namespace {

// Independent of each other, so that their spread gives the errors.
constexpr std::size_t pools = 16;

void require(const char* name, double value, bool holds, const char* expected) {
  if (!holds) {
    throw std::invalid_argument(fmt::format("{} = {:g}: expected {}", name, value, expected));
  }
}

void require_in_range(const Settings& settings, std::span<const double> taus) {
  const auto [k, epsilon, beta] = settings.gas;
  require("k", k, k >= 1e-12 && k <= 1e12, "a number in [1e-12, 1e12]");
  require("epsilon", epsilon, epsilon >= 0 && epsilon <= 1, "a number in [0, 1]");
  require("beta", beta, beta >= -1 && beta <= 1, "a number in [-1, 1]");
  const auto [t_tr, t_rot] = settings.initial;
  require("t_tr", t_tr, t_tr >= 1e-100 && t_tr <= 1e100, "a number in [1e-100, 1e100]");
  require("t_rot", t_rot, t_rot >= 0 && t_rot <= 1e100, "a number in [0, 1e100]");
  const bool may_collapse = settings.pairs == Pairs::encounters && (epsilon < 1 || beta != -1);
  require("contact_time", settings.contact_time,
          settings.contact_time >= 0 && settings.contact_time <= 1e100 &&
              !(may_collapse && settings.contact_time < 1e-9),
          may_collapse ? "a number in [1e-9, 1e100], as encounters of this gas may collapse"
                       : "a number in [0, 1e100]");
  const auto needles = static_cast<double>(settings.needles);
  require("needles", needles, needles >= 4 * pools && needles <= 1e9, "a number in [64, 1e9]");
  double last = 0;
  for (const double tau : taus) {
    require("tau", tau, std::isfinite(tau) && tau >= last, "finite times >= 0 in ascending order");
    last = tau;
  }
}

}  // namespace

Result simulate(const Settings& settings, std::span<const double> taus, int threads) {
  require_in_range(settings, taus);
  std::vector<std::unique_ptr<Pool>> all(pools);
  std::vector<std::array<Sums, pools>> sums(taus.size());
#pragma omp parallel for num_threads(threads) schedule(dynamic)
  for (std::size_t p = 0; p < pools; ++p) {
    const kernels::DefaultArithmetic arithmetic;
    const std::size_t needles = settings.needles * (p + 1) / pools - settings.needles * p / pools;
    all[p] = std::make_unique<Pool>(settings, p, needles);
    for (std::size_t n = 0; n < taus.size(); ++n) {
      all[p]->advance(taus[n]);
      sums[n][p] = all[p]->sums();
    }
  }
  Result out;
  for (const auto& pool : all) pool->add_to(out);
  for (std::size_t n = 0; n < taus.size(); ++n) {
    Sample sample = measured(sums[n], settings.gas.k);
    sample.tau = taus[n];
    out.samples.push_back(sample);
  }
  return out;
}

}  // namespace needlework::boltzmann
