// Pairs of needles as the SIMD kernels see them: in float, with a unit of time, from a cell.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/contact_function.h"
#include "kernels/near_needles.h"
#include "tests/support/random.h"

namespace needlework::test {

inline constexpr auto simd_time_margin = static_cast<float>(kernels::time_margin);

/// Cell in which needles of test pairs lie, and what a search takes as its margin then.
inline constexpr double simd_cell_corner = -4, simd_cell_side = 8;
inline constexpr float simd_margin = kernels::margin_of_lengths(simd_cell_side);

/// The motion at `elapsed` since its record of a needle of half length `half`, lengths from the
/// corner of the cell, times in units of 1 / unit.
inline kernels::Motion motion_of(const kernels::Flight& flight, double elapsed, double unit,
                                 double half = 0.5) {
  const auto store = [](float(&to)[3], const Vec3d& a) {
    to[0] = static_cast<float>(a.x);
    to[1] = static_cast<float>(a.y);
    to[2] = static_cast<float>(a.z);
  };
  const SineCosine<double> turned = sine_cosine(flight.omega * elapsed);
  kernels::Motion out{};
  store(out.r, centre_after(flight, elapsed) -
                   Vec3d{simd_cell_corner, simd_cell_corner, simd_cell_corner});
  store(out.v, flight.v * (1 / unit));
  store(out.u, flight.u * turned.cosine + flight.p * turned.sine);
  store(out.p, flight.p * turned.cosine - flight.u * turned.sine);
  out.omega = static_cast<float>(flight.omega / unit);
  out.time = static_cast<float>(elapsed * unit);
  out.half = static_cast<float>(half);
  return out;
}

/// Unit for needles of these speeds: a power of two.
inline double unit_of(const kernels::Flight& first, const kernels::Flight& second) {
  const auto speed = [](const kernels::Flight& a) {
    return std::sqrt(dot(a.v, a.v)) + 0.5 * a.omega;
  };
  const double fastest = std::max(speed(first), speed(second));
  return fastest > 0 ? std::ldexp(1.0, std::ilogb(fastest)) : 1;
}

inline kernels::Seeker seeker_of(const kernels::Motion& motion, float ahead,
                                 double longest_half = 0.5) {
  kernels::Seeker out{};
  out.motion = motion;
  for (int axis = 0; axis < 3; ++axis) {
    out.r[axis] = motion.r[axis];
    out.u[axis] = motion.u[axis];
  }
  out.now = motion.time;
  out.ahead = ahead;
  out.margin = simd_margin;
  out.longest_half = static_cast<float>(longest_half);
  out.needle = 0;
  return out;
}

using PairRow = std::array<float, kernels::PairColumns::columns>;

/// What a search fills in for a partner: looked at from `from` to `until`, both from now.
inline PairRow row_of(const kernels::Seeker& seeker, const kernels::Motion& other, float from,
                      float until) {
  using C = kernels::PairColumns;
  PairRow row{};
  const float age = seeker.now - other.time;
  for (int axis = 0; axis < 3; ++axis) {
    row[C::r_x + axis] = (seeker.motion.r[axis] - other.r[axis]) - other.v[axis] * age;
    row[C::v_x + axis] = seeker.motion.v[axis] - other.v[axis];
    row[C::u_x + axis] = other.u[axis];
    row[C::p_x + axis] = other.p[axis];
  }
  row[C::omega] = other.omega;
  row[C::half] = other.half;
  row[C::age] = age;
  row[C::until] = until;
  row[C::from] = from;
  return row;
}

/// Pairs in columns. Floats beyond them hold what a search may have left there: `beyond`.
class PairTable {
 public:
  explicit PairTable(const std::vector<PairRow>& rows,
                     float beyond = std::numeric_limits<float>::quiet_NaN())
      : room_(rows.size() + 2 * kernels::block_size),
        storage_(room_ * kernels::PairColumns::columns, beyond) {
    const kernels::PairColumns columns = view();
    for (int c = 0; c < kernels::PairColumns::columns; ++c) {
      for (std::size_t n = 0; n < rows.size(); ++n) columns.column[c][n] = rows[n][c];
    }
  }
  kernels::PairColumns view() {
    kernels::PairColumns out;
    for (int c = 0; c < kernels::PairColumns::columns; ++c) {
      out.column[c] = storage_.data() + c * room_;
    }
    return out;
  }

 private:
  std::size_t room_;
  std::vector<float> storage_;
};

/// What bracket() says of these pairs.
inline std::vector<float> bracketed(const kernels::NearKernels& kernels,
                                    const kernels::Seeker& seeker, const std::vector<PairRow>& rows,
                                    float beyond = std::numeric_limits<float>::quiet_NaN()) {
  PairTable table(rows, beyond);
  const float* from = table.view().column[kernels::PairColumns::from];
  kernels.bracket(seeker, table.view(), rows.size());
  return {from, from + rows.size()};
}

/// The contact function of these pairs at time s, and its bounds, one pair after the other.
using ContactRow = std::array<float, kernels::ContactColumns::columns>;
inline std::vector<ContactRow> contact_functions(const kernels::NearKernels& kernels,
                                                 const kernels::Seeker& seeker,
                                                 const std::vector<PairRow>& rows, float s,
                                                 float beyond = 0) {
  using C = kernels::ContactColumns;
  PairTable table(rows, beyond);
  const std::size_t room = rows.size() + kernels::block_size;
  std::vector<float> storage(room * C::columns);
  C columns;
  for (int c = 0; c < C::columns; ++c) columns.column[c] = storage.data() + c * room;
  kernels.contact_function(seeker, table.view(), rows.size(), s, columns);
  std::vector<ContactRow> out(rows.size());
  for (std::size_t n = 0; n < rows.size(); ++n) {
    for (int c = 0; c < C::columns; ++c) out[n][c] = columns.column[c][n];
  }
  return out;
}

/// A finite number of any size, or now and then one that is not.
inline float any_float(Random& random) {
  switch (random.below(12)) {
    case 0:
      return std::bit_cast<float>(static_cast<std::uint32_t>(random.bits()));
    case 1:
      return 0;
    case 2:
      return -0.0f;
    default:
      return static_cast<float>(random.normal() * std::ldexp(1.0, 12 * (random.below(21) - 10)));
  }
}

}  // namespace needlework::test
