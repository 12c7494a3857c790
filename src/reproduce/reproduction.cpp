#include "src/reproduce/reproduction.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "needlework/error.h"
#include "src/io/atomic_file.h"

namespace needlework::reproduce {
namespace {

using Json = nlohmann::ordered_json;

Row row_of(const Measurement& measurement, const Figure& figure, std::span<const Claim> claims) {
  const auto claim = std::find_if(claims.begin(), claims.end(),
                                  [&](const Claim& one) { return one.id == measurement.claim; });
  if (claim == claims.end()) throw std::logic_error(measurement.claim + ": no such claim");
  Row row{*claim, figure.name, measurement.variant, measurement.measured};
  if (measurement.stated) row.claim.paper = *measurement.stated;
  row.verdict = verdict_of(row.claim.paper, row.measured);
  return row;
}

Json optional(const std::optional<double>& number) {
  return number && std::isfinite(*number) ? Json(*number) : Json(nullptr);
}

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

}  // namespace

std::string Row::id() const {
  return variant.empty() ? claim.id : fmt::format("{} [{}]", claim.id, variant);
}

std::vector<Row> reproduce(const Figure& figure, const PaperRuns& runs,
                           std::span<const Claim> claims) {
  const FigureResult result = figure.make(runs);
  const std::string file = fmt::format("{}/figure-{}", runs.folder(), figure.name);
  write_text(file + ".csv", csv_of(result.table));
  write_text(file + ".svg", picture::svg(result.chart));
  std::vector<Row> rows;
  for (const Measurement& measurement : result.measurements) {
    rows.push_back(row_of(measurement, figure, claims));
  }
  return rows;
}

std::string json_of(std::span<const Row> rows, Size size) {
  std::vector<std::string> lines;
  for (const Row& row : rows) {
    const Json line{{"id", row.id()},
                    {"figure", row.figure},
                    {"paper", optional(row.claim.paper.number)},
                    {"measured", optional(row.measured.value)},
                    {"error", optional(row.measured.error)},
                    {"verdict", name_of(row.verdict)},
                    {"precision", optional(row.claim.paper.precision)},
                    {"seeds", row.measured.seeds ? Json(*row.measured.seeds) : Json(nullptr)},
                    {"claim", row.claim.id},
                    {"variant", text_or_null(row.variant)},
                    {"statement", row.claim.statement},
                    {"quantity", row.claim.quantity},
                    {"where", text_or_null(row.claim.where)},
                    {"reading", text_or_null(row.claim.reading)}};
    lines.push_back(line.dump(-1, ' ', false, Json::error_handler_t::replace));
  }
  return fmt::format("{{\"size\": \"{}\", \"claims\": [\n{}\n]}}\n", name_of(size),
                     fmt::join(lines, ",\n"));
}

void write_text(const std::string& path, const std::string& text) {
  io::AtomicFile file(path, true);
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw IoError(path + ": cannot be written");
  file.publish();
}

std::string csv_of(const Table& table) {
  std::string text = fmt::format("{}\n", fmt::join(table.columns, ","));
  for (const std::vector<double>& row : table.rows) {
    for (std::size_t column = 0; column < row.size(); ++column) {
      if (column > 0) text += ',';
      if (!std::isnan(row[column])) text += fmt::format("{:.7g}", row[column]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace needlework::reproduce
