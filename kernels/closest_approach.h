// Closest approach of two needles taken as line segments.
#pragma once

#include "kernels/vec3.h"

namespace needlework::kernels {

inline double minimum(double a, double b) { return a < b ? a : b; }
inline double maximum(double a, double b) { return a > b ? a : b; }
inline double multiply_add(double a, double b, double c) { return a * b + c; }
inline double multiply_subtract(double a, double b, double c) { return a * b - c; }
inline double rough_quotient(double a, double b) { return a / b; }
inline double select(bool condition, double a, double b) { return condition ? a : b; }

#include "kernels/closest_approach_body.h"

}  // namespace needlework::kernels
