// Reads the series of finished runs.
#include <algorithm>

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

// Calls `store` for each row with the sample that it belongs to.
template <class Number, class Store>
void read_series(const Source& source, const std::string& name, std::vector<Totals>& series,
                 Store store) {
  const Element element(source, "/series/" + name);
  const auto times = element.times();
  if (!times)
    throw InputError(source.place(element.name()) + ": no times: expected one for each row");
  series.resize(element.rows());
  const std::vector<Number> values = element.read<Number>(std::nullopt);
  const std::size_t width = element.shape()[0] ? values.size() / element.shape()[0] : 0;
  for (std::size_t row = 0; row < series.size(); ++row) {
    series[row].time = times->at(row);
    store(series[row], values.data() + row * width);
  }
}

}  // namespace

// Adding a member fails to compile here.
static void transfer(Archive& archive, RecordedRun& run) {
  auto& [scene, version, needles, series, walls] = run;
  archive(scene, version, needles, series, walls);
}

static std::vector<WallTotals> read_walls(const Source& source, std::size_t samples) {
  const std::string group = "/series/walls";
  if (samples == 0 || !hdf5::is_group(source.get(), group, source.place(group))) return {};
  const std::vector<double> axes = Element(source, group + "/axis").read<double>(std::nullopt);
  const std::vector<double> high = Element(source, group + "/high").read<double>(std::nullopt);
  const Element hits(source, group + "/hits"), impulse(source, group + "/impulse");
  const auto require = [&](bool condition) {
    if (!condition) throw InputError(source.place(group) + ": expected walls as run writes them");
  };
  require(high.size() == axes.size());
  std::vector<WallTotals> out;
  for (const Element* each : {&hits, &impulse}) {
    require(each->shape().size() == 2 && each->shape()[1] == axes.size() &&
            each->rows() >= samples);
  }
  const auto counts = hits.read<std::uint64_t>(samples - 1);
  const auto sums = impulse.read<double>(samples - 1);
  for (std::size_t n = 0; n < axes.size(); ++n) {
    require(axes[n] == 0 || axes[n] == 1 || axes[n] == 2);
    out.push_back({static_cast<int>(axes[n]), high[n] != 0, counts[n], sums[n]});
  }
  return out;
}

static RecordedRun read_run_here(const std::string& path, bool with_series) {
  const Source source(path);
  RecordedRun run;
  run.scene = read_text(source, "/parameters/scene");
  run.version = read_text(source, "/parameters/version");
  run.needles = Element(source, "/particles/needles/id").rows();
  if (!with_series) return run;
  const auto read = [&](const char* name, double Totals::*member) {
    read_series<double>(source, name, run.series,
                        [&](Totals& sample, const double* value) { sample.*member = *value; });
  };
  const auto read_count = [&](const char* name, std::uint64_t Totals::*member) {
    read_series<std::uint64_t>(
        source, name, run.series,
        [&](Totals& sample, const std::uint64_t* value) { sample.*member = *value; });
  };
  read("t_tr", &Totals::t_tr);
  read("t_rot", &Totals::t_rot);
  read("energy", &Totals::energy);
  read_count("collisions", &Totals::collisions);
  read_count("tc_collisions", &Totals::tc_collisions);
  read_series<double>(source, "momentum", run.series, [](Totals& sample, const double* value) {
    std::copy_n(value, 3, sample.momentum.begin());
  });
  run.walls = read_walls(source, run.series.size());
  return run;
}

RecordedRun read_run(const std::string& path, bool with_series) {
  return read_in_child_process(path, [&] { return read_run_here(path, with_series); });
}

}  // namespace needlework::io
