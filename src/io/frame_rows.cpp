#include "src/io/frame_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "needlework/error.h"

namespace needlework::io {

FrameRows::FrameRows(const Source& source, const Element& position,
                     const std::vector<const Element*>& elements)
    : source_(&source), position_(&position) {
  std::vector<const Element*> timed;
  for (const Element* element : elements) {
    if (!element->steps()) continue;
    if (element->rows() == 0) {
      throw InputError(place(*element) + ": no frames: expected at least one");
    }
    timed.push_back(element);
  }
  if (timed.empty()) {
    count_ = position.shape().size() == 2 ? 1 : position.rows();
    if (count_ == 0) throw InputError(place(position) + ": no frames: expected at least one");
    return;
  }
  const bool alike = std::all_of(timed.begin(), timed.end(), [&](const Element* element) {
    return *element->steps() == *timed.front()->steps();
  });
  if (alike) {
    count_ = timed.front()->rows();
  } else {
    find_common_steps(timed);
  }
}

void FrameRows::find_common_steps(const std::vector<const Element*>& timed) {
  steps_ = *timed.front()->steps();
  steps_->erase(std::unique(steps_->begin(), steps_->end()), steps_->end());
  for (const Element* element : timed) {
    std::vector<std::int64_t> common;
    std::set_intersection(steps_->begin(), steps_->end(), element->steps()->begin(),
                          element->steps()->end(), std::back_inserter(common));
    if (common.empty()) {
      throw InputError(place(*timed.front()) +
                       ": no step in common with the other elements: expected one");
    }
    steps_ = std::move(common);
  }
  count_ = steps_->size();
}

std::optional<hsize_t> FrameRows::row(const Element& element, std::size_t rank,
                                      std::size_t frame) const {
  if (element.shape().size() == rank) return std::nullopt;
  if (element.rows() == 0) {
    throw InputError(place(element) + ": no frames: expected at least one");
  }
  if (element.steps()) {
    if (!steps_) return frame;
    const auto& steps = *element.steps();
    return std::upper_bound(steps.begin(), steps.end(), (*steps_)[frame]) - steps.begin() - 1;
  }
  if (position_->shape().size() == 3 && element.rows() != position_->rows()) {
    throw InputError(fmt::format("{}: {} frames: expected {}, as in {}", place(element),
                                 element.rows(), position_->rows(), position_->name()));
  }
  // Without steps, an element belongs to the rows of the positions.
  if (&element != position_ && position_->shape().size() == 3) return row(*position_, 2, frame);
  if (element.rows() == count_) return frame;
  if (frame + 1 == count_) return element.rows() - 1;
  throw InputError(
      fmt::format("{}: {} frames: expected {}", place(element), element.rows(), count_));
}

}  // namespace needlework::io
