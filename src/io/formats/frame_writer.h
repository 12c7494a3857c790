// Writers of frames in the formats of other programs.
#pragma once

#include <cstddef>
#include <optional>

#include "needlework/state.h"

namespace needlework::io {

/// A frame of a run.
struct Frame {
  std::size_t number = 0;      ///< in its file, counted from 0
  std::optional<double> time;  ///< since the start of the run, if that is known [time]
  State state;
};

/// Writes frames one after the other, so that one at a time is in memory. All members throw
/// IoError, "PATH: reason". Without publish(), no file remains.
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;
  virtual void add(const Frame& frame) = 0;
  /// Completes the file and gives it its name.
  virtual void publish() = 0;
};

/// Identity of a needle: its index if the state has no ids.
inline std::uint32_t id_of(const State& state, std::size_t i) {
  return state.id.empty() ? static_cast<std::uint32_t>(i) : state.id[i];
}

}  // namespace needlework::io
