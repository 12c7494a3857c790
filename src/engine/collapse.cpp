#include "src/engine/collapse.h"

#include <fmt/format.h>

namespace needlework {
namespace {

const char* advice_for(const PairCollapse& c) {
  if (c.root_tolerance > 0x1p-30)
    return "engine.root_tolerance is so coarse that needles may stand beyond their contact";
  if (c.epsilon == 0)
    return "with collisions.epsilon = 0 there is no rebound, and no contact time can help; "
           "collisions.sliding lets them slide along each other";
  if (c.contact_time)
    return "a longer contact time helps, unless they meet by rounding alone, as in one plane";
  return "set collisions.tc_relative, to 1e-3 say, or collisions.sliding, so that they slide along "
         "each other";
}

std::string advice_for(const GroupCollapse& c) {
  const bool alone = c.first == c.second;  // with walls
  if (alone && (c.sliding || c.contact_time))
    return fmt::format(
        "{} cannot help where a wall moves or draws velocities, nor a needle that lies on a wall; "
        "of a tip in the corner of two such walls, less motion or a higher temperature may",
        c.sliding ? "collisions.sliding_below" : "a contact time");
  if (c.sliding) return "a longer collisions.sliding_below may help";
  if (c.contact_time) return "a longer contact time may help";
  return alone ? "set collisions.tc_relative, to 1e-3 say, unless it rests on a wall"
               : "set collisions.tc_relative, to 1e-3 say, or collisions.sliding";
}

}  // namespace

std::string message_of(const PairCollapse& c) {
  return fmt::format(
      "collapse of needles {} and {} at time {:.17g}, gap {:.3g}, back after {:.3g}: their next "
      "bounce is below what double resolves; {}",
      c.first.value, c.second.value, c.time, c.gap, c.after, advice_for(c));
}

std::string message_of(const GroupCollapse& c) {
  if (c.first == c.second) {
    return fmt::format(
        "needle {} collapses at time {:.17g}: {} events at one instant, with walls or others; {}",
        c.first.value, c.time, c.collisions, advice_for(c));
  }
  return fmt::format(
      "needles {} and {} and others collapse at time {:.17g}: {} collisions at one instant; {}",
      c.first.value, c.second.value, c.time, c.collisions, advice_for(c));
}

}  // namespace needlework
