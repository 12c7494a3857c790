// The number types of the oracle: more digits than any engine has, and many more in reserve.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <limits>
#if defined(__GNUC__) && !defined(__clang__)
#include <boost/multiprecision/float128.hpp>
#endif

namespace needlework::test {

/// 113 bits. quadmath.h lies in GCC's private folder, so other compilers take the slower type.
#if defined(__GNUC__) && !defined(__clang__)
using Quad = boost::multiprecision::float128;
#else
using Quad = boost::multiprecision::cpp_bin_float_quad;
#endif

/// 100 decimal digits, for what 113 bits cannot decide.
using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>,
                                           boost::multiprecision::et_off>;

/// Half the distance from 1 to the next number.
template <class Real>
const Real& unit_roundoff() {
  static const Real value = std::numeric_limits<Real>::epsilon() / 2;
  return value;
}

}  // namespace needlework::test
