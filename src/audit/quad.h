// 113-bit numbers. quadmath.h is in GCC's private folder, so other compilers use a slower type.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#if defined(__GNUC__) && !defined(__clang__)
#include <boost/multiprecision/float128.hpp>
#endif

namespace needlework::audit {

#if defined(__GNUC__) && !defined(__clang__)
using Quad = boost::multiprecision::float128;
#else
using Quad = boost::multiprecision::cpp_bin_float_quad;
#endif

}  // namespace needlework::audit
