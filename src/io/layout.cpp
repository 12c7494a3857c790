#include "src/io/layout.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include "src/box/own_numbers.h"
#include "src/io/column.h"
#include "src/io/descriptions.h"
#include "src/io/sums.h"
#include "src/io/tables.h"

namespace needlework::io {

using hdf5::check;
using hdf5::create_group;
using hdf5::Handle;
using hdf5::Shape;
using hdf5::type_of;

namespace {

constexpr hsize_t samples_per_chunk = 256;
constexpr hsize_t events_per_chunk = 8192;
constexpr hsize_t data_bytes_per_chunk = 16384;

// Frames of few needles share a chunk of about 16 kB; a large frame has a chunk of its own.
hsize_t frames_per_chunk(std::uint64_t needles) {
  return std::clamp<hsize_t>(16384 / (24 * std::max<std::uint64_t>(needles, 1)), 1, 64);
}

// The datasets `step` and `time` that elements sampled at the same times share.
struct StepAndTime {
  Handle step;
  Handle time;
};

StepAndTime make_step_and_time(hid_t group, const std::string& place) {
  return {Column::create(group, "step", type_of<std::int64_t>(), {}, samples_per_chunk, place),
          Column::create(group, "time", type_of<double>(), {}, samples_per_chunk, place)};
}

// Creates an H5MD element, whose step and time are hard links to the shared datasets.
void make_element(hid_t parent, const std::string& name, const StepAndTime& shared, hid_t type,
                  const Shape& row, hsize_t chunk_rows, const std::string& place) {
  const Handle group = create_group(parent, name, place);
  check(H5Olink(shared.step.get(), group.get(), "step", H5P_DEFAULT, H5P_DEFAULT), place);
  check(H5Olink(shared.time.get(), group.get(), "time", H5P_DEFAULT, H5P_DEFAULT), place);
  Column::create(group.get(), "value", type, row, chunk_rows, place);
}

void make_totals(hid_t group, const StepAndTime& shared, const std::string& place) {
  Totals::for_each_sum([&](const Described& sum, auto member) {
    using Value = ValueOf<decltype(member)>;
    make_element(group, sum.name, shared, type_of<typename InFile<Value>::Number>(),
                 InFile<Value>::shape(), samples_per_chunk, place);
  });
}

// Rows of few numbers share a chunk of about 16 kB; a large row has a chunk of its own.
hsize_t rows_per_chunk(std::size_t width) {
  return std::clamp<hsize_t>(16384 / (8 * std::max<std::size_t>(width, 1)), 1, samples_per_chunk);
}

void make_fields(hid_t series, const StepAndTime& shared, const std::vector<SeriesGroup>& groups,
                 const std::string& place) {
  for (const SeriesGroup& group : groups) {
    const Handle parent = create_group(series, group.name, place);
    for (const SeriesField& field : group.fields) {
      Shape row;
      for (const auto& extent : field.shape) row.push_back(extent.size);
      if (field.kind == SeriesField::Kind::constant) {
        hdf5::write_array<double>(parent.get(), field.name, row, field.values, place);
        continue;
      }
      const bool counts = field.kind == SeriesField::Kind::count;
      make_element(parent.get(), field.name, shared,
                   counts ? type_of<std::int64_t>() : type_of<double>(), row,
                   rows_per_chunk(field.width()), place);
    }
  }
}

Handle make_box(hid_t needles, const Scene& scene, const std::string& place) {
  Handle box = create_group(needles, "box", place);
  const std::int32_t dimension = 3;
  hdf5::write_attribute(box.get(), "dimension", std::span(&dimension, 1), {}, place);
  std::vector<std::string> boundary;
  for (const bool axis : scene.periodic()) boundary.emplace_back(axis ? "periodic" : "none");
  hdf5::write_attribute(box.get(), "boundary", boundary, place);
  if (scene.shear) hdf5::write_attribute(box.get(), "shear_rate", scene.shear->rate, place);
  return box;
}

StepAndTime make_needles(hid_t group, const Scene& scene, std::vector<std::uint8_t> species,
                         const OwnBodies& own, const std::string& place) {
  const std::uint64_t count = scene.needles.count;
  const hsize_t rows = frames_per_chunk(count);
  const Shape row{count, 3};
  // H5MD demands that box and image share the step and time of position.
  const Handle position = create_group(group, "position", place);
  StepAndTime shared = make_step_and_time(position.get(), place);
  Column::create(position.get(), "value", type_of<double>(), row, rows, place);
  make_element(group, "image", shared, type_of<std::int32_t>(), row, rows, place);
  for (const char* name : {"velocity", "orientation", "angular_velocity"}) {
    make_element(group, name, shared, type_of<double>(), row, rows, place);
  }
  if (scene.shear)
    make_element(group, "peculiar_velocity", shared, type_of<double>(), row, rows, place);
  // MDAnalysis reads the edges only if they are a matrix.
  const Handle box = make_box(group, scene, place);
  make_element(box.get(), "edges", shared, type_of<double>(), {3, 3}, 64, place);
  // H5MD has boxes begin at 0. Where a wall with a velocity has taken the low edge away from there,
  // readers need to know.
  if (scene.has_moving_walls())
    make_element(box.get(), "low", shared, type_of<double>(), {3}, 64, place);

  // H5MD knows no element of the particles with one number a frame.
  if (scene.driving.growth)
    make_element(box.get(), "scale", shared, type_of<double>(), {}, samples_per_chunk, place);

  std::vector<std::uint32_t> ids(count);
  std::iota(ids.begin(), ids.end(), 0u);
  hdf5::write_array<std::uint32_t>(group, "id", {count}, ids, place);
  species.resize(count);
  const Composition composition = scene.composition();
  std::vector<double> masses = own.mass;
  masses.reserve(count);
  for (std::size_t i = masses.size(); i < species.size(); ++i)
    masses.push_back(composition[species[i]].mass_or_infinity());
  hdf5::write_array<double>(group, "mass", {count}, masses, place);
  for (const auto& [name, column] : named_columns(own)) {
    const bool is_thin = column == &own.diameter && !composition.has_width();
    if (column == &own.mass || column->empty() || is_thin) continue;
    hdf5::write_array<double>(group, name, {count}, *column, place);
  }
  hdf5::write_array<std::uint8_t>(group, "species", {count}, species, place);
  return shared;
}

void make_events(hid_t group, bool has_kinds, const std::string& place) {
  const auto make = [&](const char* name, hid_t type, const Shape& row) {
    Column::create(group, name, type, row, events_per_chunk, place);
  };
  make("time", type_of<double>(), {});
  make("epoch", type_of<std::int64_t>(), {});
  make("offset", type_of<double>(), {});
  make("pair", type_of<std::uint32_t>(), {2});
  make("arms", type_of<double>(), {2});
  make("normal_velocity", type_of<double>(), {});
  make("tc", type_of<std::uint8_t>(), {});
  make("shift", type_of<std::int32_t>(), {3});
  make("impulse", type_of<double>(), {3});
  if (has_kinds) make("kind", type_of<std::uint8_t>(), {});
}

void make_velocities_set(hid_t group, const std::string& place) {
  make_step_and_time(group, place);
  for_each_of_velocities([&](const Described& sum, auto member) {
    Shape row = InFile<ValueOf<decltype(member)>>::shape();
    row.insert(row.begin(), 2);
    Column::create(group, sum.name, type_of<double>(), row, samples_per_chunk, place);
  });
}

void make_user_data(hid_t group, const std::string& place) {
  make_step_and_time(group, place);
  Column::create(group, "name", data_name_type(place).get(), {}, samples_per_chunk, place);
  Column::create(group, "json", type_of<std::uint8_t>(), {}, samples_per_chunk, place);
  Column::create(group, "begin", type_of<std::int64_t>(), {}, samples_per_chunk, place);
  Column::create(group, "size", type_of<std::int64_t>(), {}, samples_per_chunk, place);
  Column::create(group, "bytes", type_of<std::uint8_t>(), {}, data_bytes_per_chunk, place);
}

// H5MD 1.1 demands strings of fixed length in these attributes.
void make_metadata(hid_t file, const std::string& place) {
  const Handle h5md = create_group(file, "h5md", place);
  const std::array<std::int32_t, 2> version{1, 1};
  hdf5::write_attribute(h5md.get(), "version", version, {2}, place);
  const Handle author = create_group(h5md.get(), "author", place);
  hdf5::write_attribute(author.get(), "name", std::string("unknown"), place);
  const Handle creator = create_group(h5md.get(), "creator", place);
  hdf5::write_attribute(creator.get(), "name", std::string("needlework"), place);
  hdf5::write_attribute(creator.get(), "version", std::string(NEEDLEWORK_VERSION), place);
}

// What single numbers say of one species: arrays [species], and of each two [species][species].
void make_species(hid_t parameters, const Composition& composition, const std::string& place) {
  const auto size = composition.size();
  std::vector<std::string> names;
  std::vector<std::uint64_t> counts;
  for (const Species& each : composition.species()) {
    names.push_back(each.name);
    counts.push_back(each.count);
  }
  hdf5::write_array(parameters, "species", names, place);
  hdf5::write_array<std::uint64_t>(parameters, "counts", {size}, counts, place);
  const auto write_each = [&](const char* name, double Species::*member) {
    std::vector<double> values;
    for (const Species& each : composition.species()) values.push_back(each.*member);
    hdf5::write_array<double>(parameters, name, {size}, values, place);
  };
  write_each("length", &Species::length);
  std::vector<double> masses;
  for (const Species& each : composition.species()) masses.push_back(each.mass_or_infinity());
  hdf5::write_array<double>(parameters, "mass", {size}, masses, place);
  write_each("k", &Species::k);
  if (composition.has_width()) {
    write_each("diameter", &Species::diameter);
    std::vector<double> inertias;
    for (const Species& each : composition.species())
      inertias.push_back(each.inertia_or_infinity());
    hdf5::write_array<double>(parameters, "inertia", {size}, inertias, place);
  }
  const auto write_pairs = [&](const char* name, double Restitution::*member) {
    std::vector<double> values;
    for (const Restitution& rule : composition.rules()) values.push_back(rule.*member);
    hdf5::write_array<double>(parameters, name, {size, size}, values, place);
  };
  write_pairs("epsilon", &Restitution::epsilon);
  write_pairs("beta", &Restitution::beta);
}

void make_meetings(hid_t parameters, const Composition& composition, const std::string& place) {
  if (composition.all_meet()) return;
  const hsize_t size = composition.size();
  std::vector<std::uint8_t> values;
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = 0; b < size; ++b) values.push_back(composition.meets(a, b));
  }
  hdf5::write_array<std::uint8_t>(parameters, "meet", {size, size}, values, place);
}

