#include "src/python/collision_rows.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <type_traits>

#include "needlework/error.h"

namespace needlework::python {
namespace {

namespace py = pybind11;

/// A row as python/needlework/collisions.py describes it to NumPy. The states after the collision
/// follow, if they are wanted.
struct Row {
  double time;
  std::int64_t epoch;
  double offset;
  std::array<std::uint32_t, 2> pair;
  std::array<double, 2> arms;
  double normal_velocity;
  std::array<double, 3> impulse;
  std::array<std::int32_t, 3> shift;
  bool tc;
  std::uint8_t kind;  // padding of the type of collisions
  double sin_angle;
  double energy_change;
};
using States = decltype(Collision::after);
static_assert(std::is_trivially_copyable_v<Row> && std::is_trivially_copyable_v<States>);
static_assert(sizeof(Row) == 112 && sizeof(States) == 2 * 12 * sizeof(double));

Row row_of(const Collision& c, std::uint8_t kind) {
  return {.time = c.time,
          .epoch = c.epoch,
          .offset = c.offset,
          .pair = {c.first, c.second},
          .arms = {c.arm_first, c.arm_second},
          .normal_velocity = c.normal_velocity,
          .impulse = c.impulse,
          .shift = c.shift,
          .tc = c.contact_time_rule,
          .kind = kind,
          .sin_angle = c.sin_angle,
          .energy_change = c.energy_change};
}

// The event and the kind of each report are given by event_of() and kind_of().
template <class Report, class EventOf, class KindOf>
py::array rows(std::span<const Report> reports, const py::dtype& type, EventOf event_of,
               KindOf kind_of) {
  const auto bytes = static_cast<std::size_t>(type.itemsize());
  const bool states = bytes == sizeof(Row) + sizeof(States);
  if (!states && bytes != sizeof(Row)) {
    throw InputError("collisions: expected the type of rows of needlework.collisions");
  }
  py::array rows(type, static_cast<py::ssize_t>(reports.size()));
  auto* place = static_cast<std::byte*>(rows.mutable_data());
  for (const Report& report : reports) {
    const Collision& event = event_of(report);
    const Row row = row_of(event, kind_of(report));
    std::memcpy(place, &row, sizeof(Row));
    if (states) std::memcpy(place + sizeof(Row), &event.after, sizeof(States));
    place += bytes;
  }
  return rows;
}

}  // namespace

py::array rows_of(std::span<const Collision> collisions, const py::dtype& type) {
  return rows(collisions, type, std::identity{}, [](const Collision&) { return Happening::pair; });
}

py::array rows_of(std::span<const Happening> happenings, const py::dtype& type) {
  return rows(
      happenings, type, [](const Happening& what) -> const Collision& { return what.event; },
      [](const Happening& what) { return what.kind; });
}

}  // namespace needlework::python
