// Data of a C program's own, and samples that it asks for.
#include <string>

#include "tests/c/c_simulation.h"
#include "tests/cli/program.h"
#include "tests/support/contains.h"

namespace needlework {
namespace {

using test::cooling;
using test::CSimulation;

class CData : public ProgramTest {
 protected:
  const std::string file = path("gas.h5");
  std::string scene_with_file() const { return cooling + "output.file = \"" + file + "\"\n"; }

  static int set(const CSimulation& simulation, const char* name, const std::string& value,
                 int kind = NEEDLEWORK_DATA_BYTES) {
    return needlework_set_data(simulation, name, kind, value.data(), value.size());
  }
  static std::string get(const CSimulation& simulation, const char* name) {
    std::size_t size = 0;
    EXPECT_EQ(needlework_get_data(simulation, name, nullptr, nullptr, 0, &size), NEEDLEWORK_OK);
    std::string value(size, ' ');
    EXPECT_EQ(needlework_get_data(simulation, name, nullptr, value.data(), size, &size),
              NEEDLEWORK_OK);
    return value;
  }
};

TEST_F(CData, ComesBackWithTheRun) {
  const std::string bytes("\0\xff x", 4);
  {
    const CSimulation first(scene_with_file());
    ASSERT_NE(first, nullptr) << first.error.message;
    EXPECT_EQ(set(first, "bytes", bytes), NEEDLEWORK_OK) << first.message();
    EXPECT_EQ(set(first, "notes", "[1, 2]", NEEDLEWORK_DATA_JSON), NEEDLEWORK_OK);
    EXPECT_EQ(set(first, "empty", ""), NEEDLEWORK_OK);
    EXPECT_EQ(needlework_close(first), NEEDLEWORK_OK);
  }
  const CSimulation second = CSimulation::resumed(file);
  ASSERT_NE(second, nullptr) << second.error.message;
  EXPECT_EQ(get(second, "bytes"), bytes);
  EXPECT_EQ(get(second, "empty"), "");
  int kind = -1;
  EXPECT_EQ(needlework_get_data(second, "notes", &kind, nullptr, 0, nullptr), NEEDLEWORK_OK);
  EXPECT_EQ(kind, NEEDLEWORK_DATA_JSON);
  EXPECT_STREQ(needlework_data_name(second, 0), "bytes");
  EXPECT_STREQ(needlework_data_name(second, 2), "notes");
  EXPECT_EQ(needlework_data_name(second, 3), nullptr);
  EXPECT_EQ(needlework_set_data(second, "bytes", 0, nullptr, 0), NEEDLEWORK_OK);
  EXPECT_STREQ(needlework_data_name(second, 0), "empty");
}

TEST_F(CData, IsRefusedIfItCannotBeCarried) {
  const CSimulation simulation(cooling);
  EXPECT_EQ(set(simulation, "", "x"), NEEDLEWORK_USAGE);
  EXPECT_EQ(set(simulation, "notes", "[1, 2", NEEDLEWORK_DATA_JSON), NEEDLEWORK_USAGE);
  EXPECT_EQ(simulation.message(), "data: notes = [1, 2: expected JSON in UTF-8");
  EXPECT_EQ(set(simulation, "notes", "x", 7), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_set_data(simulation, "notes", 0, "x", std::size_t{1} << 25),
            NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_set_data(simulation, nullptr, 0, "x", 1), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_get_data(simulation, "notes", nullptr, nullptr, 0, nullptr),
            NEEDLEWORK_USAGE);
  EXPECT_EQ(set(simulation, "notes", "four"), NEEDLEWORK_OK);
  char small[3];
  std::size_t size = 0;
  EXPECT_EQ(needlework_get_data(simulation, "notes", nullptr, small, 3, &size), NEEDLEWORK_USAGE);
  EXPECT_EQ(size, 4u);
  EXPECT_EQ(simulation.message(), "capacity = 3: expected at least 4");
}

TEST_F(CData, GoesToTheFileWithASampleAtAnyTime) {
  {
    const CSimulation simulation(scene_with_file());
    ASSERT_NE(simulation, nullptr) << simulation.error.message;
    EXPECT_EQ(set(simulation, "notes", "here"), NEEDLEWORK_OK);
    simulation.run_to(50);
    EXPECT_EQ(needlework_sample(simulation, 1), NEEDLEWORK_OK);
    EXPECT_EQ(needlework_close(simulation), NEEDLEWORK_OK);
    EXPECT_EQ(needlework_sample(simulation, 1), NEEDLEWORK_USAGE);
  }
  const Outcome info = run("info " + file);
  EXPECT_TRUE(
      test::contains(info.out, {"/user_data: 1 value, time 0 to 0", "60 particles, 2 frames"}));
  const CSimulation without_file(cooling);
  EXPECT_EQ(needlework_sample(without_file, 0), NEEDLEWORK_USAGE);
}

}  // namespace
}  // namespace needlework
