#include "src/serve/collisions.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "src/json/base64.h"

namespace needlework::serve {

using json::text_of;
namespace {

const Collision& event_of(const Collision& collision) { return collision; }
const Collision& event_of(const Happening& happening) { return happening.event; }
std::uint8_t kind_of(const Collision&) { return Happening::pair; }
std::uint8_t kind_of(const Happening& happening) { return happening.kind; }

// One row for each report.
template <class Report, class Get>
std::string column(std::span<const Report> reports, Get get) {
  std::vector<std::invoke_result_t<Get, const Report&>> values;
  values.reserve(reports.size());
  for (const Report& report : reports) values.push_back(get(report));
  return text_of(values);
}

struct Field {
  std::string_view name;
  std::string (*of_collisions)(std::span<const Collision>);
  std::string (*of_happenings)(std::span<const Happening>);
};

using Pair = std::array<double, 2>;
using VectorPair = std::array<std::array<double, 3>, 2>;

template <auto member>
VectorPair after(const Collision& c) {
  return {c.after[0].*member, c.after[1].*member};
}

template <auto get, class Report>
std::string text(std::span<const Report> reports) {
  return column(reports, [](const Report& report) { return get(event_of(report)); });
}
template <auto get>
constexpr Field field(std::string_view name) {
  return {name, text<get, Collision>, text<get, Happening>};
}

template <class Report>
std::string kinds(std::span<const Report> reports) {
  return column(reports, [](const Report& report) { return kind_of(report); });
}

constexpr std::string_view kind = "kind";
constexpr std::array fields{
    field<[](const Collision& c) { return c.time; }>("time"),
    field<[](const Collision& c) { return c.epoch; }>("epoch"),
    field<[](const Collision& c) { return c.offset; }>("offset"),
    field<[](const Collision& c) {
      return std::array{c.first, c.second};
    }>("pair"),
    field<[](const Collision& c) {
      return Pair{c.arm_first, c.arm_second};
    }>("arms"),
    field<[](const Collision& c) { return c.normal_velocity; }>("normal_velocity"),
    field<[](const Collision& c) { return c.impulse; }>("impulse"),
    field<[](const Collision& c) { return c.shift; }>("shift"),
    field<[](const Collision& c) { return std::uint8_t{c.contact_time_rule}; }>("tc"),
    field<[](const Collision& c) { return c.sin_angle; }>("sin_angle"),
    field<[](const Collision& c) { return c.energy_change; }>("energy_change"),
    Field{kind, kinds<Collision>, kinds<Happening>},
    field<after<&StateAfterCollision::position>>("position"),
    field<after<&StateAfterCollision::velocity>>("velocity"),
    field<after<&StateAfterCollision::orientation>>("orientation"),
    field<after<&StateAfterCollision::angular_velocity>>("angular_velocity")};
constexpr std::size_t states = 4;  // at the end

template <bool with_kind>
constexpr auto names = [] {
  std::array<std::string_view, fields.size() - !with_kind> out;
  std::size_t n = 0;
  for (const Field& each : fields) {
    if (with_kind || each.name != kind) out[n++] = each.name;
  }
  return out;
}();

template <class Report>
Json arrays_of(std::span<const Report> reports, std::span<const std::string> wanted,
               std::string (*Field::*text)(std::span<const Report>)) {
  Json out = Json::object();
  for (const std::string& name : wanted) {
    for (const Field& each : fields) {
      if (each.name == name) out[name] = (each.*text)(reports);
    }
  }
  return out;
}

}  // namespace

std::span<const std::string_view> report_fields(bool with_kind) {
  if (with_kind) return names<true>;
  return names<false>;
}

std::vector<std::string> usual_fields(bool with_kind) {
  const auto all = report_fields(with_kind);
  return {all.begin(), all.end() - states};
}

Json as_arrays(std::span<const Collision> collisions, std::span<const std::string> wanted) {
  return arrays_of(collisions, wanted, &Field::of_collisions);
}

Json as_arrays(std::span<const Happening> happenings, std::span<const std::string> wanted) {
  return arrays_of(happenings, wanted, &Field::of_happenings);
}

}  // namespace needlework::serve
