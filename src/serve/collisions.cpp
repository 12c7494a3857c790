#include "src/serve/collisions.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "src/serve/arrays.h"

namespace needlework::serve {
namespace {

template <class Value>
using Get = Value (*)(const Collision&);

template <class Value>
std::string column(std::span<const Collision> collisions, Get<Value> get) {
  std::vector<Value> values;
  values.reserve(collisions.size());
  for (const Collision& collision : collisions) values.push_back(get(collision));
  return text_of(values);
}

struct Field {
  std::string_view name;
  std::string (*text)(std::span<const Collision>);
};

using Pair = std::array<double, 2>;
using VectorPair = std::array<std::array<double, 3>, 2>;

template <auto member>
VectorPair after(const Collision& c) {
  return {c.after[0].*member, c.after[1].*member};
}

template <auto get>
std::string text(std::span<const Collision> collisions) {
  return column<decltype(get(collisions[0]))>(collisions, get);
}

constexpr std::array fields{
    Field{"time", text<+[](const Collision& c) { return c.time; }>},
    Field{"epoch", text<+[](const Collision& c) { return c.epoch; }>},
    Field{"offset", text<+[](const Collision& c) { return c.offset; }>},
    Field{"pair", text<+[](const Collision& c) {
            return std::array{c.first, c.second};
          }>},
    Field{"arms", text<+[](const Collision& c) {
            return Pair{c.arm_first, c.arm_second};
          }>},
    Field{"normal_velocity", text<+[](const Collision& c) { return c.normal_velocity; }>},
    Field{"impulse", text<+[](const Collision& c) { return c.impulse; }>},
    Field{"shift", text<+[](const Collision& c) { return c.shift; }>},
    Field{"tc", text<+[](const Collision& c) { return std::uint8_t{c.contact_time_rule}; }>},
    Field{"sin_angle", text<+[](const Collision& c) { return c.sin_angle; }>},
    Field{"energy_change", text<+[](const Collision& c) { return c.energy_change; }>},
    Field{"position", text<after<&StateAfterCollision::position>>},
    Field{"velocity", text<after<&StateAfterCollision::velocity>>},
    Field{"orientation", text<after<&StateAfterCollision::orientation>>},
    Field{"angular_velocity", text<after<&StateAfterCollision::angular_velocity>>}};
constexpr std::size_t states = 4;  // at the end

constexpr auto names = [] {
  std::array<std::string_view, fields.size()> out;
  for (std::size_t n = 0; n < out.size(); ++n) out[n] = fields[n].name;
  return out;
}();

}  // namespace

std::span<const std::string_view> collision_fields() { return names; }

std::vector<std::string> usual_collision_fields() { return {names.begin(), names.end() - states}; }

Json collisions_as_arrays(std::span<const Collision> collisions,
                          std::span<const std::string> wanted) {
  Json out = Json::object();
  for (const std::string& name : wanted) {
    for (const Field& field : fields) {
      if (field.name == name) out[name] = field.text(collisions);
    }
  }
  return out;
}

}  // namespace needlework::serve
