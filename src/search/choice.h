// What `auto` stands for.
#pragma once

namespace needlework {

/// The cheaper search at this number of needles per L^3.
inline const char* auto_search(double density) {
  return density < 2.5 ? "linked-cells" : "capsules";
}

}  // namespace needlework
