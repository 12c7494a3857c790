// The SIMD instruction sets for which a file is compiled. Included after <hwy/highway.h>, and once.
#pragma once

// NEEDLEWORK_FOR_EACH_SIMD(visit) is visit(isa, space, target) for each: the member of Isa, the
// namespace of Highway in which its functions are, and its bit in hwy::SupportedTargets().
#if HWY_TARGETS & HWY_SSE4
#define NEEDLEWORK_FOR_SSE4(visit) visit(sse4, N_SSE4, HWY_SSE4)
#else
#define NEEDLEWORK_FOR_SSE4(visit)
#endif
#if HWY_TARGETS & HWY_AVX2
#define NEEDLEWORK_FOR_AVX2(visit) visit(avx2, N_AVX2, HWY_AVX2)
#else
#define NEEDLEWORK_FOR_AVX2(visit)
#endif
#if HWY_TARGETS & HWY_AVX3
#define NEEDLEWORK_FOR_AVX512(visit) visit(avx512, N_AVX3, HWY_AVX3)
#else
#define NEEDLEWORK_FOR_AVX512(visit)
#endif
#define NEEDLEWORK_FOR_EACH_SIMD(visit) \
  NEEDLEWORK_FOR_SSE4(visit) NEEDLEWORK_FOR_AVX2(visit) NEEDLEWORK_FOR_AVX512(visit)