void make_bodies(hid_t parameters, const Composition& composition, const std::string& place) {
  make_meetings(parameters, composition, place);
  if (composition.is_mixture()) return make_species(parameters, composition, place);
  const auto write = [&](const char* name, double value) {
    hdf5::write_scalar(parameters, name, value, place);
  };
  write("k", composition[0].k);
  write("length", composition[0].length);
  write("mass", composition[0].mass);
  if (composition.has_width()) {
    write("diameter", composition[0].diameter);
    write("inertia", composition[0].inertia());
  }
  write("epsilon", composition.restitution(0, 0).epsilon);
  write("beta", composition.restitution(0, 0).beta);
}

void make_parameters(hid_t file, const Scene& scene, const RunInfo& run, const std::string& place) {
  const Handle parameters = create_group(file, "parameters", place);
  const auto write = [&](const char* name, const auto& value) {
    hdf5::write_scalar(parameters.get(), name, value, place);
  };
  write("scene", scene.text);
  write("title", scene.title);
  write("version", std::string(NEEDLEWORK_VERSION));
  write("seed", scene.needles.seed);
  write("isa", run.isa);
  write("accuracy", run.accuracy);
  write("threads", static_cast<std::int32_t>(run.threads));
  write("epoch_length", run.epoch_length);
  make_bodies(parameters.get(), scene.composition(), place);
  // FrameFile passes over it.
  for (const std::string& name : run.assumed) {
    if (!hdf5::exists(parameters.get(), name, place)) continue;
    const Handle dataset = hdf5::open_dataset(parameters.get(), name, place);
    hdf5::write_text_attribute(dataset.get(), "assumed", "not in the file that was imported",
                               place);
  }
}

}  // namespace

