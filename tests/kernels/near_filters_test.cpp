// The filters of neighbours, on every instruction set: no bounding volumes lost that overlap, no
// spheres that meet, and few others found.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/kernels/drawn_simd_pairs.h"
#include "tests/kernels/neighbourhoods.h"
#include "tests/support/oracle.h"
#include "tests/support/segments.h"

namespace needlework::kernels {
namespace {

using test::vec3;

// Places the seeker's capsule as its block holds it.
void place(Seeker& seeker, const WordFormat& format, const Vec3d& r, const Vec3d& u) {
  const auto words = BlockRow{r, u, true}.words(format, {});
  for (int axis = 0; axis < 3; ++axis) {
    seeker.r[axis] = static_cast<float>(format.coordinate(words[axis]));
    seeker.u[axis] = WordFormat::director(words[axis]);
  }
}

// Which of the needles 1 to count are among those found.
std::vector<bool> marked(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& found,
                         std::size_t count) {
  std::vector<bool> out(count);
  for (const auto& [needle, cell] : found) out[needle - 1] = true;
  return out;
}

// Places it exactly, for filters that take its path as an axis.
void place(Seeker& seeker, const Vec3d& r, const Vec3d& u) {
  for (int axis = 0; axis < 3; ++axis) {
    seeker.r[axis] = static_cast<float>(component(r, axis));
    seeker.u[axis] = static_cast<float>(component(u, axis));
  }
}

// Counts what is within a distance, which a filter must find, and what is beyond a wider one, which
// it must not. A negative length is that of no needle.
struct Counts {
  std::size_t within = 0, beyond = 0;

