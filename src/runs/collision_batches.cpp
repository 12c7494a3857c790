#include "src/runs/collision_batches.h"

#include <algorithm>
#include <utility>

namespace needlework::runs {

CollisionBatches::CollisionBatches(Simulation& simulation, std::size_t batch, Callback callback)
    : simulation_(simulation),
      batch_(std::max<std::size_t>(batch, 1)),
      callback_(std::move(callback)) {}

void CollisionBatches::add(const Collision& collision) {
  collected_.push_back(collision);
  if (collected_.size() < batch_ || failure_) return;
  pass_on();
  if (failure_) simulation_.interrupt();
}

void CollisionBatches::flush() {
  if (!failure_ && !collected_.empty()) pass_on();
  if (failure_) std::rethrow_exception(std::exchange(failure_, {}));
}

void CollisionBatches::pass_on() {
  try {
    callback_(collected_);
  } catch (...) {
    failure_ = std::current_exception();
  }
  collected_.clear();
}

}  // namespace needlework::runs
