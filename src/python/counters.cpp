// The counters of a run, by name.
#include "needlework/counters.h"

#include <utility>

#include "src/python/run.h"

namespace needlework::python {

namespace py = pybind11;

py::dict Run::counters() {
  require_idle();
  static constexpr std::pair<const char*, std::uint64_t Counters::*> names[] = {
      {"events", &Counters::events},
      {"stale", &Counters::stale},
      {"crossings", &Counters::crossings},
      {"rebuilds", &Counters::rebuilds},
      {"sorts", &Counters::sorts},
      {"resized", &Counters::resized},
      {"renewals", &Counters::renewals},
      {"searches", &Counters::searches},
      {"candidates", &Counters::candidates},
      {"filtered", &Counters::filtered},
      {"isolated", &Counters::isolated},
      {"predicted", &Counters::predicted},
      {"evaluated", &Counters::evaluated},
      {"escalated", &Counters::escalated},
      {"touches", &Counters::touches},
      {"phases", &Counters::phases},
      {"redone", &Counters::redone},
      {"border", &Counters::border},
      {"held", &Counters::held},
      {"waited", &Counters::waited},
      {"foreign", &Counters::foreign},
      {"turns", &Counters::turns},
      {"blocked", &Counters::blocked}};
  static_assert(std::size(names) == std::size(Counters::members));
  const Counters& counters = run_->simulation().counters();
  py::dict out;
  for (const auto& [name, member] : names) out[name] = counters.*member;
  return out;
}

}  // namespace needlework::python