  void expect(const std::vector<bool>& found, const std::vector<double>& lengths, double distance,
              double wide, Isa isa) {
    for (std::size_t k = 0; k < lengths.size(); ++k) {
      if (lengths[k] < 0) continue;
      within += lengths[k] <= distance;
      beyond += lengths[k] > wide;
      const bool is_wrong = found[k] ? lengths[k] > wide : lengths[k] <= distance;
      ASSERT_FALSE(is_wrong) << (found[k] ? "found beyond " : "lost within ") << distance << ", at "
                             << lengths[k] << ", seed " << seed << ", " << name_of(isa);
    }
  }
};

// Capsules that just overlap, just do not, and any.
TEST(Overlapping, LosesNoCapsulesThatOverlapAndFindsFewOthers) {
  Random random(seed);
  Counts counts;
  for (std::size_t n = 0; n < 2000 / thin; ++n) {
    const double radius = random.log_uniform(1e-3, 10);
    const Vec3d corner{4, 4, 4}, r = vec3(random.direction()) * random.uniform(0, 1.7);
    const Vec3d u = vec3(random.direction());
    const Halves halves = any_halves(random);
    const double h1 = halves.first, h2 = halves.second;
    Motion motion{};
    motion.half = static_cast<float>(h1);
    Seeker seeker = seeker_of(motion, 1, h2);
    const double farthest = 2 * radius + 3;
    const WordFormat format = WordFormat::holding(4 - farthest, 4 + farthest);
    place(seeker, format, corner + r, u);
    std::vector<BlockRow> rows(40);
    std::vector<double> distance;
    for (BlockRow& row : rows) {
      Vec3d a = vec3(random.direction());
      const int kind = random.below(4);
      if (kind == 0) a = normalised(u + a * random.log_uniform(1e-9, 1e-2));
      Vec3d other = r + vec3(random.direction()) * random.uniform(0, 2 * radius + 1);
      if (kind < 3) {
        // Moved along their closest approach to overlap by very little, or not quite.
        const auto nearest = test::nearest_points(r, u, other, a, h1, h2);
        const double length = std::sqrt(dot(nearest.gap, nearest.gap));
        if (length > 1e-3) {
          const double wanted =
              2 * radius + (random.coin() ? 1 : -1) * random.log_uniform(1e-8, 1e-3);
          other = other + nearest.gap * ((length - wanted) / length);
        }
      }
      const Vec3d gap = test::nearest_points(r, u, other, a, h1, h2).gap;
      distance.push_back(std::sqrt(dot(gap, gap)));
      row = {corner + other, a, true};
    }
    const Neighbourhood near = fill(random, seeker, format, 0.1 * farthest, rows);
    for (const Isa isa : available()) {
      const std::vector<bool> found =
          marked(overlapping(near_kernels(isa), near, static_cast<float>(radius)), rows.size());
      // Squares of distances have a margin of 2^-14.
      const double wide =
          std::hypot(2 * radius + 1e-4 * (1 + radius) + 7 * format.step(), std::sqrt(0x1p-14));
      ASSERT_NO_FATAL_FAILURE(counts.expect(found, distance, 2 * radius, wide, isa));
    }
  }
  EXPECT_GT(counts.within, 20000 / thin * available().size());
  EXPECT_GT(counts.beyond, 5000 / thin * available().size());
}

// Thin capsules in small cells, so that places add little error. Where the square of the angle is
// about the 2^-16 by which rounded directors put it off, only the margin of squares saves the pair.
TEST(Overlapping, LosesNoCapsulesThatCrossAtSmallAngles_long) {
  Random random(seed);
  constexpr double half = 0.5, side = 0.066;
  const WordFormat format = WordFormat::holding(0, side);
  for (std::size_t n = 0; n < 10000 / thin; ++n) {
    const double radius = random.log_uniform(5e-5, 1e-4);
    const Vec3d r{0.5 * side, 0.5 * side, 0.5 * side}, u = vec3(random.direction());
    Motion motion{};
    motion.half = half;
    Seeker seeker = seeker_of(motion, 1, half);
    seeker.margin = 0x1p-16f;
    place(seeker, format, r, u);
    std::vector<BlockRow> rows(40);
    for (BlockRow& row : rows) {
      const Vec3d a = normalised(u + vec3(random.direction()) * random.log_uniform(2.5e-3, 4e-3));
      const Vec3d across = normalised(cross(u, a));
      const double s = random.uniform(-half, half), t = s + random.uniform(-0.3, 0.3) * side;
      const double distance = 2 * radius * (1 - random.log_uniform(1e-8, 1e-3));
      row = {r + u * s - a * t + across * distance, a, true};
    }
    const Neighbourhood near = fill(random, seeker, format, 0.05 * side, rows);
    for (const Isa isa : available()) {
      ASSERT_EQ(overlapping(near_kernels(isa), near, static_cast<float>(radius)).size(),
                rows.size())
          << "seed " << seed << ", case " << n << ", " << name_of(isa);
    }
  }
}

// Side by side, with places and a corner of the cell whose roundings all make them seem too far
// apart.
TEST(Overlapping, LosesNoCapsulesWhosePlacesAreFarthestOff) {
  Random random(seed);
  const WordFormat format = WordFormat::holding(0, 8);
  constexpr double half = 0.5;
  // Differences of places are whole steps. They are off most, by nearly one and a half, where the
  // true one is half a step more than a whole number.
  const double along_axis = 118.55 * format.step();
  const double radius = 0.5 * std::sqrt(3.0) * along_axis * (1 + 1e-6);
  for (std::size_t n = 0; n < 400 / thin; ++n) {
    double side[3];
    for (double& sign : side) sign = random.coin() ? 1 : -1;
    const Vec3d gap = Vec3d{side[0], side[1], side[2]} * along_axis;
    const Vec3d u = normalised(cross(gap, vec3(random.direction())));
    const double director[3] = {u.x, u.y, u.z};
    double from[3]{}, off[3]{}, squares = 0;
    float corner[3]{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto place_of = [&](double centre) {
        return static_cast<float>(format.coordinate(format.with_director(centre, director[axis])));
      };
      for (int draw = 0; draw < 100000 && off[axis] < 1.25 * format.step(); ++draw) {
        const double r = random.uniform(2, 6), other = r + side[axis] * along_axis;
        const auto offset = static_cast<float>(random.uniform(-1, 1));
        // As a filter has it: a step apart from each other.
        const float seen = (place_of(r) + (format.base - format.low)) - offset;
        const double seems =
            (place_of(other - offset) + (format.base - format.low)) - static_cast<double>(seen);
        const double more = side[axis] * seems - along_axis;
        if (more <= off[axis]) continue;
        off[axis] = more;
        from[axis] = r;
        corner[axis] = offset;
      }
      squares += off[axis] * off[axis];
    }
    ASSERT_GT(std::sqrt(squares), 2.4 * format.step());
    Motion motion{};
    motion.half = half;
    Seeker seeker = seeker_of(motion, 1, half);
    const Vec3d r{from[0], from[1], from[2]};
    place(seeker, format, r, u);
    const Vec3d relative = r + gap - Vec3d{corner[0], corner[1], corner[2]};
    Neighbourhood near = fill(random, seeker, format, 0, {{relative, u, true}});
    for (CellView& cell : near.cells) std::copy_n(corner, 3, cell.offset);
    for (const Isa isa : available()) {
      ASSERT_EQ(overlapping(near_kernels(isa), near, static_cast<float>(radius)).size(), 1U)
          << "seed " << seed << ", case " << n << ", " << name_of(isa);
    }
  }
}

// Whether |r + v s| <= reach for some s in [0, until], in many digits.
bool spheres_meet(const Vec3d& r, const Vec3d& v, double reach, double until) {
  const auto product = [](const Vec3d& a, const Vec3d& b) {
    return test::Quad(test::Quad(a.x) * b.x + test::Quad(a.y) * b.y + test::Quad(a.z) * b.z);
  };
  const test::Quad vv = product(v, v), rv = product(r, v);
  test::Quad s = vv > 0 ? test::Quad(-rv / vv) : test::Quad(0);
  s = std::min(std::max(s, test::Quad(0)), test::Quad(until));
  return product(r, r) + 2 * rv * s + vv * s * s <= test::Quad(reach) * reach;
}

// Centres in a cell of side 8 or up to 2 beyond, at times up to the longest, speeds around the unit
// and far from it.
TEST(Approaching, LosesNoSpheresThatMeetAndFindsFewOthers) {
  Random random(seed);
  std::size_t meetings = 0, found_apart = 0, apart = 0;
  const WordFormat format = WordFormat::holding(-2, 10);
  const double range = WordFormat::places * format.step();
  for (std::size_t n = 0; n < 2000 / thin; ++n) {
    const double now = random.uniform(0, longest_time), ahead = random.log_uniform(1e-3, 4);
    const auto speed = [&] {
      const int kind = random.below(8);
      return kind == 0 ? 0.0 : kind == 1 ? random.log_uniform(1e-6, 1e3) : 1.0;
    };
    const Halves halves = any_halves(random);
    const double reach = halves.first + halves.second;
    Flight mine;
    mine.r = vec3(random.direction()) * random.uniform(0, 3);
    mine.v = vec3(random.normal_vector(speed()));
    Seeker seeker = seeker_of(motion_of(mine, 0, 1, halves.first),
                              static_cast<float>(ahead) + test::simd_time_margin, halves.second);
    seeker.motion.time = seeker.now = static_cast<float>(now);
    std::vector<BlockRow> rows(40);
    std::vector<Flight> others(rows.size());
    std::vector<bool> fit(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
      Flight& other = others[k];
      const double age = random.below(3) == 0 ? 0 : random.uniform(0, now);
      other.v = vec3(random.normal_vector(speed()));
      other.r = vec3(random.direction()) * random.uniform(0, 4);
      if (random.coin()) {
        // Passing at a distance next to the reach.
        const Vec3d w = other.v - mine.v;
        const Vec3d across = normalised(cross(vec3(random.direction()), w + Vec3d{1e-30, 0, 0}));
        const double passing = reach + (random.coin() ? 1 : -1) * random.log_uniform(1e-9, 1e-2);
        other.r = mine.r + across * passing - w * random.uniform(0, 1.2 * ahead);
      }
      const Vec3d then = other.r - other.v * age - Vec3d{-4, -4, -4};
      // Its entry would have been written again before it has flown farther.
      const auto fits = [&](double from, double speed) {
        return from > -2 && from < 10 && std::abs(speed) * (age + ahead) < range;
      };
      fit[k] = fits(then.x, other.v.x) && fits(then.y, other.v.y) && fits(then.z, other.v.z);
      if (fit[k]) rows[k] = {then, other.v, false, static_cast<float>(now - age)};
    }
    const Neighbourhood near = fill(random, seeker, format, 0.5, rows);
    for (const Isa isa : available()) {
      const std::vector<bool> found = marked(approaching(near_kernels(isa), near), rows.size());
      for (std::size_t k = 0; k < rows.size(); ++k) {
        if (!fit[k]) continue;
        const Vec3d r = mine.r - others[k].r, v = mine.v - others[k].v;
        if (spheres_meet(r, v, reach, ahead)) {
          ++meetings;
          ASSERT_TRUE(found[k]) << "seed " << seed << ", case " << n << ", " << name_of(isa);
        } else if (!spheres_meet(r, v, reach + 0.01 + 16 * format.step(), ahead)) {
          ++apart;
          found_apart += found[k];
        }
      }
    }
  }
  EXPECT_GT(meetings, 10000 / thin * available().size());
  EXPECT_GT(apart, 10000 / thin * available().size());
  EXPECT_LT(found_apart, apart / 50);
}

// The path of the seeker beside capsules: it may be much longer than they are.
TEST(NearCapsules, LosesNoneAndFindsFewOthers) {
  Random random(seed);
  Counts counts;
  for (std::size_t n = 0; n < 2000 / thin; ++n) {
    const double distance = random.log_uniform(1e-3, 3), h2 = random.uniform(0.01, 0.5);
    const double h1 = random.below(8) == 0 ? 0 : random.log_uniform(1e-3, 6);
    const Vec3d corner{9, 9, 9}, r = vec3(random.direction()) * random.uniform(0, 1.7);
    const Vec3d u = vec3(random.direction()) * (h1 > 0 ? 1 : 0);
    Seeker seeker = seeker_of({}, 1, h2);
    const double farthest = h1 + distance + 3;
    const WordFormat format = WordFormat::holding(9 - farthest, 9 + farthest);
    place(seeker, corner + r, u);
    seeker.axis_half = static_cast<float>(h1);
    seeker.margin += 0x1p-16f;
    std::vector<BlockRow> rows(40);
    std::vector<double> lengths;
    for (BlockRow& row : rows) {
      Vec3d a = vec3(random.direction());
      if (random.below(4) == 0) a = normalised(u + a * random.log_uniform(1e-9, 1e-2));
      Vec3d other = r + u * random.uniform(-h1, h1) +
                    vec3(random.direction()) * random.uniform(0, distance + 1);
      const auto gap_of = [&] { return test::nearest_points(r, u, other, a, h1, h2).gap; };
      Vec3d gap = gap_of();
      double length = std::sqrt(dot(gap, gap));
      if (length > 1e-3 && random.below(4) > 0) {
        const double wanted = distance + (random.coin() ? 1 : -1) * random.log_uniform(1e-8, 1e-3);
        other = other + gap * ((length - wanted) / length);
        gap = gap_of();
        length = std::sqrt(dot(gap, gap));
      }
      lengths.push_back(length);
      row = {corner + other, a, true};
    }
    const Neighbourhood near = fill(random, seeker, format, 0.1, rows);
    for (const Isa isa : available()) {
      const std::vector<bool> found =
          marked(near_capsules(near_kernels(isa), near, static_cast<float>(distance)), rows.size());
      // The square has a margin for rough first guesses on the path.
      const double wide = std::hypot(distance + 1e-4 * (1 + h1) + 8 * format.step(), 0x1p-10 * h1);
      ASSERT_NO_FATAL_FAILURE(counts.expect(found, lengths, distance, wide, isa));
    }
  }
  EXPECT_GT(counts.within, 20000 / thin * available().size());
  EXPECT_GT(counts.beyond, 5000 / thin * available().size());
}

// Far out on a long path, where a first guess that is rough is farthest off, across thin capsules
// in small cells, so that places add little error.
TEST(NearCapsules, LosesNoneThatCrossALongPathFarOut) {
  Random random(seed);
  constexpr double path_half = 6, half = 0.5, side = 0.066;
  const WordFormat format = WordFormat::holding(0, side);
  for (std::size_t n = 0; n < 2000 / thin; ++n) {
    const double distance = random.log_uniform(5e-5, 2e-4);
    const Vec3d u = vec3(random.direction());
    const double s = (random.coin() ? 1 : -1) * random.uniform(3, path_half - side);
    const Vec3d r = Vec3d{0.5 * side, 0.5 * side, 0.5 * side} - u * s;
    Seeker seeker = seeker_of({}, 1, half);
    seeker.margin = 0x1p-16f;
    seeker.axis_half = path_half;
    place(seeker, r, u);
    std::vector<BlockRow> rows(40);
    for (BlockRow& row : rows) {
      const Vec3d across = normalised(cross(u, vec3(random.direction())));
      const double angle = random.uniform(0.4, 1.2);
      const Vec3d a = u * std::cos(angle) + cross(across, u) * std::sin(angle);
      const double at = s + random.uniform(-0.3, 0.3) * side, t = random.uniform(-0.3, 0.3) * side;
      row = {r + u * at - a * t + across * (distance * (1 - random.log_uniform(1e-8, 1e-3))), a,
             true};
    }
    const Neighbourhood near = fill(random, seeker, format, 0.05 * side, rows);
    for (const Isa isa : available()) {
      ASSERT_EQ(near_capsules(near_kernels(isa), near, static_cast<float>(distance)).size(),
                rows.size())
          << "seed " << seed << ", case " << n << ", " << name_of(isa);
    }
  }
}

// Paths of others beside the seeker's capsule.
TEST(NearPaths, LosesNoneAndFindsFewOthers) {
  Random random(seed);
  Counts counts;
  const WordFormat format = WordFormat::holding(-2, 10);
  const double range = WordFormat::places * format.step();
  for (std::size_t n = 0; n < 2000 / thin; ++n) {
    const double now = random.uniform(0, longest_time), ahead = random.log_uniform(1e-3, 4);
    const double distance = random.log_uniform(1e-3, 2), half = random.uniform(0.01, 0.5);
    const Vec3d corner{4, 4, 4}, u = vec3(random.direction());
    const Vec3d r = vec3(random.direction()) * random.uniform(0, 2);
    Seeker seeker = seeker_of({}, static_cast<float>(ahead) + test::simd_time_margin);
    seeker.motion.time = seeker.now = static_cast<float>(now);
    place(seeker, format, corner + r, u);
    seeker.margin += static_cast<float>(format.step());
    seeker.axis_half = static_cast<float>(half);
    std::vector<BlockRow> rows(40);
    std::vector<double> lengths(rows.size(), -1);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double age = random.below(3) == 0 ? 0 : random.uniform(0, now);
      const int kind = random.below(8);
      const Vec3d v = vec3(random.normal_vector(kind == 0   ? 0.0
                                                : kind == 1 ? random.log_uniform(1e-6, 1e3)
                                                            : 1.0));
      const double speed = std::sqrt(dot(v, v)), half_path = 0.5 * speed * ahead;
      const Vec3d along = speed > 0 ? v * (1 / speed) : Vec3d{};
      Vec3d middle = r + vec3(random.direction()) * random.uniform(0, distance + 1);
      const auto gap_of = [&] {
        return test::nearest_points(r, u, middle, speed > 0 ? along : Vec3d{1, 0, 0}, half,
                                    half_path)
            .gap;
      };
      Vec3d gap = gap_of();
      double length = std::sqrt(dot(gap, gap));
      if (length > 1e-3 && random.below(4) > 0) {
        const double wanted = distance + (random.coin() ? 1 : -1) * random.log_uniform(1e-8, 1e-2);
        middle = middle + gap * ((length - wanted) / length);
        gap = gap_of();
        length = std::sqrt(dot(gap, gap));
      }
      const Vec3d then = corner + middle - along * half_path - v * age;
      const auto fits = [&](double from, double speed_along) {
        return from > -2 && from < 10 && std::abs(speed_along) * (age + ahead) < range;
      };
      if (!fits(then.x, v.x) || !fits(then.y, v.y) || !fits(then.z, v.z)) continue;
      lengths[k] = length;
      rows[k] = {then, v, false, static_cast<float>(now - age)};
    }
    const Neighbourhood near = fill(random, seeker, format, 0.5, rows);
    for (const Isa isa : available()) {
      const std::vector<bool> found =
          marked(near_paths(near_kernels(isa), near, static_cast<float>(distance)), rows.size());
      const double wide = distance + 0.01 + 20 * format.step();
      ASSERT_NO_FATAL_FAILURE(counts.expect(found, lengths, distance, wide, isa));
    }
  }
  EXPECT_GT(counts.within, 10000 / thin * available().size());
  EXPECT_GT(counts.beyond, 5000 / thin * available().size());
}

// Needles that fly nearly as far as they may, with words that make them seem late by nearly as much
// as they can: they come up with the seeker just in time.
TEST(Approaching, LosesNoSpheresWhoseWordsAreFarthestOff) {
  Random random(seed);
  const WordFormat format = WordFormat::holding(0, 8);
  const double range = WordFormat::places * format.step(), reach = 1;
  constexpr double now = 7.5, ahead = 1.5;
  const Vec3d corner{test::simd_cell_corner, test::simd_cell_corner, test::simd_cell_corner};
  for (std::size_t n = 0; n < 2000 / thin; ++n) {
    // Words are off most, beside the velocity, just above a power of two.
    constexpr double least = 2, most = 2.02;
    const double span = random.uniform(0.98, 1) * range / most;
    double from[3]{}, velocity[3]{}, late[3]{}, squares = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double sign = random.coin() ? 1 : -1;
      for (int draw = 0; draw < 300; ++draw) {
        const double r = random.uniform(0, 8), v = sign * random.uniform(least, most);
        const std::uint32_t word = format.with_velocity(r, v);
        const double off = (r - format.coordinate(word)) + (v - WordFormat::velocity(word)) * span;
        if (sign * off <= late[axis]) continue;
        late[axis] = sign * off;
        from[axis] = r;
        velocity[axis] = v;
      }
      squares += late[axis] * late[axis];
    }
    ASSERT_GT(std::sqrt(squares), 6.5 * format.step());
    const Vec3d r{from[0], from[1], from[2]}, v{velocity[0], velocity[1], velocity[2]};
    Flight mine;
    mine.r = corner + r + v * span + normalised(v) * (reach * (1 - 1e-6));
    Seeker seeker = seeker_of(motion_of(mine, 0, 1, reach / 2), ahead, reach / 2);
    seeker.motion.time = seeker.now = now;
    const auto entered = static_cast<float>(now + ahead - span);
    const Neighbourhood near = fill(random, seeker, format, 0, {{r, v, false, entered}});
    for (const Isa isa : available()) {
      ASSERT_EQ(approaching(near_kernels(isa), near).size(), 1U)
          << "seed " << seed << ", case " << n << ", " << name_of(isa);
    }
  }
}

}  // namespace
}  // namespace needlework::kernels
