#include "src/calendar/any_calendar.h"

#include "needlework/error.h"
#include "src/calendar/all.h"

namespace needlework {
namespace {

template <class... Calendars>
std::unique_ptr<AnyCalendar> make_one_of(CalendarList<Calendars...>, const std::string& name) {
  std::unique_ptr<AnyCalendar> out;
  const auto make_if = [&]<class Calendar>(CalendarList<Calendar>) {
    if (name == Calendar::name) out = std::make_unique<CalendarOf<Calendar>>();
  };
  (make_if(CalendarList<Calendars>()), ...);
  if (out) return out;
  std::string names = "auto";
  ((names += std::string(", ") + Calendars::name), ...);
  throw InputError("engine.queue = \"" + name + "\": expected one of " + names);
}

}  // namespace

std::unique_ptr<AnyCalendar> make_calendar(const std::string& name) {
  return make_one_of(AllCalendars<CalendarList>(), name);
}

}  // namespace needlework
