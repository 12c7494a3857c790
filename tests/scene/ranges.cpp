// The range of a key is said in one place: what it reads, what it refuses and its words agree.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>
#include <set>
#include <string>

#include "src/scene/schema.h"

namespace needlework {
namespace {

std::set<double> numbers_in(const std::string& text) {
  static const std::regex number(R"(-?\d+(\.\d+)?(e-?\d+)?)");
  std::set<double> out;
  for (std::sregex_iterator found(text.begin(), text.end(), number), end; found != end; ++found)
    out.insert(std::stod(found->str()));
  return out;
}

TEST(RangeOfAKey, IsThatOfItsWords) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  int limits = 0;
  for (const SceneKey& key : scene_keys()) {
    const auto& [least, greatest, or_zero] = key.range;
    const std::set<double> said = numbers_in(std::string(key.expected));
    for (const double limit : {least, greatest}) {
      if (std::abs(limit) > 1e300 || limit == std::numeric_limits<double>::denorm_min()) continue;
      // Edges of boxes have a least that depends on the needles; accelerations have directions.
      if (key.key == "box" && limit == least) continue;
      // 9223372036854775807 is rounded.
      EXPECT_TRUE(said.contains(std::abs(limit)) || said.contains(limit))
          << key.section << "." << key.key << ": " << limit << " of: " << key.expected;
      ++limits;
    }
    if (least == std::numeric_limits<double>::lowest() || key.key == "frames") continue;
    // Keys of real numbers read both ends, and nothing beyond.
    const bool is_whole = key.key == "count" || key.key == "seed" || key.key == "threads" ||
                          key.key == "grid" || key.key == "size_classes";
    if (is_whole || key.key == "gravity" || key.key == "motion.tangential") continue;
    EXPECT_TRUE(accepts(key, {least})) << key.section << "." << key.key;
    EXPECT_TRUE(accepts(key, {greatest})) << key.section << "." << key.key;
    EXPECT_EQ(accepts(key, {0.0}), or_zero || (least <= 0 && greatest >= 0)) << key.key;
    EXPECT_FALSE(accepts(key, {std::nextafter(greatest, infinity)})) << key.key;
    EXPECT_FALSE(accepts(key, {std::nan("")})) << key.key;
    if (least != std::numeric_limits<double>::denorm_min()) {
      EXPECT_FALSE(accepts(key, {std::nextafter(least, -infinity)}) &&
                   !(or_zero && std::nextafter(least, -infinity) == 0))
          << key.key;
    }
  }
  EXPECT_GT(limits, 50);
}

}  // namespace
}  // namespace needlework