void make_layout(hid_t file, const Scene& scene, const RunInfo& run, const std::string& place) {
  make_metadata(file, place);
  make_parameters(file, scene, run, place);
  const Handle particles = create_group(file, "particles", place);
  const StepAndTime frames = make_needles(create_group(particles.get(), "needles", place).get(),
                                          scene, run.species, run.own_bodies, place);
  make_totals(create_group(file, "observables", place).get(), frames, place);
  const Handle series = create_group(file, "series", place);
  const StepAndTime samples = make_step_and_time(series.get(), place);
  make_totals(series.get(), samples, place);
  make_fields(series.get(), samples, run.series, place);
  make_velocities_set(create_group(file, "velocities_set", place).get(), place);
  make_user_data(create_group(file, "user_data", place).get(), place);
  if (scene.output.events) {
    make_events(create_group(file, "events", place).get(), run.has_kinds, place);
  }
  // An object keeps its first description.
  const Composition composition = scene.composition();
  if (composition.has_width())
    write_descriptions(file, rod_descriptions(composition.is_mixture()), place);
  if (composition.is_mixture()) write_descriptions(file, mixture_descriptions(), place);
  if (!run.own_bodies.empty()) write_descriptions(file, own_body_descriptions(), place);
  if (!composition.all_meet()) write_descriptions(file, passing_descriptions(), place);
  if (!scene.walls.empty()) write_descriptions(file, wall_descriptions(), place);
  if (scene.has_moving_walls()) write_descriptions(file, moving_wall_descriptions(), place);
  if (scene.driving.growth) write_descriptions(file, growth_descriptions(), place);
  if (scene.shear) write_descriptions(file, shear_descriptions(), place);
  if (run.has_kinds) write_descriptions(file, event_kind_descriptions(), place);
  write_descriptions(file, run_file_descriptions(), place);
  write_descriptions(file, series_descriptions(run.series), place);
}

}  // namespace needlework::io
