// What readers say of texts with one fault.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

namespace needlework::io {

/// `text` with the first `from` replaced, which must be in it.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == text.npos) {
    ADD_FAILURE() << "no " << from;
    return text;
  }
  return text.replace(at, from.size(), to);
}

/// A fault: this part of a good text in place of that one, and how the message about it begins.
struct Fault {
  const char *from, *to, *message;
};

/// `complaint` gives the message about a text.
template <class Complaint>
void expect_complaints(const std::string& good, std::initializer_list<Fault> faults,
                       Complaint complaint) {
  for (const auto& [from, to, message] : faults) {
    const std::string found = complaint(replaced(good, from, to));
    EXPECT_TRUE(found.starts_with(message)) << found;
  }
}

}  // namespace needlework::io
