#include "src/cli/frame_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "needlework/error.h"

namespace needlework::cli {

bool is_frame_choice(const std::string& text) {
  const bool is_number =
      !text.empty() && text.size() < 19 &&
      std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  return is_number || text == "first" || text == "last" || text == "all";
}

FrameRange chosen_frames(const std::string& choice, std::size_t count) {
  if (choice == "all") return {0, count};
  if (choice == "last") return {count - 1, count};
  if (choice == "first") return {0, 1};
  std::size_t number = count;  // the command line has checked that it is one
  std::from_chars(choice.data(), choice.data() + choice.size(), number);
  if (number >= count) {
    throw InputError(
        fmt::format("--frame {}: expected a number from 0 to {}, as there are {} frames", choice,
                    count - 1, count));
  }
  return {number, number + 1};
}

}  // namespace needlework::cli
