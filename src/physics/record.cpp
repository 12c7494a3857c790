#include "src/physics/record.h"

namespace needlework {

void FurtherTouches::add(Id owner, std::uint32_t serial, std::size_t before,
                         const RecordedTouch& touch) {
  const std::lock_guard lock(mutex_);
  std::vector<RecordedTouch>& touches = touches_[key_of(owner, serial)];
  // A rolled back record may have had the same number; its touches are removed.
  touches.resize(before);
  touches.push_back(touch);
}

std::vector<RecordedTouch> FurtherTouches::of(Id owner, std::uint32_t serial) const {
  const std::lock_guard lock(mutex_);
  const auto found = touches_.find(key_of(owner, serial));
  return found == touches_.end() ? std::vector<RecordedTouch>() : found->second;
}

std::size_t FurtherTouches::records() const {
  const std::lock_guard lock(mutex_);
  return touches_.size();
}

}  // namespace needlework
