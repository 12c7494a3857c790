// The definition of make_run_with, for the files that instantiate it.
#pragma once

#include "src/engine/event_loop.h"
#include "src/engine/make_run_with.h"
#include "src/error.h"
#include "src/search/all_pairs.h"
#include "src/search/linked_lists.h"
#include "src/search/near_search.h"

namespace needlework {

template <class Search, Calendar Queue>
std::unique_ptr<Run> with_effects(const Scene& scene, Gas initial, const SearchSetup& setup) {
  const bool rough = scene.collisions.beta != -1;
  const bool contact_time = scene.collisions.tc || scene.collisions.tc_relative;
  const auto make = [&]<Effects effects>() -> std::unique_ptr<Run> {
    return std::make_unique<EventLoop<Search, Queue, effects>>(scene, std::move(initial), setup);
  };
  if (rough) {
    return contact_time ? make.template operator()<Effects{true, true}>()
                        : make.template operator()<Effects{true, false}>();
  }
  return contact_time ? make.template operator()<Effects{false, true}>()
                      : make.template operator()<Effects{false, false}>();
}

template <Calendar Queue>
std::unique_ptr<Run> make_run_with(const Scene& scene, Gas initial, const std::string& search,
                                   const SearchSetup& setup) {
  if (search == AllPairs::name)
    return with_effects<AllPairs, Queue>(scene, std::move(initial), setup);
  if (search == LinkedLists::name)
    return with_effects<LinkedLists, Queue>(scene, std::move(initial), setup);
  if (search == LinkedCells::name)
    return with_effects<LinkedCells, Queue>(scene, std::move(initial), setup);
  if (search == Capsules::name)
    return with_effects<Capsules, Queue>(scene, std::move(initial), setup);
  throw InputError("engine.search = \"" + search +
                   "\": expected auto, all-pairs, linked-lists, linked-cells or capsules");
}

}  // namespace needlework
