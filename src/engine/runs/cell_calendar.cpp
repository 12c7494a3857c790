#include "src/calendar/cell_calendar.h"

#include "src/engine/make_run_with_body.h"
#include "src/engine/parallel_loop.h"

namespace needlework {

template std::unique_ptr<Run> make_run_with<CellCalendar>(const Scene&, Gas, const std::string&,
                                                          const SearchSetup&);

}  // namespace needlework
