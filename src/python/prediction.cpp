// First contacts of many pairs of needles.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <string>
#include <utility>

#include "needlework/error.h"
#include "needlework/predict.h"
#include "src/python/arrays.h"
#include "src/python/interpreter.h"
#include "src/python/parts.h"

namespace needlework::python {
namespace {

namespace py = pybind11;
using Flags = py::array_t<bool, py::array::c_style | py::array::forcecast>;

/// Pairs between two looks at signals: some milliseconds, even at the most careful level.
constexpr std::size_t pairs_at_once = 256;

Accuracy level(const std::string& name) {
  if (name == "fast") return fast_accuracy;
  if (name == "standard") return standard_accuracy;
  if (name == "rigorous") return rigorous_accuracy;
  throw InputError("accuracy = \"" + name + "\": expected \"fast\", \"standard\" or \"rigorous\"");
}

/// States of one needle of each pair, [M][3] each, and its sizes, [M].
struct Needles {
  Rows position, orientation, velocity, angular_velocity;
  Column length, diameter;

  FreeNeedle operator[](std::size_t i) const {
    return {row(position, i),         row(orientation, i), row(velocity, i),
            row(angular_velocity, i), length.data()[i],    diameter.data()[i]};
  }
};

// Ends with the exception of a signal handler, such as KeyboardInterrupt.
void look_at_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

// Arrays time, s12, s21 [M].
py::tuple predict_pairs(Rows r1, Rows u1, Rows v1, Rows w1, Rows r2, Rows u2, Rows v2, Rows w2,
                        Column length1, Column length2, Column diameter1, Column diameter2,
                        const Column& horizon, const Flags& skip, const std::string& accuracy) {
  const Accuracy settings = level(accuracy);
  const Needles first{std::move(r1), std::move(u1),      std::move(v1),
                      std::move(w1), std::move(length1), std::move(diameter1)};
  const Needles second{std::move(r2), std::move(u2),      std::move(v2),
                       std::move(w2), std::move(length2), std::move(diameter2)};
  const auto count = static_cast<std::size_t>(horizon.size());
  Column time(horizon.size()), s12(horizon.size()), s21(horizon.size());
  double* const times = time.mutable_data();
  double* const arms_first = s12.mutable_data();
  double* const arms_second = s21.mutable_data();
  const auto solve = [&](std::size_t i) {
    try {
      const FirstContact contact =
          predict(first[i], second[i], horizon.data()[i], skip.data()[i], settings);
      times[i] = contact.time;
      arms_first[i] = contact.arm_first;
      arms_second[i] = contact.arm_second;
    } catch (const InputError& error) {
      throw InputError("pair " + std::to_string(i) + ": " + error.what());
    }
  };
  for (std::size_t begin = 0; begin < count; begin += pairs_at_once) {
    look_at_signals();
    without_lock([&] {
      for (std::size_t i = begin; i < std::min(begin + pairs_at_once, count); ++i) solve(i);
    });
  }
  return py::make_tuple(time, s12, s21);
}

}  // namespace

void add_prediction(py::module_& module) { module.def("predict", predict_pairs); }

}  // namespace needlework::python
