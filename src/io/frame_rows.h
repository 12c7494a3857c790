// Which rows of the elements of an H5MD file belong to one frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/io/source.h"

namespace needlework::io {

/// The frames of a group of particles: the steps that all its elements with steps have, in the
/// files of most programs one for each row. If elements differ in their steps, a frame is a step
/// that is common to all, and the last row with that step belongs to it. Without steps a frame is a
/// row of the positions.
class FrameRows {
 public:
  /// The elements must outlive this object. Throws InputError, "PATH: /DATASET: reason", if there
  /// is no frame.
  FrameRows(const Source& source, const Element& position,
            const std::vector<const Element*>& elements);

  std::size_t count() const { return count_; }

  /// The row of `element` that belongs to this frame, or nothing if `element` is one frame as a
  /// whole, which has `rank` dimensions. Throws InputError if the element does not have this frame.
  std::optional<hsize_t> row(const Element& element, std::size_t rank, std::size_t frame) const;

 private:
  std::string place(const Element& element) const { return source_->place(element.name()); }
  void find_common_steps(const std::vector<const Element*>& timed);

  const Source* source_;
  const Element* position_;
  std::size_t count_ = 0;
  // The steps of the frames, if elements differ in their steps.
  std::optional<std::vector<std::int64_t>> steps_;
};

}  // namespace needlework::io
