// Free flight of many needles at once: where each is after a time of its own.
//
// The same bits as centre_after() and director_after() of contact_function.h, one needle at a time,
// on every instruction set; with vectors of one double the source is the scalar twin.
#pragma once

#include <cstddef>

#include "kernels/contact_function.h"
#include "kernels/isa.h"

namespace needlework::kernels {

inline constexpr std::size_t flights_at_once = 8;  ///< one vector of AVX-512

/// Needles in columns, in any one unit of time. Columns have room for a multiple of
/// `flights_at_once` of them; entries beyond the last needle may hold anything, and are
/// overwritten.
struct FlightColumns {
  enum Column {
    r_x,  // centre [L]; result: after the time
    r_y,
    r_z,
    v_x,  // velocity
    v_y,
    v_z,
    u_x,  // director; result: after the time
    u_y,
    u_z,
    p_x,  // w x u / |w|, or 0
    p_y,
    p_z,
    omega,    // |w|
    elapsed,  // the time
    columns
  };
  double* column[columns];

  /// Puts needle n in, to fly for `time` from here.
  void put(std::size_t n, const Flight& flight, double time) const {
    put(r_x, n, flight.r);
    put(v_x, n, flight.v);
    put(u_x, n, flight.u);
    put(p_x, n, flight.p);
    column[omega][n] = flight.omega;
    column[elapsed][n] = time;
  }
  Vec3d centre(std::size_t n) const { return at(r_x, n); }
  Vec3d director(std::size_t n) const { return at(u_x, n); }
  Vec3d at(int first, std::size_t n) const {
    return {column[first][n], column[first + 1][n], column[first + 2][n]};
  }

 private:
  void put(int first, std::size_t n, const Vec3d& a) const {
    column[first][n] = a.x;
    column[first + 1][n] = a.y;
    column[first + 2][n] = a.z;
  }
};

/// Advances n needles. Throws nothing; `isa` must be available().
void fly(Isa isa, const FlightColumns& needles, std::size_t n);

}  // namespace needlework::kernels
