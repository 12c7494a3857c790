// The audit uses nothing of what it checks: it includes nothing of the engine but public headers
// (tests/layers/layers.py), and of these plain structs, not what computes.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

namespace needlework {
namespace {

TEST(AuditIndependence, TakesPlainStructsOfTheEngineAndCallsNothing) {
  const std::regex plain(
      "(accuracy|collision|composition|counters|described|error|happening|predict|scene|simulation|"
      "state|stop|totals)\\.h\"");
  const std::regex calls("predict\\(|Simulation[ (]");
  std::size_t files = 0, headers = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(NEEDLEWORK_SOURCE) + "/src/audit")) {
    if (entry.path().extension() == ".md") continue;
    ++files;
    std::ifstream text(entry.path());
    for (std::string line; std::getline(text, line);) {
      const std::string include = "#include \"needlework/";
      const bool is_public = line.starts_with(include);
      headers += is_public;
      EXPECT_TRUE(!is_public || std::regex_match(line.substr(include.size()), plain)) << line;
      EXPECT_FALSE(std::regex_search(line, calls)) << entry.path().filename() << ": " << line;
    }
  }
  EXPECT_GE(files, 8u);
  EXPECT_GT(headers, 0u);
}

}  // namespace
}  // namespace needlework
