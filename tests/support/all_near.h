// Compares vectors, and rows of them, in one expectation.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace needlework::test {

/// Whether no component differs by more than this; those that are no numbers differ.
inline testing::AssertionResult all_near(const std::array<double, 3>& a,
                                         const std::array<double, 3>& b, double most) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(a[axis] - b[axis]) <= most) continue;
    return testing::AssertionFailure()
           << "component " << axis << ": " << a[axis] << " and " << b[axis];
  }
  return testing::AssertionSuccess();
}

/// The same of rows, as those of a State.
inline testing::AssertionResult all_near(const std::vector<std::array<double, 3>>& a,
                                         const std::vector<std::array<double, 3>>& b, double most) {
  if (a.size() != b.size())
    return testing::AssertionFailure() << a.size() << " and " << b.size() << " rows";
  for (std::size_t row = 0; row < a.size(); ++row) {
    if (auto near = all_near(a[row], b[row], most); !near) return near << " of row " << row;
  }
  return testing::AssertionSuccess();
}

}  // namespace needlework::test
