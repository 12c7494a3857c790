#include "src/calendar/tournament.h"

#include "src/engine/make_run_with_body.h"

namespace needlework {

template std::unique_ptr<Run> make_run_with<Tournament>(const Scene&, Gas, const std::string&,
                                                        const SearchSetup&);

}  // namespace needlework
