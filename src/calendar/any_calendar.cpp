#include "src/calendar/any_calendar.h"

#include "needlework/error.h"
#include "src/calendar/all.h"
#include "src/calendar/names.h"

namespace needlework {
namespace {

template <class... Calendars>
std::vector<std::string> names_of(CalendarList<Calendars...>) {
  return {std::string(Calendars::name)...};
}

template <class... Calendars>
std::unique_ptr<AnyCalendar> make_one_of(CalendarList<Calendars...>, const std::string& name) {
  std::unique_ptr<AnyCalendar> out;
  const auto make_if = [&]<class C>(CalendarList<C>) {
    if (name == C::name) out = std::make_unique<CalendarOf<C>>();
  };
  (make_if(CalendarList<Calendars>()), ...);
  if (out) return out;
  std::string names = "auto";
  for (const std::string& known : calendar_names()) names += ", " + known;
  throw InputError("engine.queue = \"" + name + "\": expected one of " + names);
}

}  // namespace

const std::vector<std::string>& calendar_names() {
  static const std::vector<std::string> names = names_of(AllCalendars<CalendarList>());
  return names;
}

std::unique_ptr<AnyCalendar> make_calendar(const std::string& name) {
  return make_one_of(AllCalendars<CalendarList>(), name);
}

}  // namespace needlework
