#include "src/search/all_pairs.h"

#include "src/engine/loops/make_event_loop.h"

namespace needlework {

template std::unique_ptr<Loop> make_event_loop<AllPairs>(Run&, AllPairs,
                                                         std::unique_ptr<AnyCalendar>,
                                                         ReplacedRecords);

}  // namespace needlework
