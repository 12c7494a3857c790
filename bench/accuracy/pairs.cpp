// First contacts by several accuracies over one family of pairs, against the oracle: what each
// costs, and how often and by how much it errs. bench/accuracy/accuracy.py asks for what it needs.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/accuracy/family_program.h"
#include "needlework/predict.h"
#include "src/scene/accuracy.h"
#include "tests/support/oracle.h"
#include "tests/support/pair_families.h"
#include "tests/support/pairs_csv.h"
#include "tests/support/random.h"

using namespace needlework;

namespace {

using Json = nlohmann::ordered_json;

// Times that differ by more than this share belong to different contacts.
constexpr double same_contact = 1e-5;
constexpr std::size_t drawn_at_once = 64, batch = 64 * drawn_at_once;
// Batches belong to these in turn, and the time of a pair is given for each: how much they differ
// says how sure it is.
constexpr std::size_t portions = 5;

struct Errors {
  std::uint64_t missed = 0, spurious = 0;
};

// What one accuracy has done so far.
struct Subject {
  std::string name;
  Accuracy accuracy;
  std::array<double, portions> cpu_s{}, pairs{};  // CPU time and pairs of each portion
  std::uint64_t evaluations = 0, escalations = 0;
  Errors clear, near;
  std::vector<double> time_errors;  // |dt| / t of contacts that both found
  std::vector<FirstContact> found;  // of the present batch
};

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double number(const std::string& text, const std::string& word, double least, double most) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !(least <= value && value <= most)) {
    throw InputError(
        fmt::format("--accuracy: {}: expected a number from {:g} to {:g}", word, least, most));
  }
  return value;
}

// "NAME" or "NAME,key=value,...": a level and its knobs.
Subject subject_of(const std::string& text) {
  Scene::Engine engine;
  std::stringstream words(text);
  std::getline(words, engine.accuracy, ',');
  for (std::string word; std::getline(words, word, ',');) {
    const std::size_t equals = word.find('=');
    const std::string key = word.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
    if (key == "isolation") {
      engine.isolation = value;
    } else if (key == "escalation") {
      engine.escalation = value;
    } else if (key == "root_tolerance") {
      engine.root_tolerance = number(value, word, 0, 1e-3);
    } else if (key == "sampling_step") {
      engine.sampling_step = number(value, word, 1e-4, 0.5);
    } else {
      throw InputError(
          fmt::format("--accuracy {}: {}: expected isolation=, escalation=, "
                      "root_tolerance= or sampling_step=",
                      text, word));
    }
  }
  Subject out;
  out.name = text;
  out.accuracy = accuracy_of(engine);
  return out;
}

void solve(Subject& subject, const std::vector<test::NeedlePair>& pairs, std::size_t portion) {
  subject.found.clear();
  const double begin = cpu_seconds();
  for (const test::NeedlePair& pair : pairs) {
    subject.found.push_back(
        predict(pair.first, pair.second, pair.horizon, pair.just_collided, subject.accuracy));
  }
  subject.cpu_s[portion] += cpu_seconds() - begin;
  subject.pairs[portion] += static_cast<double>(pairs.size());
}

// Which error, if any: +1 a contact too many or too early, -1 one missed.
int judge(const FirstContact& found, const test::OracleAnswer& truth) {
  const double allowed = std::max(same_contact, 4 * truth.time_limit) * truth.time;
  const bool contact = std::isfinite(found.time);
  if (truth.contact && (!contact || found.time > truth.time + allowed)) return -1;
  if (contact && (!truth.contact || found.time < truth.time - allowed)) return 1;
  return 0;
}

