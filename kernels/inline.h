// For functions of vectors that run for each pair or needle: a call would pass vectors through
// memory.
#pragma once

#define NEEDLEWORK_INLINE inline __attribute__((always_inline))
