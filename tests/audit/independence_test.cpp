// The audit uses nothing of what it checks.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

namespace needlework {
namespace {

namespace fs = std::filesystem;

const fs::path root = NEEDLEWORK_SOURCE;

/// Files of this project that a file includes, by path from the root.
std::set<std::string> included_by(const fs::path& file) {
  std::set<std::string> out;
  const bool is_public = file.string().starts_with("needlework/");
  std::ifstream text(is_public ? root / "include" / file : root / file);
  EXPECT_TRUE(text) << file;
  for (std::string line; std::getline(text, line);) {
    const auto begin = line.find('"');
    if (line.find("#include") == std::string::npos || begin == std::string::npos) continue;
    out.insert(line.substr(begin + 1, line.find('"', begin + 1) - begin - 1));
  }
  return out;
}

/// All that a file includes, directly or not.
void collect(const std::string& file, std::set<std::string>& all) {
  if (!all.insert(file).second) return;
  for (const std::string& included : included_by(file)) collect(included, all);
}

TEST(AuditIndependence, IncludesNothingOfTheEngineButItsPlainStructs) {
  std::set<std::string> all;
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(root / "src/audit")) {
    if (entry.path().extension() == ".md") continue;
    ++files;
    collect("src/audit/" + entry.path().filename().string(), all);
  }
  ASSERT_GE(files, 8u);
  std::set<std::string> plain;
  for (const char* name :
       {"accuracy", "collision", "composition", "counters", "described", "error", "happening",
        "predict", "scene", "simulation", "state", "stop", "totals"}) {
    plain.insert(std::string("needlework/") + name + ".h");
  }
  for (const std::string& file : all) {
    EXPECT_TRUE(file.starts_with("src/audit/") || plain.contains(file)) << file;
  }
  EXPECT_TRUE(all.contains("needlework/collision.h"));  // of which collisions are checked
}

// Of those headers it uses the plain structs, not what computes.
TEST(AuditIndependence, CallsNothingOfTheEngine) {
  for (const auto& entry : fs::directory_iterator(root / "src/audit")) {
    if (entry.path().extension() == ".md") continue;
    std::ifstream text(entry.path());
    for (std::string line; std::getline(text, line);) {
      const bool calls = line.find("predict(") != std::string::npos ||
                         line.find("Simulation ") != std::string::npos ||
                         line.find("Simulation(") != std::string::npos;
      EXPECT_FALSE(calls) << entry.path().filename() << ": " << line;
    }
  }
}

}  // namespace
}  // namespace needlework
