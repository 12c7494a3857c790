#include "src/search/near_search.h"

#include "src/engine/loops/make_event_loop.h"

namespace needlework {

template std::unique_ptr<Loop> make_event_loop<NearSearch>(Run&, NearSearch,
                                                           std::unique_ptr<AnyCalendar>,
                                                           ReplacedRecords);

}  // namespace needlework
