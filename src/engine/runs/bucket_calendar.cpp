#include "src/calendar/bucket_calendar.h"

#include "src/engine/make_run_with_body.h"

namespace needlework {

template std::unique_ptr<Run> make_run_with<BucketCalendar>(const Scene&, Gas, const std::string&,
                                                            const SearchSetup&);

}  // namespace needlework
