#include "src/cli/set_up.h"

#include <fmt/format.h>

#include <utility>

#include "src/cli/signals.h"
#include "src/runs/progress_text.h"
#include "src/runs/resources.h"

namespace needlework::cli {

SetUp::SetUp(std::string nothing_lost)
    : nothing_lost_(std::move(nothing_lost)), request_([this] { return asked(); }) {}

std::string SetUp::asked() {
  const auto& [what, share] = request_.stage();
  const double now = runs::seconds_since_launch();
  if (what != stage_) stage_began_ = now;
  stage_ = what;
  std::string out = why();
  if (line_ && what && (!out.empty() || line_->is_due(now))) {
    const double left = (now - stage_began_) * ((1 - share) / share);
    if (out.empty()) {
      line_->show(now, runs::progress_text(share, left, what));
    } else {
      line_->clear();
    }
  }
  return out;
}

std::string SetUp::why() const {
  const bool by_signal = SignalGuard::received() != 0;
  const bool too_late = wall_s_ && runs::seconds_since_launch() >= *wall_s_;
  if (!by_signal && !too_late) return {};
  return fmt::format("stopped by {} before the run began ({})",
                     by_signal ? "a signal" : "until.wall_s", nothing_lost_);
}

}  // namespace needlework::cli
