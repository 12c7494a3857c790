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
  if (!failure_ && collected_.size() >= batch_) pass_on();
  if (failure_) simulation_.interrupt();
}

void CollisionBatches::flush() {
  if (!failure_ && !collected_.empty()) pass_on();
  if (failure_) std::rethrow_exception(std::exchange(failure_, {}));
}

// Where memory does not suffice for a whole batch, a shorter one is passed on: nothing may be
// thrown here, and no collision is lost.
void CollisionBatches::make_room() {
  if (collected_.size() < collected_.capacity()) return;
  try {
    collected_.reserve(2 * collected_.capacity());
  } catch (const std::exception&) {
    pass_on();
  }
}

void CollisionBatches::pass_on() {
  try {
    callback_(collected_);
  } catch (...) {
    if (!failure_) failure_ = std::current_exception();
  }
  collected_.clear();
}

}  // namespace needlework::runs
