// Whether a text has parts.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

namespace needlework::test {

inline testing::AssertionResult contains(const std::string& text,
                                         std::initializer_list<std::string> parts) {
  for (const std::string& part : parts) {
    if (text.find(part) != text.npos) continue;
    return testing::AssertionFailure() << '"' << part << "\" is not in:\n" << text;
  }
  return testing::AssertionSuccess() << "all of it is in:\n" << text;
}

inline testing::AssertionResult contains(const std::string& text, const std::string& part) {
  return contains(text, {part});
}

}  // namespace needlework::test
