// First contacts of rods over one family of pairs, against the oracle of the tests: what is missed
// and invented. bench/accuracy/misses.py asks for portions of them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/accuracy/family_program.h"
#include "kernels/rod_contact.h"
#include "src/scene/accuracy.h"
#include "tests/support/random.h"
#include "tests/support/rod_families.h"
#include "tests/support/rod_oracle.h"

using namespace needlework;

namespace {

using Json = nlohmann::ordered_json;

// Times that differ by more than this share belong to different contacts.
constexpr double same_contact = 1e-5;
constexpr std::uint64_t drawn_at_once = 64;
// With the fewest digits, every so many pairs are solved with all of them too.
constexpr std::uint64_t checked_apart = 1024;

struct Options : FamilyOptions {
  std::string accuracy = "standard";
  bool fewest_digits = false;
};

struct Sums {
  std::uint64_t contacts = 0, undecided = 0, missed = 0, spurious = 0;
  std::uint64_t with_all_digits = 0, contradicted = 0;
  std::uint64_t evaluations = 0, escalations = 0;
  double worst = 0;
  std::uint64_t worst_pair = 0;

  void operator+=(const Sums& other) {
    contacts += other.contacts;
    undecided += other.undecided;
    missed += other.missed;
    spurious += other.spurious;
    with_all_digits += other.with_all_digits;
    contradicted += other.contradicted;
    evaluations += other.evaluations;
    escalations += other.escalations;
    if (other.worst > worst) {
      worst = other.worst;
      worst_pair = other.worst_pair;
    }
  }
};

struct Truth {
  test::RodAnswer answer;
  bool is_exact = true, contradicted = false;
};

Truth truth_of(const test::RodCase& rods, bool fewest_digits, bool checked) {
  std::optional<test::RodAnswer> quick;
  if (fewest_digits) quick = quick_rod_contact(rods);
  if (quick && !checked) return {*quick, false};
  const test::RodAnswer full = first_rod_contact(rods);
  if (!quick || full.undecided) return {full};
  const test::Quad off = abs(full.time - quick->time);
  return {full, true, full.contact != quick->contact || off > same_contact / 5 * full.time};
}

Sums judged(const test::RodCase& rods, const Accuracy& accuracy, bool fewest_digits, bool checked) {
  Sums out;
  kernels::EvaluationCounters spent;
  const kernels::Contact found =
      kernels::rod_contact(rods.view(), 0, rods.horizon, spent, accuracy);
  out.evaluations = spent.evaluated;
  out.escalations = spent.escalated;
  const auto [truth, is_exact, contradicted] = truth_of(rods, fewest_digits, checked);
  out.with_all_digits = is_exact;
  out.contradicted = contradicted;
  out.contacts = truth.contact;
  if (truth.undecided) {
    out.undecided = 1;
    return out;
  }
  const test::Quad time = test::Quad(found.elapsed.hi) + test::Quad(found.elapsed.lo);
  // The oracle looks at rods that touch from 1e-27 of this on.
  const test::Quad allowed = truth.time * same_contact + test::Quad(1e-25) * rods.horizon;
  out.missed = truth.contact && (!found.found || time > truth.time + allowed);
  out.spurious = found.overlap || (found.found && (!truth.contact || time < truth.time - allowed));
  if (is_exact && truth.contact && truth.time > 0 && !out.missed && !out.spurious) {
    out.worst = static_cast<double>(abs(time - truth.time) / truth.time);
  }
  return out;
}

int run(const Options& options) {
  if (options.list_families) {
    print_names(test::rod_families());
    return 0;
  }
  const test::RodFamily& family = family_named(test::rod_families(), options.family);
  Scene::Engine engine;
  engine.accuracy = options.accuracy;
  const Accuracy accuracy = accuracy_of(engine);
  // Parts that do not depend on how many are asked for.
  const std::uint64_t parts = (options.count + drawn_at_once - 1) / drawn_at_once;
  std::vector<Sums> sums(parts);
#pragma omp parallel for schedule(dynamic)
  for (std::uint64_t part = 0; part < parts; ++part) {
    test::Random random((options.seed << 40) + part);
    const std::uint64_t size = std::min(drawn_at_once, options.count - part * drawn_at_once);
    for (std::uint64_t n = 0; n < size; ++n) {
      const std::uint64_t number = part * drawn_at_once + n;
      Sums one =
          judged(family.draw(random), accuracy, options.fewest_digits, number % checked_apart == 0);
      if (one.contradicted) {
        fmt::print(stderr, "{}, seed {}: of pair {} both oracles say different things\n",
                   options.family, options.seed, number);
      }
      if (one.missed || one.spurious) {
        fmt::print(stderr, "{}, seed {}: pair {} is {}\n", options.family, options.seed, number,
                   one.missed ? "missed" : "invented");
      }
      one.worst_pair = number;
      sums[part] += one;
    }
  }
  Sums all;
  for (const Sums& part : sums) all += part;
  const auto count = static_cast<double>(options.count);
  const Json out{{"family", options.family},
                 {"pairs", options.count},
                 {"seed", options.seed},
                 {"contacts", all.contacts},
                 {"near", all.undecided},
                 {"all_digits", all.with_all_digits},
                 {"results",
                  {{{"accuracy", options.accuracy},
                    {"evaluations", static_cast<double>(all.evaluations) / count},
                    {"escalations", static_cast<double>(all.escalations) / count},
                    {"missed", all.missed},
                    {"spurious", all.spurious},
                    {"near_missed", 0},
                    {"near_spurious", 0},
                    {"time_error", {{"max", all.worst}, {"pair", all.worst_pair}}}}}}};
  fmt::print("{}\n", out.dump());
  return all.contradicted ? 3 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return family_program(
      argc, argv, "First contacts of rods over one family of pairs, against the oracle", options,
      [&](CLI::App& app) {
        app.add_option("--accuracy", options.accuracy)->capture_default_str();
        app.add_flag("--fewest-digits", options.fewest_digits,
                     "in double what is clear, one pair in 1024 with all digits too");
      },
      [&] { return run(options); });
}
