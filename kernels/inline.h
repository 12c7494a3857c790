// Functions of lanes that are called per pair or needle: a call would pass vectors through memory.
#pragma once

#define NEEDLEWORK_INLINE inline __attribute__((always_inline))
