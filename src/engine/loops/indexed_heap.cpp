#include "src/calendar/indexed_heap.h"

#include "src/engine/make_loop_with_body.h"

namespace needlework {

template std::unique_ptr<Loop> make_loop_with<IndexedHeap>(const Scene&, Run&, const std::string&,
                                                           const SearchSetup&);

}  // namespace needlework
