// Makes Run a class of the module.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <iterator>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "src/python/arrays.h"
#include "src/python/parts.h"
#include "src/python/run.h"

namespace needlework::python {
namespace {

namespace py = pybind11;
using namespace pybind11::literals;
using OptionalNumber = std::optional<double>;

/// Position, velocity, orientation and angular velocity, [N][3] each; images, [N][3], ids and
/// species, [N], which may be absent; bodies; columns of OwnBodies, which may be absent; the
/// velocities, if they are beside the flow of the scene; the slide of rows of boxes and the rate of
/// the state's flow; and the edges of its box, all 0 where they are not known, and the low ones.
using Images = std::optional<py::array_t<std::int32_t, py::array::c_style>>;
using Ids = std::optional<py::array_t<std::uint32_t, py::array::c_style>>;
using SpeciesIndices = std::optional<py::array_t<std::uint8_t, py::array::c_style>>;
/// Names, length, diameter, mass, k and inertia of each species, empty where they are not known.
using Numbers = std::vector<double>;
using BodyColumns =
    std::tuple<std::vector<std::string>, Numbers, Numbers, Numbers, Numbers, Numbers>;
using OwnColumns = std::array<std::optional<Column>, 4>;
using Arrays =
    std::tuple<Rows, Rows, Rows, Rows, Images, Ids, SpeciesIndices, BodyColumns, OwnColumns, bool,
               double, double, std::array<double, 3>, std::array<double, 3>>;

State state_of(const Arrays& arrays) {
  State state;
  state.position = vectors(std::get<0>(arrays));
  state.velocity = vectors(std::get<1>(arrays));
  state.orientation = vectors(std::get<2>(arrays));
  state.angular_velocity = vectors(std::get<3>(arrays));
  if (const Images& image = std::get<4>(arrays)) state.image = vectors(*image);
  if (const Ids& id = std::get<5>(arrays)) state.id.assign(id->data(), id->data() + id->size());
  if (const SpeciesIndices& species = std::get<6>(arrays)) {
    state.species.assign(species->data(), species->data() + species->size());
  }
  auto& [names, length, diameter, mass, k, q, inertia] = state.bodies;  // no q: inertia says it
  std::tie(names, length, diameter, mass, k, inertia) = std::get<7>(arrays);
  OwnBodies& own = state.own_bodies;
  std::vector<double>* const columns[] = {&own.length, &own.diameter, &own.mass, &own.inertia};
  for (std::size_t n = 0; n < std::size(columns); ++n) {
    if (const auto& column = std::get<8>(arrays)[n])
      columns[n]->assign(column->data(), column->data() + column->size());
  }
  if (std::get<9>(arrays)) state.velocity.swap(state.peculiar_velocity);
  state.slide = std::get<10>(arrays);
  state.shear_rate = std::get<11>(arrays);
  state.box = std::get<12>(arrays);
  state.low = std::get<13>(arrays);
  return state;
}

std::unique_ptr<Run> make_run(std::optional<std::string> text, std::string name, bool has_lines,
                              const std::optional<Arrays>& arrays, bool force) {
  std::optional<State> state;
  if (arrays) state = state_of(*arrays);
  return std::make_unique<Run>(SceneSource{std::move(text), std::move(name), has_lines},
                               std::move(state), force);
}

template <std::string (Run::*call)(const runs::Limits&, const py::object&)>
std::string limited(Run& run, OptionalNumber time, std::optional<std::uint64_t> collisions,
                    OptionalNumber collisions_per_needle, OptionalNumber energy_ratio,
                    OptionalNumber wall_s, const py::object& show) {
  return (run.*call)({.time = time,
                      .collisions = collisions,
                      .collisions_per_needle = collisions_per_needle,
                      .energy_ratio = energy_ratio,
                      .wall_s = wall_s},
                     show);
}

}  // namespace

void add_run(py::module_& module) {
  module.attr("no_rotation_given") = runs::no_rotation_given;
  py::class_<Run>(module, "Run")
      .def(py::init(&make_run))
      .def_static("resume", [](const std::string& file) { return std::make_unique<Run>(file); })
      .def("run", limited<&Run::run>, "time"_a, "collisions"_a, "collisions_per_needle"_a,
           "energy_ratio"_a, "wall_s"_a, "show"_a)
      .def("advance", limited<&Run::advance>, "time"_a, "collisions"_a, "collisions_per_needle"_a,
           "energy_ratio"_a, "wall_s"_a, "show"_a)
      .def("interrupt", &Run::interrupt)
      .def("on_collisions", &Run::on_collisions)
      .def("on_happenings", &Run::on_happenings)
      .def("set_velocities",
           [](Run& run, const Rows& velocity, const Rows& angular_velocity) {
             run.set_velocities(vectors(velocity), vectors(angular_velocity));
           })
      .def("sample", &Run::sample)
      .def("set_data", &Run::set_data)
      .def("data", &Run::data)
      .def("velocities_set", &Run::velocities_set)
      .def("save", &Run::save)
      .def("checkpoint", &Run::checkpoint)
      .def("close", &Run::close)
      .def("state", &Run::state)
      .def("totals", &Run::totals)
      .def("species_totals", &Run::species_totals)
      .def("collisions_by_pair", &Run::collisions_by_pair)
      .def("wall_totals", &Run::wall_totals)
      .def("energy_budget", &Run::energy_budget)
      .def("rod_totals", &Run::rod_totals)
      .def("sliding_contacts", &Run::sliding_contacts)
      .def("growth", &Run::growth)
      .def("stress", &Run::stress)
      .def("flow", &Run::flow)
      .def("box", &Run::box)
      .def("counters", &Run::counters)
      .def("facts", &Run::facts)
      .def("time", &Run::time)
      .def("mean_free_time", &Run::mean_free_time)
      .def("hash", &Run::hash)
      .def("warnings", &Run::warnings);
}

}  // namespace needlework::python
