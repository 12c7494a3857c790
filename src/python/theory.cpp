// Kinetic theory for Python.
#include "needlework/theory.h"

#include <pybind11/numpy.h>

#include <span>
#include <vector>

#include "src/python/arrays.h"
#include "src/python/interpreter.h"
#include "src/python/parts.h"

namespace needlework::python {
namespace {

namespace py = pybind11;

double collision_rate(double k, double density, double t_tr, double t_rot) {
  return theory::collision_rate(density, {t_tr, t_rot}, k);
}

double equilibrium_rate(double k, double count, double volume, double energy) {
  return theory::equilibrium_rate(count, volume, energy, k);
}

double ratio(double epsilon, double k, double beta) {
  return theory::asymptotic_ratio({.k = k, .epsilon = epsilon, .beta = beta});
}

// Arrays t_tr, t_rot and collisions per needle, one entry for each of `taus`.
py::tuple cooling(double epsilon, double k, double beta, double t_tr0, double t_rot0,
                  const Column& taus) {
  const theory::Gas gas{.k = k, .epsilon = epsilon, .beta = beta};
  const theory::Temperatures initial{t_tr0, t_rot0};
  const std::span times(taus.data(), static_cast<std::size_t>(taus.size()));
  std::vector<theory::Temperatures> curve;
  std::vector<double> collisions;
  without_lock([&] {
    curve = theory::cooling_curve(gas, initial, times);
    collisions = theory::collisions_per_needle(gas, initial, times);
  });
  Column t_tr(taus.size()), t_rot(taus.size());
  for (std::size_t i = 0; i < curve.size(); ++i) {
    t_tr.mutable_data()[i] = curve[i].t_tr;
    t_rot.mutable_data()[i] = curve[i].t_rot;
  }
  return py::make_tuple(t_tr, t_rot, Column(taus.size(), collisions.data()));
}

}  // namespace

void add_theory(py::module_& module) {
  module.def("collision_rate", py::vectorize(collision_rate));
  module.def("equilibrium_rate", py::vectorize(equilibrium_rate));
  module.def("ratio", py::vectorize(ratio));
  module.def("cooling", cooling);
  module.def("equipartition_k", theory::equipartition_k);
}

}  // namespace needlework::python
