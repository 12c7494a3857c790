#include "src/cli/predict_command.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/predict.h"
#include "src/cli/file_kind.h"
#include "src/cli/json.h"
#include "src/cli/messages.h"
#include "src/cli/pairs_file.h"
#include "src/runs/exit_codes.h"
#include "src/scene/accuracy.h"
#include "src/scene/check.h"

namespace needlework::cli {

using enum runs::ExitCode;
namespace {

using Json = nlohmann::ordered_json;  // keys in the order of the columns

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

std::string as_json(const std::vector<Answer>& answers) {
  Json pairs = Json::array();
  for (const Answer& answer : answers) {
    const FirstContact& contact = answer.contact;
    pairs.push_back({{"id", json_id(answer.id)},
                     {"time", number(contact.time)},
                     {"s12", number(contact.arm_first)},
                     {"s21", number(contact.arm_second)},
                     {"evaluations", contact.evaluations},
                     {"escalations", contact.escalations}});
  }
  return json_text(Json{{"pairs", pairs}}) + '\n';
}

}  // namespace

int run(const PredictArguments& arguments) {
  for (const std::string& warning : accuracy_warnings(arguments.engine)) print_warning(warning);
  const std::vector<PairLine> pairs =
      read_file(arguments.path, FileKind::pairs, [&] { return read_pairs(arguments.path); });
  if (pairs.empty()) print_warning(arguments.path + ": there are no pairs in it");
  const std::vector<Answer> answers = solve(pairs, accuracy_of(arguments.engine), arguments.path);
  const std::string out = arguments.json ? as_json(answers) : as_lines(answers);
  std::fwrite(out.data(), 1, out.size(), stdout);  // main sees to failures
  return ok;
}

}  // namespace needlework::cli
