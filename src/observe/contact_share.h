// The share of their time that needles spend in contact with each other.
#pragma once

#include <cstddef>

namespace needlework::observe {

/// The share of its time that a needle has been in contact, the mean of all `needles`, from the
/// time that pairs have been in contact, of all together. NaN at time 0.
inline double contact_share(double time_in_contact, std::size_t needles, double time) {
  return 2 * time_in_contact / (static_cast<double>(needles) * time);
}

}  // namespace needlework::observe
