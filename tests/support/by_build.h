// How much a test does, by the kind of build.
#pragma once

namespace needlework::test {

/// The first number in optimised builds, the second in builds without optimisation or with checks,
/// which take many times as long: they do the same on fewer cases.
template <class Number>
constexpr Number by_build([[maybe_unused]] Number optimised, [[maybe_unused]] Number other) {
#ifdef NDEBUG
  return optimised;
#else
  return other;
#endif
}

}  // namespace needlework::test
