#include "src/cli/set_up.h"

#include <fmt/format.h>

#include <utility>

#include "src/cli/signals.h"
#include "src/runs/resources.h"

namespace needlework::cli {

SetUp::SetUp(std::string nothing_lost)
    : nothing_lost_(std::move(nothing_lost)), request_([this] { return why(); }) {}

std::string SetUp::why() const {
  const bool by_signal = SignalGuard::received() != 0;
  const bool too_late = wall_s_ && runs::seconds_since_launch() >= *wall_s_;
  if (!by_signal && !too_late) return {};
  return fmt::format("stopped by {} before the run began ({})",
                     by_signal ? "a signal" : "until.wall_s", nothing_lost_);
}

}  // namespace needlework::cli
