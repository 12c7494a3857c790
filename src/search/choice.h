// What `auto` stands for, by the number of needles per L^3 around a needle, L the length of the
// longest needle; see sizing.h. `needlework bench hulls` compares these sizes with others, for
// masses from the tips to the centre of the needles.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

namespace needlework {

/// The search asked for by name; by `auto`, the cheaper one.
inline std::string chosen_search(const std::string& asked, double density) {
  if (asked != "auto") return asked;
  return density < 2.5 ? "linked-cells" : "capsules";
}

/// Whether the search asked for has sizes to choose.
inline bool has_sizes(const std::string& asked) {
  return asked != "all-pairs" && asked != "linked-lists";
}

/// Radius of capsules [L]: larger ones have more neighbours, smaller ones are left sooner.
inline double auto_capsule_radius(double density) {
  return std::clamp(0.6 / std::cbrt(density * density), 0.02, 1.0);
}

/// Side of the cells of capsules [L], of about 12 needles, which fill the vectors; a few fewer
/// where several threads are to have equal parts of them.
inline double auto_side_for_capsules(double density) { return std::cbrt(12 / density); }

/// Side of linked cells [L], of about 8 needles. In a dilute gas it pays to look through more, as
/// needles cross many cells from one collision to the next.
inline double auto_cell_side(double density) {
  return std::max(std::cbrt(8 / density), 1.9 / std::sqrt(density));
}

}  // namespace needlework
