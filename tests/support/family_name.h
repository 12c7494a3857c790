// The family of pairs in the name of a test.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/pair_families.h"

namespace needlework::test {

inline std::string family_id(const PairFamily& family) {
  std::string name(family.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

inline std::string family_name(const testing::TestParamInfo<PairFamily>& info) {
  return family_id(info.param);
}

}  // namespace needlework::test
