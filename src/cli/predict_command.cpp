#include "src/cli/predict_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/predict.h"
#include "src/cli/messages.h"
#include "src/cli/number_in.h"
#include "src/cli/pairs_file.h"
#include "src/runs/exit_codes.h"
#include "src/scene/accuracy.h"
#include "src/scene/check.h"

namespace needlework::cli {
namespace {

using Json = nlohmann::ordered_json;  // keys in the order of the columns

struct Options {
  std::string path;
  Scene::Engine engine;  ///< of which only what sets the accuracy is used
  bool json = false;
};

struct Answer {
  std::string id;
  FirstContact contact;
};

std::vector<Answer> solve(const std::vector<PairLine>& pairs, const Accuracy& accuracy,
                          const std::string& path) {
  std::vector<Answer> answers;
  answers.reserve(pairs.size());
  for (const PairLine& pair : pairs) {
    try {
      answers.push_back(
          {pair.id, predict(pair.first, pair.second, pair.horizon, pair.just_collided, accuracy)});
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: line {}: {}", path, pair.line, error.what()));
    }
  }
  return answers;
}

/// 17 digits; a number that is not one reads "nan" whatever its sign.
std::string text(double value) { return std::isnan(value) ? "nan" : fmt::format("{:.17g}", value); }

std::string as_lines(const std::vector<Answer>& answers) {
  std::string out;
  for (const Answer& answer : answers) {
    const FirstContact& contact = answer.contact;
    out += fmt::format("{},{},{},{}\n", answer.id, text(contact.time), text(contact.arm_first),
                       text(contact.arm_second));
  }
  return out;
}

/// An id that is an integer stays one.
Json json_id(const std::string& id) {
  std::int64_t number = 0;
  const char* end = id.data() + id.size();
  const auto [stop, error] = std::from_chars(id.data(), end, number);
  if (error == std::errc() && stop == end && std::to_string(number) == id) return number;
  return id;
}

Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string as_json(const std::vector<Answer>& answers) {
  Json pairs = Json::array();
  for (const Answer& answer : answers) {
    const FirstContact& contact = answer.contact;
    pairs.push_back({{"id", json_id(answer.id)},
                     {"time", json_number(contact.time)},
                     {"s12", json_number(contact.arm_first)},
                     {"s21", json_number(contact.arm_second)},
                     {"evaluations", contact.evaluations},
                     {"escalations", contact.escalations}});
  }
  return Json{{"pairs", pairs}}.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

void run(const Options& options) {
  for (const std::string& warning : accuracy_warnings(options.engine)) print_warning(warning);
  const std::vector<PairLine> pairs = read_pairs(options.path);
  if (pairs.empty()) print_warning(options.path + ": there are no pairs in it");
  const std::vector<Answer> answers = solve(pairs, accuracy_of(options.engine), options.path);
  const std::string out = options.json ? as_json(answers) : as_lines(answers);
  std::fwrite(out.data(), 1, out.size(), stdout);  // main sees to failures
}

}  // namespace

void add_predict_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("predict", "find the first contact of each pair of needles");
  const auto options = std::make_shared<Options>();
  command
      ->add_option("PAIRS", options->path, "pairs of needles, one a line; - reads standard input")
      ->option_text("PAIRS.csv")
      ->required();
  Scene::Engine& engine = options->engine;
  command->add_option("--accuracy", engine.accuracy, "level of accuracy")
      ->check(CLI::IsMember({"fast", "standard", "rigorous"}))
      ->capture_default_str();
  command->add_option("--isolation", engine.isolation, "how free times are told")
      ->check(CLI::IsMember({"sampling", "bounds", "intervals"}));
  command->add_option("--escalation", engine.escalation, "what goes to double-double")
      ->check(CLI::IsMember({"never", "undecided", "always"}));
  command
      ->add_option("--root-tolerance", engine.root_tolerance, "of steps towards a root, relative")
      ->check(number_in(0, 1e-3));
  command->add_option("--sampling-step", engine.sampling_step, "time between samples, scaled")
      ->check(number_in(1e-4, 0.5));
  command->add_flag("--json", options->json, "print one JSON object");
  command->footer(
      "A line of PAIRS.csv is id,family,horizon, then x,y,z of r1,u1,v1,w1,r2,u2,v2,w2, then "
      "skip:\n"
      "1 if the pair has just collided at time 0, else 0. For each the output has "
      "id,time,s12,s21,\n"
      "with time inf if there is no contact in (0, horizon].");
  command->callback([options, &exit_code] {
    run(*options);
    exit_code = ok;
  });
}

}  // namespace needlework::cli
