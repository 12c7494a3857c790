#include "src/report/run_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <utility>

#include "src/io/formats/material.h"
#include "src/report/frames.h"
#include "src/report/lag_means.h"
#include "src/report/scene_facts.h"

namespace needlework::report {

using Json = nlohmann::ordered_json;

namespace {

// JSON has no NaN and no infinity; both become null.
Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json parameters_of(const io::Contents& contents) {
  Json out = Json::object();
  for (const std::string& name : contents.names("/parameters")) {
    const std::string path = "/parameters/" + name;
    Json value;
    if (const auto texts = contents.texts(path)) {
      value = texts->size() == 1 ? Json(texts->front()) : Json(*texts);
    } else {
      const std::vector<double> numbers = contents.numbers(path);
      value = numbers.size() == 1 ? number(numbers.front()) : Json(numbers);
    }
    out[name] = {{"value", value}, {"description", contents.description(path)}};
  }
  return out;
}

std::size_t product(const std::vector<std::size_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

/// Of values of each species, or each pair of them, which come first in a row, those of one.
struct Part {
  std::size_t index = 0, of = 1;
};

// A group of /series whose datasets have one row for each sample, or are constants.
class Group {
 public:
  Group(const io::Contents& contents, std::string path) : contents_(contents), path_(path) {
    for (const std::string& name : contents.names(path)) {
      const std::string dataset = path + "/" + name;
      if (!contents.is_dataset(dataset) || contents.texts(dataset)) continue;
      const bool has_rows = contents.has(dataset + "/value");
      // Steps and times of the samples are no observables, but the element time of contacts is one.
      if ((name == "step" || name == "time") && !has_rows) continue;
      datasets_.push_back({name, dataset, contents.shape(dataset), has_rows});
      if (has_rows && !timed_) timed_ = dataset;
    }
  }

  bool empty() const { return datasets_.empty(); }

  Json read(const PageLimits& limits, Arrays& arrays, const Part& part = {}) const {
    Json out = {{"description", contents_.description(path_)}};
    std::size_t rows = timed_ ? contents_.shape(*timed_).at(0) : 0;
    auto chosen = evenly(rows, std::min(limits.samples, affordable_rows(limits)));
    // Rows left out would be missing in the mean.
    std::optional<LagMeans> means;
    if (rows > 0 && path_ == "/series/time_correlation") {
      means.emplace(contents_, path_);
      out["mean_of_rows"] = means->rows();
      chosen = {rows - 1};
      rows = 1;
    }
    out["rows_in_file"] = rows;
    out["rows"] = chosen.size();
    if (timed_ && contents_.is_dataset(*timed_ + "/time")) {
      const auto times = contents_.rows(*timed_ + "/time", chosen);
      out["time"] = arrays.add(std::span<const double>(times), {times.size()});
    }
    out["datasets"] = Json::object();
    for (const Dataset& dataset : datasets_) {
      std::vector<double> values = !dataset.has_rows ? contents_.numbers(dataset.path)
                                   : means           ? means->of(dataset.path)
                                                     : contents_.rows(dataset.path, chosen);
      out["datasets"][dataset.name] =
          described(dataset, std::move(values), chosen.size(), arrays, part);
    }
    return out;
  }

 private:
  struct Dataset {
    std::string name, path;
    std::vector<std::size_t> shape;
    bool has_rows;
    std::size_t row_size() const {
      return product(std::vector<std::size_t>(shape.begin() + 1, shape.end()));
    }
    // Rows as large as fields are for pictures, which single precision is enough for.
    bool is_picture() const { return has_rows && row_size() > 1000; }
  };

  std::size_t affordable_rows(const PageLimits& limits) const {
    std::size_t bytes = 0;
    for (const Dataset& dataset : datasets_) {
      if (!dataset.has_rows) continue;
      bytes += dataset.row_size() * (dataset.is_picture() ? sizeof(float) : sizeof(double));
    }
    return limits.group_bytes / std::max<std::size_t>(bytes, 1);
  }

  // The part of these values of a dataset that is of one species, or of all.
  Json described(const Dataset& dataset, std::vector<double> values, std::size_t rows,
                 Arrays& arrays, const Part& part) const {
    std::vector<std::size_t> shape = dataset.shape;
    if (dataset.has_rows) shape[0] = rows;
    if (dataset.has_rows && part.of > 1 && shape.size() > 1 && shape[1] == part.of) {
      shape.erase(shape.begin() + 1);
      const std::size_t width = dataset.row_size() / part.of;
      std::vector<double> of_part;
      for (std::size_t row = 0; row < rows; ++row) {
        const auto begin =
            values.begin() + static_cast<std::ptrdiff_t>((row * part.of + part.index) * width);
        of_part.insert(of_part.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
      }
      values = std::move(of_part);
    }
    Json out = {{"description", contents_.description(dataset.path)},
                {"has_rows", dataset.has_rows}};
    if (dataset.is_picture()) {
      const std::vector<float> single(values.begin(), values.end());
      out.update(arrays.add(std::span<const float>(single), shape));
    } else {
      out.update(arrays.add(std::span<const double>(values), shape));
    }
    return out;
  }

  const io::Contents& contents_;
  std::string path_;
  std::vector<Dataset> datasets_;
  std::optional<std::string> timed_;
};

// The names of the species of a mixture; empty for one species.
std::vector<std::string> species_of(const io::Contents& contents) {
  if (!contents.has("/parameters/species")) return {};
  return contents.texts("/parameters/species").value_or(std::vector<std::string>{});
}

std::vector<double> parameter(const io::Contents& contents, const std::string& name) {
  const std::string path = "/parameters/" + name;
  return contents.has(path) ? contents.numbers(path) : std::vector<double>{};
}

Bodies bodies_of(const io::Contents& contents) {
  return {.names = species_of(contents),
          .length = parameter(contents, "length"),
          .diameter = parameter(contents, "diameter"),
          .mass = parameter(contents, "mass"),
          .k = parameter(contents, "k")};
}

// What the observables of a mixture are of: each species, or each two of them.
enum class Of { all, species, pairs };
Of what_of(const std::string& group) {
  constexpr std::array of_all = {"totals",        "theory",        "species", "walls",
                                 "rods",          "contacts",      "growth",  "contact_network",
                                 "energy_budget", "centre_of_mass"};
  if (std::ranges::find(of_all, group) != of_all.end()) return Of::all;
  const bool of_pairs =
      group == "pair_correlation" || group == "structure_factor" || group == "collision_statistics";
  return of_pairs ? Of::pairs : Of::species;
}

// The totals under "totals", and each group of /series under its name. Of a mixture those that are
// of this kind, and of each their part.
Json groups_of(const io::Contents& contents, const PageLimits& limits, Arrays& arrays,
               std::optional<Of> of = {}, const Part& part = {}) {
  Json out = Json::object();
  const auto add = [&](const std::string& name, const std::string& path) {
    if (of && what_of(name) != *of) return;
    const Group group(contents, path);
    if (!group.empty()) out[name] = group.read(limits, arrays, part);
  };
  add("totals", "/series");
  for (const std::string& name : contents.names("/series")) {
    if (!contents.is_dataset("/series/" + name)) add(name, "/series/" + name);
  }
  return out;
}

// Of more species a page would have hundreds of charts.
constexpr std::size_t most_in_parts = 8;

// The observables of each species and of each two of them, as those of a gas of one species.
Json parts_of(const io::Contents& contents, const std::vector<std::string>& species,
              const PageLimits& limits, Arrays& arrays) {
  Json out = Json::array();
  const auto add = [&](const std::string& name, Of of, const Part& part) {
    Json groups = groups_of(contents, limits, arrays, of, part);
    if (!groups.empty()) out.push_back({{"name", name}, {"groups", std::move(groups)}});
  };
  for (std::size_t n = 0; n < species.size(); ++n) {
    add(species[n], Of::species, {n, species.size()});
  }
  std::size_t pair = 0;
  for (std::size_t a = 0; a < species.size(); ++a) {
    for (std::size_t b = a; b < species.size(); ++b) {
      add(species[a] + "-" + species[b], Of::pairs,
          {pair++, species.size() * (species.size() + 1) / 2});
    }
  }
  return out;
}

}  // namespace

Json run_section(const std::string& path, const io::Contents& contents, const PageLimits& limits,
                 Arrays& arrays) {
  Json out = {{"kind", "run"}, {"file", path}, {"parameters", parameters_of(contents)}};
  const auto text = contents.texts("/parameters/scene");
  std::optional<Scene> scene;
  const Bodies bodies = bodies_of(contents);
  if (text && text->size() == 1)
    scene = recorded_scene(text->front(), path, bodies, parameter(contents, "counts"));
  out["scene"] = scene ? scene_facts(*scene) : Json(nullptr);
  // When a caller has replaced the velocities, after which the gas does what no theory says.
  const bool has_changes =
      contents.has("/velocities_set/time") && contents.shape("/velocities_set/time").at(0) > 0;
  out["velocities_set"] =
      has_changes ? number(contents.numbers("/velocities_set/time").front()) : Json(nullptr);
  if (has_changes && out["scene"].is_object()) out["scene"]["ratio_of_theory"] = nullptr;
  const std::vector<std::string> species = species_of(contents);
  if (species.empty()) {
    out["groups"] = groups_of(contents, limits, arrays);
  } else {
    out["groups"] = groups_of(contents, limits, arrays, Of::all);
    if (species.size() <= most_in_parts) {
      out["parts"] = parts_of(contents, species, limits, arrays);
    }
  }
  BodySizes sizes;
  if (!bodies.length.empty()) sizes.lengths = bodies.length;
  sizes.diameters = bodies.diameter;
  const auto walls = io::single_walls(scene ? scene->walls : std::vector<Scene::Wall>{});
  out["frames"] = frames_of(path, sizes, walls, limits, arrays);
  return out;
}

}  // namespace needlework::report
