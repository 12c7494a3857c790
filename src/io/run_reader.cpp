// Reads the series of finished runs.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <type_traits>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/in_child_process.h"
#include "src/io/source.h"
#include "src/trajectory/saved_totals.h"

namespace needlework::io {
namespace {

std::string read_text(const Source& source, const std::string& path) {
  const std::string place = source.place(path);
  if (!hdf5::is_dataset(source.get(), path, place)) {
    throw InputError(place + ": missing: expected a file that needlework run has written");
  }
  const auto texts = hdf5::read_strings(hdf5::open_dataset(source.get(), path, place).get(), place);
  if (texts.size() != 1) throw InputError(place + ": expected a single string");
  return texts.front();
}

template <class Number>
void copy_row(const Number* row, Number& to) {
  to = *row;
}
template <class Number, std::size_t size>
void copy_row(const Number* row, std::array<Number, size>& to) {
  std::copy_n(row, size, to.begin());
}

// Reads a sum of all samples, and their times.
template <class Value>
void read_sum(const Source& source, const std::string& name, std::vector<Totals>& series,
              Value Totals::*member) {
  const Element element(source, "/series/" + name);
  const auto times = element.times();
  if (!times)
    throw InputError(source.place(element.name()) + ": no times: expected one for each row");
  series.resize(element.rows());
  constexpr bool is_count = std::is_integral_v<Value>;
  const auto values =
      element.read<std::conditional_t<is_count, std::uint64_t, double>>(std::nullopt);
  constexpr std::size_t width = sizeof(Value) / sizeof(values[0]);
  if (values.size() != width * series.size())
    throw InputError(fmt::format("{}: expected {} in each row", source.place(element.name()),
                                 width == 1 ? "a number" : fmt::format("{} numbers", width)));
  for (std::size_t row = 0; row < series.size(); ++row) {
    series[row].time = times->at(row);
    copy_row(values.data() + row * width, series[row].*member);
  }
}

}  // namespace

// Adding a member fails to compile here.
static void transfer(Archive& archive, RecordedRun& run) {
  auto& [scene, version, needles, series, walls, pressure, energy, growth] = run;
  archive(scene, version, needles, series, walls, pressure);
  archive(energy.pairs, energy.walls, energy.thermostat, energy.kicks, energy.gravity, energy.shear,
          energy.growth, energy.cooling, energy.velocities_set, growth);
}

namespace {

// A dataset [samples][walls] of a group.
Element of_each_wall(const Source& source, const std::string& path, std::size_t samples,
                     std::size_t walls) {
  Element out(source, path);
  if (out.shape().size() != 2 || out.shape()[1] != walls || out.rows() < samples)
    throw InputError(source.place(path) + ": expected walls as run writes them");
  return out;
}

bool has_group(const Source& source, const std::string& group) {
  return hdf5::is_group(source.get(), group, source.place(group));
}

void read_walls(const Source& source, RecordedRun& run) {
  const std::string group = "/series/walls";
  const std::size_t samples = run.series.size();
  if (samples == 0 || !has_group(source, group)) return;
  const std::vector<double> axes = Element(source, group + "/axis").read<double>(std::nullopt);
  const std::vector<double> high = Element(source, group + "/high").read<double>(std::nullopt);
  const auto of_each = [&](const char* name) {
    return of_each_wall(source, group + "/" + name, samples, axes.size());
  };
  const auto hits = of_each("hits").read<std::uint64_t>(samples - 1);
  const auto impulses = of_each("impulse").read<double>(samples - 1);
  const auto pressures = of_each("pressure").read<double>(std::nullopt);
  for (std::size_t n = 0; n < axes.size(); ++n) {
    if (high.size() != axes.size() || !(axes[n] == 0 || axes[n] == 1 || axes[n] == 2))
      throw InputError(source.place(group) + ": expected walls as run writes them");
    run.walls.push_back({static_cast<int>(axes[n]), high[n] != 0, hits[n], impulses[n]});
    // Each row is a mean since the one before.
    double sum = 0;
    for (std::size_t row = 1; row < samples; ++row) {
      const double step = run.series[row].time - run.series[row - 1].time;
      if (step > 0) sum += step * pressures[row * axes.size() + n];
    }
    run.pressure.push_back(sum / (run.series.back().time - run.series.front().time));
  }
}

void read_energy_budget(const Source& source, RecordedRun& run) {
  const std::string group = "/series/energy_budget";
  const std::size_t samples = run.series.size();
  if (samples == 0 || !has_group(source, group)) return;
  const auto last = [&](const char* name) -> std::optional<double> {
    const std::string path = group + "/" + name;
    if (!has_group(source, path)) return {};
    return Element(source, path).read<double>(samples - 1).at(0);
  };
  run.energy.pairs = last("pairs").value_or(0);
  run.energy.thermostat = last("thermostat");
  run.energy.kicks = last("kicks");
  run.energy.gravity = last("gravity");
  run.energy.shear = last("shear");
  run.energy.growth = last("growth");
  run.energy.cooling = last("cooling");
  run.energy.velocities_set = last("velocities_set").value_or(0);
  if (run.walls.empty()) return;
  run.energy.walls =
      of_each_wall(source, group + "/walls", samples, run.walls.size()).read<double>(samples - 1);
}

void read_growth(const Source& source, RecordedRun& run) {
  const std::size_t samples = run.series.size();
  for (const auto& [group, prefix] :
       {std::pair<std::string, std::string>("/series/growth", "growth_"),
        {"/series/contact_network", "network_"}}) {
    if (samples == 0 || !has_group(source, group)) continue;
    const hdf5::Handle opened = hdf5::open_group(source.get(), group, source.place(group));
    for (const std::string& name : hdf5::children(opened.get(), source.place(group))) {
      run.growth.emplace_back(prefix + name,
                              Element(source, group + "/" + name).read<double>(samples - 1).at(0));
    }
  }
}

}  // namespace

static RecordedRun read_run_here(const std::string& path, bool with_series) {
  const Source source(path);
  RecordedRun run;
  run.scene = read_text(source, "/parameters/scene");
  run.version = read_text(source, "/parameters/version");
  run.needles = Element(source, "/particles/needles/id").rows();
  if (!with_series) return run;
  Totals::for_each_sum(
      [&](const Described& sum, auto member) { read_sum(source, sum.name, run.series, member); });
  read_walls(source, run);
  read_energy_budget(source, run);
  read_growth(source, run);
  return run;
}

RecordedRun read_run(const std::string& path, bool with_series) {
  return read_in_child_process(path, [&] { return read_run_here(path, with_series); });
}

}  // namespace needlework::io
