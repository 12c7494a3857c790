// Refuses options of compilers that change results of floating-point arithmetic. Error bounds of
// decisions about contacts hold for IEEE 754 alone: with -ffast-math, compilers drop the terms that
// carry the rounding errors, and contacts are missed. CMakeLists.txt names the option; this is for
// other ways to build.
#pragma once

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error \
    "Needlework needs the arithmetic of IEEE 754: build it without -ffast-math, -Ofast and their parts"
#endif
