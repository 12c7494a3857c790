#include "src/runs/batches.h"

#include <algorithm>
#include <utility>

namespace needlework::runs {

template <class Report>
Batches<Report>::Batches(Simulation& simulation, std::size_t batch, Callback callback)
    : simulation_(simulation),
      batch_(std::max<std::size_t>(batch, 1)),
      callback_(std::move(callback)) {
  collected_.reserve(1);
}

template <class Report>
Batches<Report>::~Batches() = default;

template <class Report>
void Batches<Report>::add(const Report& report) {
  make_room();
  collected_.push_back(report);
  if (!failure_) pass_on(batch_);
  if (failure_) simulation_.interrupt();
}

template <class Report>
void Batches<Report>::flush() {
  if (!failure_) pass_on(1);
  if (failure_) std::rethrow_exception(std::exchange(failure_, {}));
}

// Where memory does not suffice for a whole batch, a shorter one is passed on: nothing may be
// thrown here, and no report is lost.
template <class Report>
void Batches<Report>::make_room() {
  if (collected_.size() < collected_.capacity()) return;
  try {
    collected_.reserve(2 * collected_.capacity());
  } catch (const std::exception&) {
    pass_on(1);
  }
}

template <class Report>
void Batches<Report>::pass_on(std::size_t least) {
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

template class Batches<Collision>;
template class Batches<Happening>;

}  // namespace needlework::runs
