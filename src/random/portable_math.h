// Logarithm and exponential with the same bits on every machine: + - * / of IEEE 754 alone, where
// those of C libraries differ. Arguments and results are double-doubles, so that what is made of
// several of them is still accurate to a rounding of its own.
#pragma once

#include "kernels/double_double.h"

namespace needlework::portable {

// Relative errors are below 2^-56; results rounded to double are within 0.6 ulp.

/// The natural logarithm of x > 0; x is a normal number.
DoubleDouble log(const DoubleDouble& x);
/// ln(1 + x) for x > -1.
DoubleDouble log1p(const DoubleDouble& x);
/// e^x for x <= 709; 0 for x < -708.
DoubleDouble exp(const DoubleDouble& x);
/// e^x - 1 for x <= 709.
DoubleDouble expm1(const DoubleDouble& x);

}  // namespace needlework::portable
