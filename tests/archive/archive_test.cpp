// Values go through an archive and come back; bytes that are not theirs are refused.
#include "src/archive/archive.h"

#include <gtest/gtest.h>

#include <limits>

#include "needlework/error.h"

namespace needlework {

struct Point {
  double x = 0;
  std::vector<int> more;
  friend bool operator==(const Point&, const Point&) = default;
};

void transfer(Archive& archive, Point& point) { archive(point.x, point.more); }

namespace {

struct Values {
  bool flag = false;
  std::int64_t number = 0;
  double real = 0;
  std::string text;
  std::vector<Point> points;
  std::optional<double> some, none = 7.0;
  std::array<std::vector<float>, 2> pair;
  std::map<std::string, std::uint8_t> named;

  void pass(Archive& archive) {
    archive(flag, number, real, text, points, some, none, pair, named);
  }
  friend bool operator==(const Values&, const Values&) = default;
};

Values values() {
  Values out;
  out.flag = true;
  out.number = std::numeric_limits<std::int64_t>::min();
  out.real = -0.1;
  out.text = std::string("a\0b", 3);
  out.points = {{1, {}}, {2, {3, 4}}};
  out.some = 5;
  out.none.reset();
  out.pair = {std::vector<float>{}, std::vector<float>{1, 2}};
  out.named = {{"one", 1}, {"two", 2}};
  return out;
}

std::string saved() {
  std::string bytes;
  Archive archive = Archive::to(bytes);
  values().pass(archive);
  return bytes;
}

TEST(Archive, GivesBackWhatWasPut) {
  const std::string bytes = saved();
  Archive archive = Archive::from(bytes);
  Values out;
  out.points.resize(7);
  out.pass(archive);
  archive.require_end();
  EXPECT_EQ(out, values());
}

TEST(Archive, RefusesBytesThatAreCutShort) {
  const std::string bytes = saved();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string part = bytes.substr(0, size);
    Archive archive = Archive::from(part);
    Values out;
    EXPECT_THROW(out.pass(archive), InputError) << size;
  }
}

TEST(Archive, RefusesBytesThatAreLeft) {
  const std::string bytes = saved() + "x";
  Archive archive = Archive::from(bytes);
  Values out;
  out.pass(archive);
  EXPECT_THROW(archive.require_end(), InputError);
}

TEST(Archive, TakesNoMoreMemoryThanThereAreBytes) {
  std::string bytes;
  Archive out = Archive::to(bytes);
  std::uint64_t count = std::uint64_t{1} << 60;
  out(count);
  bytes += "some more";
  for (const auto read : {+[](Archive& in) {
                            std::string x;
                            in(x);
                          },
                          +[](Archive& in) {
                            std::vector<double> x;
                            in(x);
                          },
                          +[](Archive& in) {
                            std::vector<Point> x;
                            in(x);
                          }}) {
    Archive in = Archive::from(bytes);
    EXPECT_THROW(read(in), InputError);
  }
}

}  // namespace
}  // namespace needlework
