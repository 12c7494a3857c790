// There is one answer of each kernel, by every compiler and build, as a digest of it is written
// down here: of filters that of the scalar twin, of all others on every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <string>
#include <vector>

#include "kernels/first_contact.h"
#include "kernels/free_flight.h"
#include "kernels/near_needles.h"
#include "tests/kernels/simd_pairs.h"
#include "tests/support/random.h"

namespace needlework::kernels {
namespace {

using test::PairRow;
using test::Random;

/// FNV-1a over the bits of numbers.
class Digest {
 public:
  void take(float a) { take(std::uint64_t{std::bit_cast<std::uint32_t>(a)}); }
  void take(double a) { take(std::bit_cast<std::uint64_t>(a)); }
  void take(std::uint64_t a) {
    for (int byte = 0; byte < 8; ++byte) {
      state_ = (state_ ^ (a >> 8 * byte & 0xff)) * 0x100000001b3u;
    }
  }
  std::string hex() const {
    char out[17];
    std::snprintf(out, sizeof out, "%016llx", static_cast<unsigned long long>(state_));
    return out;
  }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

/// Braces evaluate in order.
Vec3d vector_of_size(Random& random, double size) {
  return Vec3d{random.uniform(-size, size), random.uniform(-size, size),
               random.uniform(-size, size)};
}

/// Around the origin, turning as fast as it flies.
Flight any_flight(Random& random) {
  Flight out;
  const auto u = random.direction();
  out.r = vector_of_size(random, 0.6);
  out.v = vector_of_size(random, 1.5);
  out.u = {u[0], u[1], u[2]};
  out.w = cross(out.u, vector_of_size(random, 4));
  set_rotation(out);
  return out;
}

template <class Answer>
void expect_everywhere(const char* digest, Answer&& answer) {
  for (const Isa isa : available()) {
    Digest out;
    answer(isa, out);
    EXPECT_EQ(out.hex(), digest) << name_of(isa);
  }
}

TEST(OneAnswer, OfFreeFlight) {
  expect_everywhere("a9df506d9e2a0d2f", [](Isa isa, Digest& out) {
    using C = FlightColumns;
    Random random(1);
    for (std::size_t count = 1; count <= 33; ++count) {
      const std::size_t room = count + flights_at_once;
      std::vector<double> storage(C::columns * room);
      C columns;
      for (std::size_t c = 0; c < C::columns; ++c) columns.column[c] = &storage[c * room];
      for (std::size_t n = 0; n < count; ++n) {
        const Flight flight = any_flight(random);
        columns.put(n, flight, random.uniform(0, 10));
      }
      fly(isa, columns, count);
      for (const double* column : columns.column) {
        for (std::size_t n = 0; n < count; ++n) out.take(column[n]);
      }
    }
  });
}

template <class Answer>
void expect_of_the_twin(const char* digest, Answer&& answer) {
  Digest out;
  answer(near_kernels(Isa::scalar), out);
  EXPECT_EQ(out.hex(), digest);
}

TEST(OneAnswer, OfTheTwinOfFilters) {
  expect_of_the_twin("37a81bd0d47ab9c5", [](const NearKernels& kernels, Digest& out) {
    Random random(2);
    for (int n = 0; n < 200; ++n) {
      NeedleBlock blocks[2];
      const std::uint32_t next[2] = {1, NeedleBlock::none};
      const CellView cells[] = {{0, {0.5f, 0, 0}}, {0, {0, -0.5f, 1}}};
      const WordFormat format = WordFormat::holding(-2, 2);
      std::uint32_t id = 1;
      for (NeedleBlock& block : blocks) {
        for (std::size_t lane = 0; lane < block_size; ++lane) {
          const auto a = random.direction();
          const Vec3d r = vector_of_size(random, 1);
          const double time = random.uniform(-1, 0);
          const double places[] = {r.x, r.y, r.z};
          for (int axis = 0; axis < 3; ++axis) {
            block.word[axis][lane] = n % 2 ? format.with_director(places[axis], a[axis])
                                           : format.with_velocity(places[axis], a[axis]);
          }
          block.time[lane] = static_cast<float>(time);
          block.needle[lane] = id++;
        }
      }
      std::fill(blocks[1].needle + 1 + n % 16, std::end(blocks[1].needle), NeedleBlock::none);
      const Seeker seeker = test::seeker_of(test::motion_of(any_flight(random), 0, 1), 0.7f);
      std::uint32_t needles[5 * block_size], seen_in[5 * block_size];
      const Surroundings around{blocks, next, cells, 2, format};
      const auto take = [&](const Scan& scan) {
        out.take(std::uint64_t{scan.seen});
        for (std::size_t k = 0; k < scan.found; ++k) {
          out.take(std::uint64_t{needles[k]} << 32 | seen_in[k]);
        }
      };
      take(kernels.overlapping(around, seeker, 0.2f, {needles, seen_in}));
      take(kernels.approaching(around, seeker, {needles, seen_in}));
    }
  });
}

TEST(OneAnswer, OfTheTwinOfTheContactFunctionAndItsIsolation) {
  expect_of_the_twin("ca5e9f6fedbbfae4", [](const NearKernels& kernels, Digest& out) {
    Random random(3);
    for (std::size_t count = 1; count <= 40; ++count) {
      const Seeker seeker = test::seeker_of(test::motion_of(any_flight(random), 0, 1), 2);
      std::vector<PairRow> rows(count);
      for (PairRow& row : rows) {
        // One after the other: compilers differ in the order of arguments.
        const Flight other = any_flight(random);
        const double age = random.uniform(), until = random.uniform(0, 2);
        row = test::row_of(seeker, test::motion_of(other, -age, 1), 0, static_cast<float>(until));
      }
      for (const auto& values : test::contact_functions(kernels, seeker, rows, 0.5f)) {
        for (const float value : values) out.take(value);
      }
      for (const float from : test::bracketed(kernels, seeker, rows)) out.take(from);
    }
  });
}

// In double and double-double, one pair at a time.
TEST(OneAnswer, OfFirstContacts) {
  Random random(4);
  Digest out;
  std::size_t contacts = 0;
  for (int n = 0; n < 20000; ++n) {
    const Flight first = any_flight(random), second = any_flight(random);
    Pair pair;
    pair.first = &first;
    pair.second = &second;
    EvaluationCounters counters;
    const Contact contact = first_contact(pair, 0, 3, counters);
    contacts += contact.found;
    out.take(contact.elapsed.hi);
    out.take(contact.elapsed.lo);
  }
  EXPECT_GT(contacts, 1000u);
  EXPECT_EQ(out.hex(), "63a22535e3b1b5cd");
}

}  // namespace
}  // namespace needlework::kernels
