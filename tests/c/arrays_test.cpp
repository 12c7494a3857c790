// States of a C program's own arrays, whatever their layout.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/c/c_simulation.h"
#include "tests/support/contains.h"

namespace needlework {
namespace {

using test::Arrays;
using test::cooling;
using test::CSimulation;
using test::expect_same_start;

const std::string rule = "collisions = { epsilon = 0.9, tc_relative = 1e-3 }\n";

/// The simulation starts from this state, and runs as one that was made of its rows.
void expect_runs_as(const CSimulation& given, const Arrays& rows) {
  ASSERT_NE(given, nullptr) << given.error.message;
  expect_same_start(Arrays(given), rows);
  const CSimulation of_rows(rule, rows.initial(5));
  of_rows.run_to(200);
  given.run_to(200);
  EXPECT_EQ(given.hash(), of_rows.hash());
}

TEST(CArrays, MayBeColumnMajorAsInFortran) {
  const CSimulation drawn(cooling);
  const Arrays rows(drawn);
  const std::ptrdiff_t n = 60;
  // real(8) :: position(N, 3): the components of a needle are N numbers apart.
  Arrays columns(n);
  const auto layout = [&](std::vector<double>& to) { return needlework_vectors{to.data(), 1, n}; };
  const needlework_state into{layout(columns.position),
                              layout(columns.velocity),
                              layout(columns.orientation),
                              layout(columns.angular_velocity),
                              nullptr,
                              nullptr};
  EXPECT_EQ(needlework_get_state(drawn, &into), NEEDLEWORK_OK);
  for (std::ptrdiff_t needle = 0; needle < n; ++needle) {
    for (std::ptrdiff_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(columns.position[needle + axis * n], rows.position[3 * needle + axis]);
      EXPECT_EQ(columns.orientation[needle + axis * n], rows.orientation[3 * needle + axis]);
    }
  }
  needlework_initial initial = columns.initial(5);
  for (needlework_const_vectors* vectors :
       {&initial.position, &initial.velocity, &initial.orientation, &initial.angular_velocity}) {
    vectors->row = 1;
    vectors->column = n;
  }
  initial.id = nullptr;  // those of a drawn state are 0 to N - 1 as well
  const CSimulation given(rule, initial);
  expect_runs_as(given, rows);
}

TEST(CArrays, MayLieInStructuresAndBackwards) {
  const CSimulation drawn(cooling);
  const Arrays rows(drawn);
  struct Needle {
    double mass, r[3], v[3], u[3], w[3];
  };
  std::vector<Needle> needles(60);
  // From the last needle to the first: a negative stride.
  const std::ptrdiff_t row = -static_cast<std::ptrdiff_t>(sizeof(Needle) / sizeof(double));
  Needle& last = needles.back();
  const needlework_state into{{last.r, row, 1}, {last.v, row, 1}, {last.u, row, 1},
                              {last.w, row, 1}, nullptr,          nullptr};
  EXPECT_EQ(needlework_get_state(drawn, &into), NEEDLEWORK_OK);
  EXPECT_EQ(needles.back().r[1], rows.position[1]);
  EXPECT_EQ(needles.front().w[2], rows.angular_velocity[3 * 59 + 2]);
  EXPECT_EQ(needles.front().mass, 0) << "what lies between is not touched";
  const needlework_initial initial{
      60,     {5, 5, 5}, {last.r, row, 1}, {last.v, row, 1}, {last.u, row, 1}, {last.w, row, 1},
      nullptr};
  const CSimulation given(rule, initial);
  expect_runs_as(given, rows);
}

TEST(CArrays, MayLeaveOutVelocitiesIdsAndTheBoxOfTheScene) {
  const double position[] = {1, 1, 1, 3, 3, 3}, orientation[] = {2, 0, 0, 0, 0, -3};
  needlework_initial initial{};
  initial.count = 2;
  initial.position.data = position;
  initial.orientation.data = orientation;
  const CSimulation given("needles.box = 6\n", initial);
  ASSERT_NE(given, nullptr) << given.error.message;
  Arrays expected(2);
  expected.position = {1, 1, 1, 3, 3, 3};
  expected.orientation = {1, 0, 0, 0, 0, -1};
  expected.id = {0, 1};
  expect_same_start(Arrays(given), expected);
}

TEST(CArrays, ComeBackByIncreasingId) {
  const std::uint32_t ids[] = {900, 7, 30};
  const double position[] = {1, 1, 1, 2, 2, 2, 3, 3, 3},
               orientation[] = {1, 0, 0, 1, 0, 0, 1, 0, 0};
  needlework_initial initial{};
  initial.count = 3;
  std::fill(initial.box, initial.box + 3, 5);
  initial.position.data = position;
  initial.orientation.data = orientation;
  initial.id = ids;
  const CSimulation given("", initial);
  ASSERT_NE(given, nullptr) << given.error.message;
  const Arrays arrays(given);
  EXPECT_EQ(arrays.id, (std::vector<std::uint32_t>{7, 30, 900}));
  EXPECT_EQ(arrays.position, (std::vector<double>{2, 2, 2, 3, 3, 3, 1, 1, 1}));
}

TEST(CArrays, GoOnFromTheirImages) {
  const CSimulation drawn(cooling);
  drawn.run_to(100);
  const Arrays arrays(drawn);
  EXPECT_NE(arrays.image, std::vector<std::int32_t>(180));
  const CSimulation given(rule, arrays.initial(5), arrays.image);
  ASSERT_NE(given, nullptr) << given.error.message;
  expect_same_start(Arrays(given), arrays);
  EXPECT_EQ(Arrays(given).image, arrays.image);
  const CSimulation from_0(rule, arrays.initial(5));
  EXPECT_EQ(Arrays(from_0).image, std::vector<std::int32_t>(180));
  given.run_to(200);
  from_0.run_to(200);
  EXPECT_EQ(given.hash(), from_0.hash());
  std::vector<std::int32_t> sum = Arrays(from_0).image;
  for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += arrays.image[n];
  EXPECT_EQ(Arrays(given).image, sum);
}

// What cannot be simulated is refused with what is wrong about it.
class CArraysRefused : public testing::Test {
 protected:
  void expect_refused(const std::string& scene, const needlework_initial& initial, int code,
                      const std::string& part) {
    const CSimulation simulation(scene, initial);
    EXPECT_EQ(simulation, nullptr);
    EXPECT_EQ(simulation.error.code, code);
    EXPECT_TRUE(test::contains(std::string(simulation.error.message), part))
        << simulation.error.message;
  }
  Arrays arrays_{CSimulation(cooling)};
  static constexpr double nan_ = std::numeric_limits<double>::quiet_NaN();
};

TEST_F(CArraysRefused, ForImpossibleCounts) {
  needlework_initial initial = arrays_.initial(5);
  // Too many for ids, for the memory of any machine, and for a product with 3 in 64 bits.
  for (const std::size_t count : {std::size_t{1} << 32, std::size_t{1} << 62, ~std::size_t{0}}) {
    initial.count = count;
    expect_refused(rule, initial, NEEDLEWORK_USAGE, "initial->count = " + std::to_string(count));
  }
  initial.count = 4294967294u;
  expect_refused(rule, initial, NEEDLEWORK_INPUT, "of memory");
  initial = arrays_.initial(5);
  expect_refused("needles.count = 59\n" + rule, initial, NEEDLEWORK_INPUT, "needles.count = 59");
}

TEST_F(CArraysRefused, ForABoxThatIsMissingWrongOrNoNumber) {
  expect_refused(rule, arrays_.initial(0), NEEDLEWORK_USAGE, "initial->box");
  expect_refused(rule, arrays_.initial(1), NEEDLEWORK_INPUT, "box edge 1");
  expect_refused(rule, arrays_.initial(-5), NEEDLEWORK_INPUT, "box edge -5");
  expect_refused(rule, arrays_.initial(nan_), NEEDLEWORK_INPUT, "box edge nan");
  expect_refused(rule, arrays_.initial(1.1e9), NEEDLEWORK_INPUT,
                 "box edge 1100000000: expected from 2.01 to 1000000000");
  expect_refused(rule, arrays_.initial(std::numeric_limits<double>::infinity()), NEEDLEWORK_INPUT,
                 "box edge inf");
  expect_refused("needles.box = 6\n" + rule, arrays_.initial(5), NEEDLEWORK_INPUT, "needles.box");
  expect_refused("needles.box = 6\n" + rule, arrays_.initial(nan_), NEEDLEWORK_INPUT,
                 "needles.box");
}

TEST_F(CArraysRefused, ForIdsThatAreNotDistinct) {
  arrays_.id[5] = arrays_.id[50];
  expect_refused(rule, arrays_.initial(5), NEEDLEWORK_INPUT, "id 50 twice");
}

TEST_F(CArraysRefused, ForAnImageWithoutAnOpposite) {
  arrays_.image[3 * 7 + 1] = std::numeric_limits<std::int32_t>::min();
  const CSimulation simulation(rule, arrays_.initial(5), arrays_.image);
  EXPECT_EQ(simulation.error.code, NEEDLEWORK_INPUT);
  EXPECT_STREQ(simulation.error.message,
               "state: needle 7: image = -2147483648: expected a whole number from -2147481599 to "
               "2147481599");
}

TEST_F(CArraysRefused, ForNumbersThatAreNone) {
  const Arrays good = arrays_;
  for (std::vector<double> Arrays::*column :
       {&Arrays::position, &Arrays::velocity, &Arrays::orientation, &Arrays::angular_velocity}) {
    arrays_ = good;
    (arrays_.*column)[3 * 7 + 1] = nan_;
    expect_refused(rule, arrays_.initial(5), NEEDLEWORK_INPUT, "needle 7");
  }
  arrays_ = good;
  std::fill_n(&arrays_.orientation[3 * 7], 3, 0);
  expect_refused(rule, arrays_.initial(5), NEEDLEWORK_INPUT, "needle 7");
}

TEST_F(CArraysRefused, ForASceneThatDescribesAnotherState) {
  expect_refused("initial.t_tr = 2\n" + rule, arrays_.initial(5), NEEDLEWORK_INPUT,
                 "initial.t_tr = 2");
  expect_refused("initial.file = \"a.h5\"\n" + rule, arrays_.initial(5), NEEDLEWORK_INPUT,
                 "initial.file");
}

TEST_F(CArraysRefused, WithoutPositionsOrDirectors) {
  needlework_initial initial = arrays_.initial(5);
  initial.position.data = nullptr;
  expect_refused(rule, initial, NEEDLEWORK_USAGE, "initial->position.data is NULL");
  initial = arrays_.initial(5);
  initial.orientation.data = nullptr;
  expect_refused(rule, initial, NEEDLEWORK_USAGE, "initial->orientation.data is NULL");
}

}  // namespace
}  // namespace needlework
