#include "src/calendar/cell_calendar.h"

#include "src/engine/make_loop_with_body.h"
#include "src/engine/parallel_loop.h"

namespace needlework {

template std::unique_ptr<Loop> make_loop_with<CellCalendar>(const Scene&, Run&, const std::string&,
                                                            const SearchSetup&);

}  // namespace needlework
