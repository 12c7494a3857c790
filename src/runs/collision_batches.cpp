#include "src/runs/collision_batches.h"

#include <algorithm>
#include <utility>

namespace needlework::runs {

CollisionBatches::CollisionBatches(Simulation& simulation, std::size_t batch, Callback callback)
    : simulation_(simulation),
      batch_(std::max<std::size_t>(batch, 1)),
      callback_(std::move(callback)) {
  collected_.reserve(1);
}

void CollisionBatches::add(const Collision& collision) {
  make_room();
  collected_.push_back(collision);
  if (!failure_) pass_on(batch_);
  if (failure_) simulation_.interrupt();
}

void CollisionBatches::flush() {
  if (!failure_) pass_on(1);
  if (failure_) std::rethrow_exception(std::exchange(failure_, {}));
}

// Where memory does not suffice for a whole batch, a shorter one is passed on: nothing may be
// thrown here, and no collision is lost.
void CollisionBatches::make_room() {
  if (collected_.size() < collected_.capacity()) return;
  try {
    collected_.reserve(2 * collected_.capacity());
  } catch (const std::exception&) {
    pass_on(1);
  }
}

void CollisionBatches::pass_on(std::size_t least) {
  std::size_t passed = 0;
  bool goes_on = true;
  while (goes_on && collected_.size() - passed >= least) {
    const std::size_t count = std::min(batch_, collected_.size() - passed);
    try {
      callback_(std::span(collected_).subspan(passed, count));
    } catch (...) {
      if (!failure_) failure_ = std::current_exception();
      goes_on = false;
    }
    passed += count;
  }
  collected_.erase(collected_.begin(), collected_.begin() + static_cast<std::ptrdiff_t>(passed));
}

}  // namespace needlework::runs
