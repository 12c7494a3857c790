// Which of Highway's instruction sets files that it compiles once for each leave out: those of
// isa.h stay. To be included before Highway.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
