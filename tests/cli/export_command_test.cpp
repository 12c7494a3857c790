// What `needlework export` does with files; tests/io/open_with_vtk.py reads what it writes.
#include "tests/cli/program.h"

namespace needlework {
namespace {

using ExportCommand = ProgramTest;

TEST_F(ExportCommand, KeepsAnExistingFileUnlessForced) {
  ASSERT_EQ(run("run small.toml --quiet --out a.h5").exit_code, 0);
  const std::string before = read("a.h5");
  const Outcome exported = run("export a.h5 a.vtkhdf");
  EXPECT_EQ(exported.exit_code, 0);
  EXPECT_EQ(exported.out + exported.err, "");
  EXPECT_EQ(files(), (std::vector<std::string>{"a.h5", "a.vtkhdf", small}));

  const Outcome refused = run("export a.h5 a.h5");
  EXPECT_EQ(refused.exit_code, 5);
  EXPECT_TRUE(refused.complains("a.h5: exists already: expected a new file, or --force"));
  EXPECT_EQ(read("a.h5"), before);
  EXPECT_EQ(run("export a.h5 a.vtkhdf --force").exit_code, 0);
}

TEST_F(ExportCommand, WritesNothingAfterAnError) {
  write("text.h5", "text");
  for (const auto& [arguments, message] :
       {std::pair{"absent.h5 a.vtkhdf", "absent.h5: No such file"},
        {"text.h5 a.vtkhdf", "text.h5: not an HDF5 file"},
        {"text.h5 x/a.vtkhdf", "x/a.vtkhdf: cannot be written: expected a folder that exists"}}) {
    const Outcome outcome = run(std::string("export ") + arguments);
    EXPECT_EQ(outcome.exit_code, 5) << arguments;
    EXPECT_TRUE(outcome.complains(message));
  }
  EXPECT_EQ(run("export text.h5").exit_code, 2);
  EXPECT_EQ(files(), (std::vector<std::string>{small, "text.h5"}));
}

}  // namespace
}  // namespace needlework
