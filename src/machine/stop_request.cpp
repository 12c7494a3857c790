#include "src/machine/stop_request.h"

#include <utility>

namespace needlework {
namespace {

constexpr std::chrono::milliseconds interval{50};

thread_local StopRequest* latest = nullptr;

}  // namespace

StopRequest::StopRequest(std::function<std::string()> asked)
    : asked_(std::move(asked)),
      next_(std::chrono::steady_clock::now() + interval),
      outer_(std::exchange(latest, this)) {}

StopRequest::~StopRequest() { latest = outer_; }

void StopRequest::forget() { latest = nullptr; }

void StopRequest::check() {
  if (!latest) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < latest->next_) return;
  latest->next_ = now + interval;
  if (const std::string why = latest->asked_(); !why.empty()) throw StoppedEarly(why);
}

}  // namespace needlework
