// Kinetic theory for Python.
#include "needlework/theory.h"

#include <pybind11/numpy.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "needlework/diffusion.h"
#include "src/composition/rough_spheres.h"
#include "src/python/arrays.h"
#include "src/python/interpreter.h"
#include "src/python/parts.h"

namespace needlework::python {
namespace {

namespace py = pybind11;

double collision_rate(double k, double density, double t_tr, double t_rot) {
  return theory::collision_rate(density, {t_tr, t_rot}, k);
}

double equilibrium_rate(double k, double count, double volume, double energy, int conserved) {
  return theory::equilibrium_rate(count, volume, energy, k, conserved);
}

double factor_between_walls(double k, double gap, double t_tr, double t_rot) {
  Species needle;
  needle.k = k;
  const theory::Temperatures now{t_tr, t_rot};
  return theory::pair_factor_between_walls(needle, now, needle, now, gap);
}

// Decay rates of v and w, then D and D_R.
py::tuple diffusion(const Column& ks, const Column& densities, const Column& temperatures) {
  Column out[4] = {Column(ks.size()), Column(ks.size()), Column(ks.size()), Column(ks.size())};
  for (py::ssize_t i = 0; i < ks.size(); ++i) {
    const theory::Transport transport =
        theory::uncorrelated_transport(densities.data()[i], temperatures.data()[i], ks.data()[i]);
    out[0].mutable_data()[i] = transport.velocity_decay;
    out[1].mutable_data()[i] = transport.angular_velocity_decay;
    out[2].mutable_data()[i] = transport.diffusion;
    out[3].mutable_data()[i] = transport.rotational_diffusion;
  }
  return py::make_tuple(out[0], out[1], out[2], out[3]);
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

// Arrays [species], and of each two [species][species]; the Python side has checked the shapes.
Composition composition_of(const Column& counts, const Column& lengths, const Column& masses,
                           const Column& ks, const Column& diameters, const Column& qs,
                           const Column& epsilons, const Column& betas, const Column& meet) {
  const auto size = static_cast<std::size_t>(counts.size());
  std::vector<Species> species(size);
  for (std::size_t n = 0; n < size; ++n) {
    species[n].count = static_cast<std::uint64_t>(counts.data()[n]);
    species[n].length = lengths.data()[n];
    species[n].mass = masses.data()[n];
    species[n].k = ks.data()[n];
    species[n].diameter = diameters.data()[n];
    species[n].q = qs.data()[n];
  }
  Composition out(std::move(species), {});
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = a; b < size; ++b) {
      out.set_restitution(a, b, {epsilons.data()[a * size + b], betas.data()[a * size + b]});
      out.set_meets(a, b, meet.data()[a * size + b] != 0);
    }
  }
  set_q_of_spheres(out);
  return out;
}

std::vector<theory::Temperatures> temperatures_of(const Column& t_tr, const Column& t_rot) {
  std::vector<theory::Temperatures> out;
  for (py::ssize_t n = 0; n < t_tr.size(); ++n) out.push_back({t_tr.data()[n], t_rot.data()[n]});
  return out;
}

// Collisions per unit of time of each two species, [species][species], and the derivatives of the
// temperatures of each.
py::tuple mixture_rates(const Column& counts, const Column& lengths, const Column& masses,
                        const Column& ks, const Column& diameters, const Column& qs,
                        const Column& epsilons, const Column& betas, const Column& meet,
                        double volume, const Column& t_tr, const Column& t_rot) {
  const Composition composition =
      composition_of(counts, lengths, masses, ks, diameters, qs, epsilons, betas, meet);
  const auto now = temperatures_of(t_tr, t_rot);
  const theory::MixtureRates rates = theory::mixture_rates(composition, volume, now);
  const auto size = static_cast<py::ssize_t>(composition.size());
  Column collisions({size, size}), d_tr(size), d_rot(size);
  for (py::ssize_t a = 0; a < size; ++a) {
    for (py::ssize_t b = 0; b < size; ++b) {
      collisions.mutable_at(a, b) = rates.collisions[composition.pair_index(a, b)];
    }
    d_tr.mutable_at(a) = rates.temperatures[a].t_tr;
    d_rot.mutable_at(a) = rates.temperatures[a].t_rot;
  }
  return py::make_tuple(collisions, d_tr, d_rot);
}

// Temperatures of each species at each time, [times][species], and the energy per body, [times].
py::tuple mixture_cooling(const Column& counts, const Column& lengths, const Column& masses,
                          const Column& ks, const Column& diameters, const Column& qs,
                          const Column& epsilons, const Column& betas, const Column& meet,
                          double volume, const Column& t_tr0, const Column& t_rot0,
                          const Column& times) {
  const Composition composition =
      composition_of(counts, lengths, masses, ks, diameters, qs, epsilons, betas, meet);
  const auto initial = temperatures_of(t_tr0, t_rot0);
  std::vector<std::vector<theory::Temperatures>> curve;
  without_lock([&] {
    curve =
        theory::mixture_cooling(composition, volume, initial,
                                std::span(times.data(), static_cast<std::size_t>(times.size())));
  });
  Column t_tr({times.size(), counts.size()}), t_rot({times.size(), counts.size()});
  Column energy(times.size());
  for (py::ssize_t i = 0; i < times.size(); ++i) {
    for (py::ssize_t n = 0; n < counts.size(); ++n) {
      t_tr.mutable_at(i, n) = curve[i][n].t_tr;
      t_rot.mutable_at(i, n) = curve[i][n].t_rot;
    }
    energy.mutable_at(i) = theory::mean_of_species(composition, curve[i]).energy();
  }
  return py::make_tuple(t_tr, t_rot, energy);
}

}  // namespace

void add_theory(py::module_& module) {
  module.def("collision_rate", py::vectorize(collision_rate));
  module.def("equilibrium_rate", py::vectorize(equilibrium_rate));
  module.def("factor_between_walls", py::vectorize(factor_between_walls));
  module.def("diffusion", diffusion);
  module.def("ratio", py::vectorize(ratio));
  module.def("cooling", cooling);
  module.def("mixture_rates", mixture_rates);
  module.def("mixture_cooling", mixture_cooling);
  module.def("equipartition_k", theory::equipartition_k);
}

}  // namespace needlework::python