double quantile(std::vector<double>& sorted, double q) {
  if (sorted.empty()) return std::nan("");
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

Json report(Subject& subject, double count) {
  std::vector<double>& errors = subject.time_errors;
  std::sort(errors.begin(), errors.end());
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
  Json ns_per_pair = Json::array();
  for (std::size_t k = 0; k < portions && subject.pairs[k] > 0; ++k) {
    ns_per_pair.push_back(1e9 * subject.cpu_s[k] / subject.pairs[k]);
  }
  return {{"accuracy", subject.name},
          {"ns_per_pair", ns_per_pair},
          {"evaluations", static_cast<double>(subject.evaluations) / count},
          {"escalations", static_cast<double>(subject.escalations) / count},
          {"missed", subject.clear.missed},
          {"spurious", subject.clear.spurious},
          {"near_missed", subject.near.missed},
          {"near_spurious", subject.near.spurious},
          {"time_error",
           {{"median", number(quantile(errors, 0.5))},
            {"q90", number(quantile(errors, 0.9))},
            {"q99", number(quantile(errors, 0.99))},
            {"max", number(quantile(errors, 1))}}}};
}

struct Options : FamilyOptions {
  std::vector<std::string> accuracies{"fast", "standard", "rigorous"};
  std::string errors_to;
  double longest = 1;  // lengths are from 1 to this
  test::Digits digits = test::Digits::automatic;
};

// With the fewest digits, every so many pairs are solved with all of them too.
constexpr std::size_t checked_apart = 128;

struct Truth {
  test::OracleAnswer answer;
  bool contradicted = false;
};

Truth truth_of(const test::NeedlePair& pair, test::Digits digits, bool checked) {
  const auto solved = [&](test::Digits by) {
    return test::first_contact(pair.first, pair.second, pair.horizon, pair.just_collided,
                               {.digits = by});
  };
  const test::OracleAnswer answer = solved(digits);
  if (!checked || digits == test::Digits::automatic) return {answer};
  const test::OracleAnswer full = solved(test::Digits::automatic);
  // Wider than same_contact where even the full answer is that uncertain.
  const double allowed = std::max(same_contact, 1000 * full.time_limit) * full.time;
  const bool same =
      full.contact == answer.contact && !(std::abs(full.time - answer.time) > allowed);
  return {full, !same};
}

// Of the pairs that are drawn with this seed: 1, and one from 1 to `longest`, in either order.
test::Lengths lengths_of(double longest, std::uint64_t seed) {
  if (longest == 1) return {1, 1};
  test::Random random(seed);
  const double other = std::exp(random.uniform(0, 1) * std::log(longest));
  return random.coin() ? test::Lengths{1, other} : test::Lengths{other, 1};
}

// Pairs number first to first + count - 1 of the family, in parts that do not depend on how many
// are asked for.
std::vector<test::NeedlePair> draw(const Options& options, std::uint64_t first, std::size_t count) {
  std::vector<test::NeedlePair> out(count);
#pragma omp parallel for schedule(dynamic)
  for (std::size_t begin = 0; begin < count; begin += drawn_at_once) {
    const std::size_t size = std::min(drawn_at_once, count - begin);
    const std::uint64_t seed = (options.seed << 40) + (first + begin) / drawn_at_once;
    std::ranges::move(
        test::draw_pairs(options.family, size, seed, lengths_of(options.longest, seed)),
        out.begin() + begin);
  }
  return out;
}

int run(const Options& options) {
  if (options.list_families) {
    print_names(test::pair_families());
    return 0;
  }
  static_cast<void>(family_named(test::pair_families(), options.family));
  if (options.longest != 1 && options.digits == test::Digits::fewest)
    throw InputError("--fewest-digits: expected no --longest: its bounds are those of length 1");
  std::vector<Subject> subjects;
  for (const std::string& text : options.accuracies) subjects.push_back(subject_of(text));
  std::ofstream listed;
  if (!options.errors_to.empty()) {
    listed.open(options.errors_to);
    if (!listed) throw InputError("--list " + options.errors_to + ": cannot be written");
  }
  std::uint64_t contacts = 0, near = 0;
  for (std::uint64_t done = 0; done < options.count;) {
    const std::size_t size = std::min<std::uint64_t>(batch, options.count - done);
    const std::vector<test::NeedlePair> pairs = draw(options, done, size);
    // One after the other on every batch: what slows the machine down slows all of them down.
    for (Subject& subject : subjects) solve(subject, pairs, done / batch % portions);
    std::vector<Truth> truths(size);
#pragma omp parallel for schedule(dynamic, 64)
    for (std::size_t i = 0; i < size; ++i) {
      truths[i] = truth_of(pairs[i], options.digits, i % checked_apart == 0);
    }
    for (std::size_t i = 0; i < size; ++i) {
      const test::OracleAnswer& truth = truths[i].answer;
      if (truths[i].contradicted) {
        throw std::runtime_error("the oracle contradicts itself on\n" +
                                 test::csv_line(done + i, pairs[i]));
      }
      contacts += truth.contact;
      const bool close = truth.decision_margin < test::least_margin;
      near += close;
      for (Subject& subject : subjects) {
        const FirstContact& found = subject.found[i];
        subject.evaluations += found.evaluations;
        subject.escalations += found.escalations;
        const int error = judge(found, truth);
        Errors& errors = close ? subject.near : subject.clear;
        errors.missed += error < 0;
        errors.spurious += error > 0;
        if (error == 0 && truth.contact && truth.digits > std::numeric_limits<double>::digits10) {
          subject.time_errors.push_back(std::abs((found.time - truth.time) - truth.time_low) /
                                        truth.time);
        }
        if (error != 0 && !close && listed.is_open()) {
          listed << "# " << subject.name << (error < 0 ? " misses" : " invents") << '\n'
                 << test::csv_line(done + i, pairs[i]) << '\n';
        }
      }
    }
    done += size;
  }
  Json results = Json::array();
  for (Subject& subject : subjects) {
    results.push_back(report(subject, static_cast<double>(options.count)));
  }
  const Json out{{"family", options.family}, {"pairs", options.count}, {"seed", options.seed},
                 {"contacts", contacts},     {"near", near},           {"results", results}};
  fmt::print("{}\n", out.dump());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return family_program(
      argc, argv,
      "First contacts by several accuracies over one family of pairs, against the oracle", options,
      [&](CLI::App& app) {
        app.add_option("--accuracy", options.accuracies,
                       "level[,key=value...]; several are compared on the same pairs");
        app.add_flag_callback(
            "--fewest-digits", [&] { options.digits = test::Digits::fewest; },
            "let the oracle settle in double what is clear; then only 1 contact in 128, and those "
            "that are not clear, show errors of time");
        app.add_option("--longest", options.longest,
                       "lengths of a pair are 1 and one from 1 to this, log-uniform");
        app.add_option("--list", options.errors_to,
                       "file for the pairs that one of them gets wrong");
      },
      [&] { return run(options); });
}
