// The definition of make_event_loop, for the files that instantiate it.
#pragma once

#include <utility>

#include "src/engine/event_loop.h"
#include "src/engine/loops/loops.h"
#include "src/engine/loops/with_model.h"

namespace needlework {

template <Search S>
std::unique_ptr<Loop> make_event_loop(Run& run, S search, std::unique_ptr<AnyCalendar> calendar,
                                      ReplacedRecords replaced) {
  return with_model(run.effects, [&]<Model M>() -> std::unique_ptr<Loop> {
    return std::make_unique<EventLoop<S, M>>(run, std::move(search), std::move(calendar),
                                             std::move(replaced));
  });
}

}  // namespace needlework
