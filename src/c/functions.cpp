// What C callers can compute without a simulation: first contacts, kinetic theory, capabilities.
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "needlework/predict.h"
#include "needlework/theory.h"
#include "src/c/handle.h"
#include "src/c/vectors.h"
#include "src/runs/capabilities.h"
#include "src/scene/accuracy.h"

namespace needlework::c {
namespace {

void require_vectors(const needlework_pairs& p) {
  for (const auto& [vectors, name] :
       {std::pair(&p.r1, "r1"), std::pair(&p.u1, "u1"), std::pair(&p.v1, "v1"),
        std::pair(&p.w1, "w1"), std::pair(&p.r2, "r2"), std::pair(&p.u2, "u2"),
        std::pair(&p.v2, "v2"), std::pair(&p.w2, "w2")}) {
    if (!vectors->data)
      throw UsageError(std::string("pairs->") + name +
                       ".data is NULL: expected "
                       "a pointer");
  }
  require(p.horizon, "pairs->horizon");
}

FirstContact contact_of(const needlework_pairs& p, const needlework_pair_sizes& sizes,
                        std::size_t n, const Accuracy& accuracy) {
  const auto size = [n](const double* sizes, double usual) { return sizes ? sizes[n] : usual; };
  const FreeNeedle first{.position = vector_at(p.r1, n),
                         .orientation = vector_at(p.u1, n),
                         .velocity = vector_at(p.v1, n),
                         .angular_velocity = vector_at(p.w1, n),
                         .length = size(sizes.length1, 1),
                         .diameter = size(sizes.diameter1, 0)};
  const FreeNeedle second{.position = vector_at(p.r2, n),
                          .orientation = vector_at(p.u2, n),
                          .velocity = vector_at(p.v2, n),
                          .angular_velocity = vector_at(p.w2, n),
                          .length = size(sizes.length2, 1),
                          .diameter = size(sizes.diameter2, 0)};
  try {
    return predict(first, second, p.horizon[n], p.skip && p.skip[n], accuracy);
  } catch (const InputError& error) {
    throw InputError("pair " + std::to_string(n) + ": " + error.what());
  }
}

Accuracy accuracy_named(const char* name) {
  Scene::Engine engine;
  if (name) engine.accuracy = name;
  try {
    return accuracy_of(engine);
  } catch (const InputError& error) {
    throw UsageError(std::string("pairs->accuracy: ") + error.what());
  }
}

theory::Gas gas_of(const needlework_gas* gas) {
  require(gas, "gas");
  return {.k = gas->k, .epsilon = gas->epsilon, .beta = gas->beta};
}

}  // namespace
}  // namespace needlework::c

using namespace needlework;

const char* needlework_version(void) { return NEEDLEWORK_VERSION; }

int needlework_has(const char* capability) {
  if (!capability) return 0;
  int found = 0;
  c::guarded(static_cast<needlework_error*>(nullptr), [&] {
    for (const std::string& name : runs::capabilities()) found |= name == capability;
  });
  return found;
}

int needlework_predict(const needlework_pairs* pairs, double* time, double* s12, double* s21,
                       needlework_error* error) {
  return needlework_predict_with_sizes(pairs, nullptr, time, s12, s21, error);
}

int needlework_predict_with_sizes(const needlework_pairs* pairs, const needlework_pair_sizes* sizes,
                                  double* time, double* s12, double* s21, needlework_error* error) {
  return c::guarded(error, [&] {
    c::require(pairs, "pairs");
    if (pairs->count > 0) c::require_vectors(*pairs);
    const Accuracy accuracy = c::accuracy_named(pairs->accuracy);
    const needlework_pair_sizes of = sizes ? *sizes : needlework_pair_sizes{};
    for (std::size_t n = 0; n < pairs->count; ++n) {
      const FirstContact contact = c::contact_of(*pairs, of, n, accuracy);
      if (time) time[n] = contact.time;
      if (s12) s12[n] = contact.arm_first;
      if (s21) s21[n] = contact.arm_second;
    }
  });
}

int needlework_collision_rate(double k, double density, double t_tr, double t_rot, double* rate,
                              needlework_error* error) {
  return c::guarded(error, [&] {
    c::require(rate, "rate");
    *rate = theory::collision_rate(density, {t_tr, t_rot}, k);
  });
}

int needlework_ratio(const needlework_gas* gas, double* ratio, needlework_error* error) {
  return c::guarded(error, [&] {
    c::require(ratio, "ratio");
    *ratio = theory::asymptotic_ratio(c::gas_of(gas));
  });
}

int needlework_cooling(const needlework_gas* gas, double t_tr0, double t_rot0, size_t count,
                       const double* tau, double* t_tr, double* t_rot, needlework_error* error) {
  return c::guarded(error, [&] {
    if (count > 0) c::require(tau, "tau");
    const std::vector<theory::Temperatures> curve =
        theory::cooling_curve(c::gas_of(gas), {t_tr0, t_rot0}, std::span(tau, count));
    for (std::size_t n = 0; n < curve.size(); ++n) {
      if (t_tr) t_tr[n] = curve[n].t_tr;
      if (t_rot) t_rot[n] = curve[n].t_rot;
    }
  });
}
