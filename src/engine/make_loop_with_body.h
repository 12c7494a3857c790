// The definition of make_loop_with, for the files that instantiate it.
#pragma once

#include <concepts>

#include "needlework/error.h"
#include "src/calendar/cell_calendar.h"
#include "src/engine/event_loop.h"
#include "src/engine/make_loop_with.h"
#include "src/search/all_pairs.h"
#include "src/search/linked_lists.h"
#include "src/search/near_search.h"

namespace needlework {

template <class Search, Effects effects>
class ParallelLoop;  // parallel_loop.h, for the calendar that it works with

/// Whether several threads may share the work.
template <class Search, class Queue>
inline constexpr bool parallel_with =
    std::derived_from<Search, NearSearch>&& std::same_as<Queue, CellCalendar>;

template <class Search, Calendar Queue>
std::unique_ptr<Loop> with_effects(const Scene& scene, Run& run, const SearchSetup& setup) {
  const bool rough = scene.collisions.beta != -1;
  const bool contact_time = scene.collisions.tc || scene.collisions.tc_relative;
  const int threads = scene.engine.threads.value_or(1);
  if (threads > 1 && !parallel_with<Search, Queue>) {
    throw InputError("engine.threads = " + std::to_string(threads) + ": expected 1 for search " +
                     Search::name + " with queue " + Queue::name +
                     "; several threads need linked-cells or capsules, and cell-calendar");
  }
  const auto make = [&]<Effects effects>() -> std::unique_ptr<Loop> {
    if constexpr (parallel_with<Search, Queue>) {
      if (threads > 1) {
        return std::make_unique<ParallelLoop<Search, effects>>(run, setup, threads);
      }
    }
    return std::make_unique<EventLoop<Search, Queue, effects>>(run, setup);
  };
  if (rough) {
    return contact_time ? make.template operator()<Effects{true, true}>()
                        : make.template operator()<Effects{true, false}>();
  }
  return contact_time ? make.template operator()<Effects{false, true}>()
                      : make.template operator()<Effects{false, false}>();
}

template <Calendar Queue>
std::unique_ptr<Loop> make_loop_with(const Scene& scene, Run& run, const std::string& search,
                                     const SearchSetup& setup) {
  if (search == AllPairs::name) return with_effects<AllPairs, Queue>(scene, run, setup);
  if (search == LinkedLists::name) return with_effects<LinkedLists, Queue>(scene, run, setup);
  if (search == LinkedCells::name) return with_effects<LinkedCells, Queue>(scene, run, setup);
  if (search == Capsules::name) return with_effects<Capsules, Queue>(scene, run, setup);
  throw InputError("engine.search = \"" + search +
                   "\": expected auto, all-pairs, linked-lists, linked-cells or capsules");
}

}  // namespace needlework
