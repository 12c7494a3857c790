// A pair of a family as a kernel finds it: on the side of its collision, if it has just had one.
#pragma once

#include "kernels/first_contact.h"
#include "tests/support/kernel_pair.h"

namespace needlework::test {

inline void take_side_of_collision(KernelPair& pair) {
  const int side = kernels::side_after(pair.view());
  pair.touch = {.touching = side != 0, .collided = true, .side = side, .gap = 0};
}

inline KernelPair collided_pair(const NeedlePair& drawn) {
  KernelPair out = kernel_pair(drawn);
  if (drawn.just_collided) take_side_of_collision(out);
  return out;
}

}  // namespace needlework::test
