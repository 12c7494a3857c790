// Standard streams that are closed, as cron, daemons and some launchers leave them.
#include <string>

#include "tests/cli/program.h"

namespace needlework {
namespace {

// `needlework ARGUMENTS` with these redirections, such as 2>&-.
class StandardStreams : public ProgramTest {
 protected:
  Outcome run_with(const std::string& redirections, const std::string& arguments) const {
    return shell("( '" NEEDLEWORK_PROGRAM "' " + arguments + " " + redirections + " )");
  }
};

TEST_F(StandardStreams, WhereTheyAreClosedNoFileTakesTheirPlace) {
  ASSERT_EQ(run("run small.toml --quiet --out whole.h5").exit_code, 0);
  const std::string whole = hash_of("resume whole.h5");
  for (const std::string closed :
       {"2>&-", "1>&-", "0<&-", "1>&- 2>&-", "0<&- 2>&-", "0<&- 1>&- 2>&-"}) {
    // Every stream is written to: progress, a warning of the name, and the summary.
    const Outcome outcome =
        run_with(closed, "run small.toml --force --progress-every 0 --out run.data");
    EXPECT_EQ(outcome.exit_code, 0) << closed << outcome.err;
    EXPECT_EQ(run("info run.data").exit_code, 0) << closed;
    EXPECT_EQ(hash_of("resume run.data"), whole) << closed;
  }
}

TEST_F(StandardStreams, ErrorsKeepTheirExitCodesWhereNobodyHearsThem) {
  for (const std::string closed : {"2>&-", "2</dev/null", "2>/dev/full"}) {
    EXPECT_EQ(run_with(closed, "run absent.toml").exit_code, 5) << closed;
    EXPECT_EQ(run_with(closed, "run").exit_code, 2) << closed;
    EXPECT_EQ(run_with(closed, "run small.toml --progress-every 0 --out a.data --force").exit_code,
              0)
        << closed;
  }
}

TEST_F(StandardStreams, WhatNobodyCouldReadIsRefusedBeforeItIsDone) {
  ASSERT_EQ(run("run small.toml --quiet --out whole.h5").exit_code, 0);
  for (const std::string closed : {"1>&-", "1</dev/null"}) {
    for (const std::string arguments :
         {"run small.toml --json --out json.h5", "resume whole.h5 --json", "info whole.h5",
          "check small.toml", "theory small.toml", "serve", "bench --list", "help", "--version",
          "run --help"}) {
      EXPECT_TRUE(run_with(closed, arguments)
                      .fails(5, "standard output: is closed: expected it to be open"))
          << closed << arguments;
    }
    EXPECT_FALSE(exists("json.h5"));
    EXPECT_EQ(run_with(closed, "run small.toml --quiet").exit_code, 0) << closed;
  }
}

}  // namespace
}  // namespace needlework
