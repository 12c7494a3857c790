#include "src/search/linked_lists.h"

#include "src/engine/loops/make_event_loop.h"

namespace needlework {

template std::unique_ptr<Loop> make_event_loop<LinkedLists>(Run&, LinkedLists,
                                                            std::unique_ptr<AnyCalendar>,
                                                            ReplacedRecords);

}  // namespace needlework
