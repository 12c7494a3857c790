#include "src/report/report.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "needlework/error.h"
#include "src/io/contents.h"
#include "src/io/formats/text_file.h"
#include "src/report/arrays.h"
#include "src/report/bench_section.h"
#include "src/report/page.h"
#include "src/report/run_section.h"
#include "src/report/sweep_section.h"

namespace needlework::report {

using Json = nlohmann::ordered_json;

namespace {

constexpr const char* accepted =
    "expected a run (.h5), the summary.h5 of a sweep, or results of benchmarks (.json)";

std::string first_bytes(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_directory(path, ignored) &&
      !std::filesystem::is_regular_file(path, ignored)) {
    throw IoError(path + ": cannot be read: not a regular file");
  }
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(fmt::format("{}: is a folder: {}", path, accepted));
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path + ": cannot be read: expected a file that exists");
  std::array<char, 64> bytes{};
  file.read(bytes.data(), bytes.size());
  return {bytes.data(), static_cast<std::size_t>(file.gcount())};
}

bool looks_like_json(const std::string& bytes) {
  const auto first = bytes.find_first_not_of(" \t\r\n");
  return first != bytes.npos && bytes[first] == '{';
}

Json section_of(const std::string& path, const PageLimits& limits, Arrays& arrays) {
  const std::string bytes = first_bytes(path);
  if (looks_like_json(bytes)) return bench_section(path);
  if (!bytes.starts_with("\x89HDF")) throw InputError(fmt::format("{}: {}", path, accepted));
  const io::Contents contents(path);
  if (contents.has("/sweep/grid")) return sweep_section(path, contents, limits, arrays);
  if (contents.has("/particles")) return run_section(path, contents, limits, arrays);
  throw InputError(
      fmt::format("{}: an HDF5 file with neither /particles nor /sweep: {}", path, accepted));
}

// The parser of HTML ends a script at "</script" and reads "<!--" as well, wherever they stand.
std::string json_for_html(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

void write_report(const Request& request) {
  io::TextFile file(request.out, request.force);
  Arrays arrays;
  Json data = {{"version", NEEDLEWORK_VERSION}, {"title", request.title}};
  data["sections"] = Json::array();
  for (const std::string& path : request.files) {
    data["sections"].push_back(section_of(path, request.limits, arrays));
  }
  const std::string_view page = page_text();
  const auto mark = page.find(data_mark);
  if (mark == page.npos) throw std::logic_error("page.html: no place for the data");
  file.write(page.substr(0, mark));
  file.write(fmt::format("<script type=\"application/json\" id=\"data\">{}</script>\n",
                         json_for_html(data)));
  for (const std::string& block : arrays.blocks()) file.write(block);
  file.write(page.substr(mark + data_mark.size()));
  file.publish();
}

}  // namespace needlework::report
