// Pairs of rods of finite width for tests of the first contact: any, and the hard cases.
#pragma once

#include <string_view>
#include <vector>

#include "tests/support/rod_oracle.h"

namespace needlework::test {

class Random;

struct RodFamily {
  std::string_view name;
  RodCase (*draw)(Random&);

  /// So that a failing test names the family.
  friend void PrintTo(const RodFamily& family, std::ostream* out) { *out << family.name; }
};

/// L / D of the first rod is drawn from 1e-2 to 1e5, the lengths are unlike in half of the cases.
/// - any: rods that do not overlap, within a few lengths
/// - contact: moved back from a contact of faces, sides or tips
/// - parallel: the same, with directors at angles 1e-12 .. 1e-2
/// - exactly-parallel, collinear: at rest or rotating together or apart
/// - grazing: the diameter is 10^-x more or less than the least distance, x in 2 .. 5.5
/// - tip: contacts 10^-x from a tip, x in 2 .. 15
/// - just-collided: at a contact at s = 0;  just-collided-parallel: at angles 1e-9 .. 1e-2
/// - spheres, sphere-and-rod, just-collided-spheres
/// - unequal: lengths from 1 : 1 to 1 : 1e4
/// - needle_and_fixed_sphere: thin, and of radii from 1e-3 to 30 of its length
/// - fast: rotating 1e2 .. 1e4 times as fast as they fly;  still: one or both do not rotate
/// - records: records of different times, another image, and gravity between
/// - far: 1e2 .. 1e4 lengths apart;  slow: velocities times 2^-300
/// - growing, growing-spheres, growing-collided: the same, of bodies that grow, some of them faster
///   than they part
const std::vector<RodFamily>& rod_families();

}  // namespace needlework::test
