// Pairs of needles in the format that `needlework predict` reads.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <span>
#include <string>

#include "tests/support/pair_families.h"

namespace needlework::test {

/// "id,family,horizon,r1x,...,w2z,skip" with 17 significant digits, from which every double can be
/// recovered.
std::string csv_line(std::size_t id, const NeedlePair& pair);

/// Writes the names of the columns as a comment, then one line per pair; ids count from
/// `first_id`.
void write_pairs(std::ostream& out, std::span<const NeedlePair> pairs, std::size_t first_id = 0);

}  // namespace needlework::test
