// The floating-point arithmetic that the bits of a trajectory rely on, whatever a host program has
// chosen for its own.
#pragma once

#include <cfenv>

#include "kernels/ieee_arithmetic.h"

namespace needlework::kernels {

/// While it exists, the thread that made it rounds to nearest, keeps numbers near 0 and traps
/// nothing. Then the thread computes again as before, and finds its exceptions as they were. Some
/// host programs choose their rounding, and one linked with -ffast-math or -Ofast sets numbers near
/// 0 to 0 from its start.
class DefaultArithmetic {
 public:
  DefaultArithmetic() {
    std::fegetenv(&host_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultArithmetic() { std::fesetenv(&host_); }
  DefaultArithmetic(const DefaultArithmetic&) = delete;
  DefaultArithmetic& operator=(const DefaultArithmetic&) = delete;

 private:
  std::fenv_t host_;
};

}  // namespace needlework::kernels
