// What `needlework audit` prints, how it ends, and how it is continued.
#include <string>

#include "tests/cli/program.h"

namespace needlework {
namespace {

using nlohmann::json;

class AuditCommand : public ProgramTest {
 protected:
  AuditCommand() {
    write("cooling.toml", R"(needles = { count = 200, box = 7 }
collisions = { epsilon = 0.8, tc_relative = 1e-3 }
until.collisions_per_needle = 60
)");
    write("sliding.toml", R"(needles = { count = 120, box = 5 }
collisions = { epsilon = 0.5, sliding = true }
until.collisions_per_needle = 8
)");
    write("growing.toml", R"(needles = { count = 100, box = 8, diameter = 0.9 }
driving.growth = { rate = 0.05, until_packing = 0.4 }
until.collisions_per_needle = 60
)");
  }

  // The first piece ends soon after the program has begun to listen to signals. Each is twice as
  // long as the one before, so that they reach the end on any machine.
  void goes_on(const std::string& audit) {
    json whole = run(audit + " --json").json();
    const std::string listens =
        "grep -q '^Name:.*needlework' /proc/$!/status && grep -q '^SigCgt.*[2367abef]$' "
        "/proc/$!/status";
    int pieces = 0;
    double seconds = 0.01;
    Outcome outcome;
    do {
      outcome = run_and_signal(audit + " --json --state audit.state",
                               listens + " && sleep " + std::to_string(seconds), "INT");
      EXPECT_EQ(exists("audit.state"), outcome.exit_code == 75);
      seconds *= 2;
    } while (outcome.exit_code == 75 && ++pieces);
    EXPECT_GT(pieces, 0);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    json resumed = outcome.json();
    for (const char* key : {"wall_s", "cpu_s"}) {
      whole.erase(key);
      resumed.erase(key);
    }
    EXPECT_EQ(resumed, whole);
    EXPECT_FALSE(exists("audit.state"));
  }
};

TEST_F(AuditCommand, PrintsOneJsonObjectForACleanRun) {
  const Outcome outcome = run("audit small.toml --json");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  const json result = outcome.json();
  for (const char* kind : {"missed", "spurious", "late", "early", "wrong_order", "wrong_rule"}) {
    EXPECT_EQ(result[kind], 0) << kind;
    EXPECT_NEAR(result["bound95"][kind].get<double>(), 2.9957 / 250, 1e-5) << kind;
  }
  EXPECT_EQ(result["wrong_start"], 0);
  EXPECT_EQ(result["wrong_end"], 0);
  EXPECT_EQ(result["collisions"], 250);
  EXPECT_EQ(result["contacts"], 250);
  EXPECT_GT(result["checked"].get<int>(), 250 * 97);
  EXPECT_TRUE(result["undecided"].is_number_integer());
  EXPECT_TRUE(result["complete"].get<bool>());
  EXPECT_EQ(result["differences"].size(), 0u);
}

TEST_F(AuditCommand, PrintsATable) {
  EXPECT_TRUE(
      contains(output_of("audit small.toml"), {"flights of pairs checked", "missed", "undecided"}));
  EXPECT_EQ(run("audit small.toml --quiet").out, "");
}

TEST_F(AuditCommand, SaysByHowMuchRodsOverlap) {
  EXPECT_FALSE(run("audit small.toml --json").json().contains("overlap"));
  const std::string rods = "audit small.toml --set needles.diameter=0.1";
  const json overlap = run(rods + " --json").json()["overlap"];
  EXPECT_GT(overlap["at_collisions"].get<double>(), 0);
  EXPECT_LT(overlap["at_collisions"], overlap["at_most"]);
  EXPECT_LT(overlap["at_most"].get<double>(), 1e-11);
  const Outcome text = run(rods);
  EXPECT_TRUE(contains(text.out, "of the diameter is the largest at a collision"));
}

TEST_F(AuditCommand, ChecksNeedlesThatSlideButNotBesideWallsAndKicks) {
  const std::string sliding = "audit sliding.toml";
  const json result = json_of(sliding + " --json");
  EXPECT_GT(result["contacts_entered"], 5);
  EXPECT_GE(result["contacts_entered"], result["contacts_ended"]);
  EXPECT_TRUE(contains(run(sliding).out, "sliding contacts checked"));
  write("between_walls.toml",
        "needles = { count = 20, box = 5 }\ncollisions = { epsilon = 0.5, sliding = true }\n"
        "until.time = 1\nwalls = [{ axis = \"z\", side = \"both\" }]\n");
  for (const std::string& scene :
       {sliding + " --set driving.kicks.every=0.1 --set driving.kicks.translational=1",
        std::string("audit between_walls.toml")}) {
    const Outcome clean = run(scene);
    EXPECT_EQ(clean.exit_code, 0) << clean.out << clean.err;
  }
}

TEST_F(AuditCommand, ChecksBodiesThatGrow) {
  const std::string growing = "audit growing.toml --set until.collisions_per_needle=6";
  const json result = json_of(growing + " --json");
  EXPECT_GT(result["coolings"], 2);
  EXPECT_TRUE(contains(run(growing).out, "at which velocities were scaled back"));
  EXPECT_TRUE(run(growing + " --set collisions.tc_relative=1e-3 --set collisions.epsilon=0.9")
                  .fails(3, "expected no collisions.tc_relative"));
}

TEST_F(AuditCommand, TakesAShareOfThePairs) {
  const json all = run("audit small.toml --json").json();
  const json some = run("audit small.toml --json --share 0.1 --seed 3").json();
  EXPECT_LT(some["checked"].get<double>(), 0.2 * all["checked"].get<double>());
  EXPECT_EQ(some["collisions"], all["collisions"]);
  EXPECT_EQ(some["checked"], run("audit small.toml --json --share 0.1 --seed 3").json()["checked"]);
  const json none = run("audit small.toml --json --share 1e-12").json();
  EXPECT_EQ(none["checked"], 0);
  EXPECT_TRUE(none["bound95"]["missed"].is_null());
  EXPECT_TRUE(run("audit small.toml --quiet --share 1e-12").complains("expected a larger share"));
}

TEST_F(AuditCommand, GoesOnWhereItWasInterrupted_long) {
  goes_on("audit cooling.toml");
  goes_on("audit cooling.toml --set needles.diameter=0.05 --set until.collisions_per_needle=20");
  goes_on("audit sliding.toml");
  goes_on("audit growing.toml");
}

TEST_F(AuditCommand, SavesWhenStopped) {
  const Outcome outcome =
      run("audit cooling.toml --set until.wall_s=0 --state audit.state --json --quiet");
  EXPECT_TRUE(outcome.fails(75, "saved in audit.state"));
  EXPECT_FALSE(outcome.json()["complete"].get<bool>());
  EXPECT_TRUE(exists("audit.state"));
  EXPECT_TRUE(run("audit small.toml --state audit.state")
                  .fails(3, "audit.state: the state of another audit"));
  write("audit.state", "{}");
  EXPECT_EQ(run("audit cooling.toml --state audit.state").exit_code, 3);
  EXPECT_EQ(run("audit cooling.toml --state nowhere/audit.state").exit_code, 5);
}

TEST_F(AuditCommand, NamesWhatIsWrongInItsInput) {
  EXPECT_TRUE(run("audit small.toml --set needles.box=2").fails(3, "needles.box"));
  EXPECT_EQ(run("audit none.toml").exit_code, 5);
  for (const std::string option : {"--share 2", "--share nan", "--share 0", "--seed -1"}) {
    EXPECT_EQ(run("audit small.toml " + option).exit_code, 2) << option;
  }
  EXPECT_EQ(run("audit small.toml --set initial.t_tr=0 --set initial.t_rot=0").exit_code, 3);
}

TEST_F(AuditCommand, EndsWithTheRun) {
  const Outcome collapse = run("audit cooling.toml --quiet --set collisions.tc_relative=1e-15");
  EXPECT_EQ(collapse.exit_code, 4) << collapse.err;
  EXPECT_EQ(run("audit small.toml --quiet --set until.time=0.5").exit_code, 0);
  EXPECT_EQ(run("audit small.toml --quiet --set needles.count=1 --set until.time=1").exit_code, 0);
}

}  // namespace
}  // namespace needlework
