#include "src/machine/stop_request.h"

#include <utility>

namespace needlework {
namespace {

constexpr std::chrono::milliseconds interval{50};

thread_local StopRequest* latest_request = nullptr;

}  // namespace

StopRequest::StopRequest(std::function<std::string()> asked)
    : asked_(std::move(asked)),
      next_(std::chrono::steady_clock::now() + interval),
      outer_(std::exchange(latest_request, this)) {}

StopRequest::~StopRequest() { latest_request = outer_; }

void StopRequest::forget() { latest_request = nullptr; }

void StopRequest::check() {
  if (!latest_request) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < latest_request->next_) return;
  latest_request->next_ = now + interval;
  if (const std::string why = latest_request->asked_(); !why.empty()) throw StoppedEarly(why);
}

void StopRequest::check(const Stage& stage) {
  if (latest_request) latest_request->stage_ = stage;
  check();
}

}  // namespace needlework
