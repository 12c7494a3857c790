// Which of Highway's instruction sets files that it compiles once for each leave out: those of
// isa.h stay. To be included before Highway.
#pragma once

// Those beyond AVX3_DL have bits 0 to 6; not all versions have names for them.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | 0x7f)
