// Accuracies as a user meets them: pairs/accuracy.csv holds pairs on which they differ.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/oracle.h"

namespace needlework::test {
namespace {

class Accuracy : public ProgramTest {
 protected:
  static inline const std::string pairs = NEEDLEWORK_SOURCE "/tests/cli/pairs/accuracy.csv";

  /// Contact times by id.
  std::vector<double> times(const std::string& flags) const {
    std::vector<double> out;
    std::istringstream lines(output_of("predict " + pairs + ' ' + flags));
    for (std::string line; std::getline(lines, line);) {
      out.push_back(std::strtod(line.c_str() + line.find(',') + 1, nullptr));
    }
    return out;
  }

  struct Shown {
    std::string what;     ///< that the pair shows
    OracleAnswer answer;  ///< of the oracle
  };
  /// By id.
  static std::vector<Shown> shown() {
    std::vector<Shown> out;
    std::ifstream file(pairs);
    for (std::string line; std::getline(file, line);) {
      if (line.empty() || line[0] == '#') continue;
      std::istringstream fields(line);
      std::string id, what, field;
      std::getline(std::getline(fields, id, ','), what, ',');
      std::vector<double> numbers;
      while (std::getline(fields, field, ',')) numbers.push_back(std::stod(field));
      if (numbers.size() != 26) throw std::runtime_error("expected 28 columns: " + line);
      const auto three = [&](std::size_t at) {
        return std::array{numbers[at], numbers[at + 1], numbers[at + 2]};
      };
      const auto needle = [&](std::size_t at) {
        FreeNeedle out;
        out.position = three(at);
        out.orientation = three(at + 3);
        out.velocity = three(at + 6);
        out.angular_velocity = three(at + 9);
        return out;
      };
      out.push_back({what, first_contact(needle(1), needle(13), numbers[0], numbers[25] != 0)});
    }
    return out;
  }
};

/// The same contact, or none for either.
bool same_contact(double a, double b) {
  return std::isinf(a) || std::isinf(b) ? a == b : std::abs(a - b) <= 1e-9 * a;
}

TEST_F(Accuracy, PairsDistinguishTheLevels) {
  const auto standard = times("--accuracy standard"), rigorous = times("--accuracy rigorous");
  const auto fast = times("--accuracy fast"), sampling = times("--isolation sampling");
  const auto all = shown();
  ASSERT_EQ(all.size(), standard.size());
  std::map<std::string, int> seen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [what, truth] = all[i];
    SCOPED_TRACE("pair " + std::to_string(i));
    ++seen[what];
    // Not so near to the other decision that rounding its numbers could flip it.
    EXPECT_GT(truth.decision_margin, 8);
    EXPECT_TRUE(same_contact(standard[i], truth.time)) << standard[i] << ' ' << truth.time;
    EXPECT_TRUE(same_contact(rigorous[i], truth.time)) << rigorous[i] << ' ' << truth.time;
    if (what == "sampling") {
      EXPECT_GT(sampling[i], truth.time * (1 + 1e-9));
    } else if (what == "fast") {
      EXPECT_FALSE(same_contact(fast[i], truth.time));
    } else {
      // The engine makes directors unit vectors in double, the oracle with all digits.
      EXPECT_LE(std::abs(rigorous[i] - truth.time), std::nextafter(truth.time, 9) - truth.time);
      EXPECT_GT(std::abs(standard[i] - truth.time), std::abs(rigorous[i] - truth.time));
    }
  }
  EXPECT_GE(seen["sampling"], 5);
  EXPECT_GE(seen["fast"], 10);
  EXPECT_GE(seen["last-bits"], 3);
}

TEST_F(Accuracy, KnobsDepartFromTheLevel) {
  EXPECT_EQ(times("--accuracy fast --escalation undecided --root-tolerance 0"),
            times("--accuracy standard"));
  EXPECT_EQ(times("--accuracy standard --isolation intervals --escalation always"),
            times("--accuracy rigorous"));
  const auto coarse = times("--isolation sampling --sampling-step 0.5");
  const auto fine = times("--isolation sampling --sampling-step 1e-4");
  const auto standard = times("");
  const auto found = [&](const std::vector<double>& all) {
    int count = 0;
    for (std::size_t i = 0; i < all.size(); ++i) count += same_contact(all[i], standard[i]);
    return count;
  };
  EXPECT_GT(found(fine), found(coarse));
}

TEST_F(Accuracy, BadKnobsAreUsageErrors) {
  for (const char* flags : {"--accuracy best", "--isolation none", "--escalation maybe",
                            "--root-tolerance 0.1", "--sampling-step 0"}) {
    EXPECT_EQ(run("predict " + pairs + ' ' + flags).exit_code, 2) << flags;
  }
}

// A trajectory depends on the accuracy, and at equal accuracy on nothing else.
TEST_F(Accuracy, RunsDifferByAccuracyAndByNothingElse) {
  write("gas.toml", "needles = {count = 200, box = 6}\nuntil.collisions_per_needle = 4\n");
  std::map<std::string, std::string> hashes;
  for (const char* accuracy : {"fast", "standard", "rigorous"}) {
    for (const char* how : {"--set engine.search=all-pairs", "--set engine.search=linked-cells",
                            "--set engine.search=capsules", "--threads 2 --isa scalar"}) {
      const auto report = json_of(
          std::string("run gas.toml --json --quiet --set engine.accuracy=") + accuracy + ' ' + how);
      EXPECT_EQ(report.at("accuracy"), accuracy);
      const std::string hash = report.at("trajectory_hash");
      EXPECT_EQ(hashes.try_emplace(accuracy, hash).first->second, hash) << accuracy << how;
    }
  }
  EXPECT_NE(hashes["fast"], hashes["standard"]);
  EXPECT_NE(hashes["rigorous"], hashes["standard"]);
  EXPECT_EQ(json_of("run gas.toml --json --quiet --set engine.isolation=sampling "
                    "--set engine.filter=double")
                .at("accuracy"),
            "standard, isolation sampling, filter double");
}

// The filter is no part of what a contact is.
TEST_F(Accuracy, TheFilterChangesNoBit) {
  write("gas.toml", "needles = {count = 300, box = 5}\nuntil.collisions_per_needle = 4\n");
  const auto one = json_of("run gas.toml --json --quiet");
  const auto two = json_of("run gas.toml --json --quiet --set engine.filter=double");
  EXPECT_EQ(one.at("trajectory_hash"), two.at("trajectory_hash"));
  EXPECT_EQ(two.at("stats").at("isolated"), 0);
}

}  // namespace
}  // namespace needlework::test
