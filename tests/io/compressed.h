// Text compressed with bzip2.
#pragma once

#include <bzlib.h>
#include <gtest/gtest.h>

#include <string>

namespace needlework::io {

inline std::string compressed(std::string text) {
  std::string out(text.size() + text.size() / 100 + 600, '\0');
  auto size = static_cast<unsigned>(out.size());
  EXPECT_EQ(BZ_OK, BZ2_bzBuffToBuffCompress(out.data(), &size, text.data(),
                                            static_cast<unsigned>(text.size()), 9, 0, 0));
  out.resize(size);
  return out;
}

}  // namespace needlework::io
