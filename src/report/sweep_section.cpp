#include "src/report/sweep_section.h"

#include <nlohmann/json.hpp>

#include "needlework/error.h"

namespace needlework::report {

using Json = nlohmann::ordered_json;

namespace {

Json text_at(const io::Contents& contents, const std::string& path) {
  const auto texts = contents.texts(path);
  return texts && texts->size() == 1 ? Json(texts->front()) : Json(nullptr);
}

Json parameter_arrays(const io::Contents& contents) {
  Json out = Json::object();
  for (const std::string& name : contents.names("/parameters")) {
    const std::string path = "/parameters/" + name;
    const auto texts = contents.texts(path);
    out[name] = texts ? Json(*texts) : Json(contents.numbers(path));
  }
  return out;
}

// A quantity with mean and standard error, of which these rows are shown.
Json quantity_of(const io::Contents& contents, const std::string& path,
                 std::span<const std::size_t> rows, Arrays& arrays) {
  Json out = {{"description", contents.description(path)}};
  for (const char* part : {"mean", "standard_error"}) {
    const std::string name = path + "/" + part;
    std::vector<std::size_t> shape = contents.shape(name);
    const auto values = contents.rows(name, rows);
    if (!shape.empty()) shape[0] = rows.size();
    out[part] = arrays.add(std::span<const double>(values), shape);
  }
  return out;
}

Json quantities_of(const io::Contents& contents, const std::string& group,
                   std::span<const std::size_t> rows, Arrays& arrays) {
  Json out = Json::object();
  for (const std::string& name : contents.names(group)) {
    const std::string path = group + "/" + name;
    if (contents.is_dataset(path)) continue;
    out[name] = quantity_of(contents, path, rows, arrays);
  }
  return out;
}

Json series_of(const io::Contents& contents, const std::string& point, const PageLimits& limits,
               Arrays& arrays) {
  const std::string group = "/series/" + point;
  const std::size_t count = contents.shape(group + "/time").at(0);
  const auto rows = evenly(count, limits.samples);
  const auto times = contents.rows(group + "/time", rows);
  return {{"rows_in_file", count},
          {"rows", rows.size()},
          {"time", arrays.add(std::span<const double>(times), {times.size()})},
          {"quantities", quantities_of(contents, group, rows, arrays)}};
}

}  // namespace

Json sweep_section(const std::string& path, const io::Contents& contents, const PageLimits& limits,
                   Arrays& arrays) {
  const std::vector<double> count = contents.numbers("/members/count");
  const auto points = evenly(count.size(), count.size());
  Json out = {{"kind", "sweep"},
              {"file", path},
              {"grid", text_at(contents, "/sweep/grid")},
              {"scene", text_at(contents, "/sweep/scene")},
              {"version", text_at(contents, "/sweep/version")},
              {"parameters", parameter_arrays(contents)},
              {"members", count},
              {"results", quantities_of(contents, "/results", points, arrays)},
              {"series", Json::array()}};
  for (const std::string& point : contents.names("/series")) {
    out["series"].push_back(series_of(contents, point, limits, arrays));
  }
  return out;
}

}  // namespace needlework::report
