#include "src/serve/prediction.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "needlework/predict.h"
#include "src/json/base64.h"
#include "src/scene/accuracy.h"
#include "src/serve/fields.h"

namespace needlework::serve {

using json::text_of;
namespace {

constexpr std::array vector_fields = {"r1", "u1", "v1", "w1", "r2", "u2", "v2", "w2"};
constexpr std::array vectors_of_needle = {&FreeNeedle::position, &FreeNeedle::orientation,
                                          &FreeNeedle::velocity, &FreeNeedle::angular_velocity};

struct PairToPredict {
  std::array<FreeNeedle, 2> needles;
  double horizon = 0;
  bool just_collided = false;
};

// Positions and directors must be given, velocities that are missing are zero.
std::vector<PairToPredict> pairs_in(const Json& request) {
  std::vector<PairToPredict> pairs;
  for (std::size_t n = 0; n < vector_fields.size(); ++n) {
    const auto vectors = vectors_in(request, vector_fields[n]);
    if (!vectors && n % 4 < 2)
      throw RequestError(
          fmt::format("{}: expected an array of vectors in base64", vector_fields[n]));
    if (n == 0) pairs.resize(vectors->size());
    if (vectors && vectors->size() != pairs.size()) {
      throw RequestError(
          fmt::format("{}: {} rows: expected {}", vector_fields[n], vectors->size(), pairs.size()));
    }
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      auto& vector = pairs[i].needles[n / 4].*vectors_of_needle[n % 4];
      vector = vectors ? (*vectors)[i] : std::array<double, 3>{};
    }
  }
  return pairs;
}

void add_numbers(const Json& request, std::vector<PairToPredict>& pairs) {
  const auto horizon = numbers_in(request, "horizon", pairs.size());
  if (!horizon) throw RequestError("horizon: expected a number, or an array in base64");
  const auto skip = bytes_in(request, "skip");
  if (skip && skip->size() != pairs.size())
    throw RequestError(fmt::format("skip: {} bytes: expected {}", skip->size(), pairs.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].horizon = (*horizon)[i];
    pairs[i].just_collided = skip && (*skip)[i] != 0;
  }
  for (const auto& [field, which, size] : {std::tuple("length1", 0, &FreeNeedle::length),
                                           {"length2", 1, &FreeNeedle::length},
                                           {"diameter1", 0, &FreeNeedle::diameter},
                                           {"diameter2", 1, &FreeNeedle::diameter}}) {
    const auto given = numbers_in(request, field, pairs.size());
    if (!given) continue;
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].needles[which].*size = (*given)[i];
  }
}

Accuracy accuracy_in(const Json& request) {
  Scene::Engine engine;
  if (auto name = text_in(request, "accuracy")) engine.accuracy = std::move(*name);
  try {
    return accuracy_of(engine);
  } catch (const InputError& error) {
    throw RequestError(error.what());
  }
}

}  // namespace

Json first_contacts(const Json& request) {
  require_only(request, {"r1", "u1", "v1", "w1", "r2", "u2", "v2", "w2", "horizon", "skip",
                         "accuracy", "length1", "length2", "diameter1", "diameter2"});
  std::vector<PairToPredict> pairs = pairs_in(request);
  add_numbers(request, pairs);
  const Accuracy accuracy = accuracy_in(request);
  std::vector<double> time, s12, s21;
  for (const PairToPredict& pair : pairs) {
    try {
      const FirstContact contact =
          predict(pair.needles[0], pair.needles[1], pair.horizon, pair.just_collided, accuracy);
      time.push_back(contact.time);
      s12.push_back(contact.arm_first);
      s21.push_back(contact.arm_second);
    } catch (const InputError& error) {
      throw InputError(fmt::format("pair {}: {}", time.size(), error.what()));
    }
  }
  return {{"pairs", pairs.size()},
          {"time", text_of(time)},
          {"s12", text_of(s12)},
          {"s21", text_of(s21)}};
}

}  // namespace needlework::serve
