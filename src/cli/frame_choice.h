// Which frames of a file a command works on.
#pragma once

#include <cstddef>
#include <string>

namespace needlework::cli {

/// Whether the text is "first", "last", "all" or the number of a frame.
bool is_frame_choice(const std::string& text);

struct FrameRange {
  std::size_t begin, end;
};

/// The frames that are meant, of `count` at least 1. Throws InputError for a number that is too
/// large.
FrameRange chosen_frames(const std::string& choice, std::size_t count);

}  // namespace needlework::cli
