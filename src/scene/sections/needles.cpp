// [needles], and whether the box has room for them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "src/scene/box_edges.h"
#include "src/scene/confinement.h"
#include "src/scene/derived_numbers.h"
#include "src/scene/read_value.h"
#include "src/scene/rod_room.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

constexpr const char* expected_box = "an edge from 2.01 to 1e9, or an array of three edges";
// Of the shortest needles, between walls, to the largest; see Room.
constexpr ValueRange box_edges{1e-6, largest_edge(1)};
constexpr ValueRange seeds{0, static_cast<double>(std::numeric_limits<std::int64_t>::max())};

std::optional<std::array<double, 3>> box_in(const Value& value, const ValueRange& range) {
  if (const auto side = from_value::number(value, range)) return std::array{*side, *side, *side};
  return from_value::three_numbers(value, range);
}

Violation violation_of_box(const Scene& scene, std::string reason) {
  return {.key = "needles.box",
          .value = fmt::format("[{}]", fmt::join(scene.needles.box, ", ")),
          .reason = std::move(reason)};
}

std::optional<Violation> box_is_too_small_or_large(const Scene& scene) {
  const std::array<double, 3>& box = scene.needles.box;
  const Room room(scene);
  if (room.holds(box)) return {};
  const Composition composition = scene.composition();
  const bool is_plain =
      composition.longest() == 1 && scene.walls.empty() && !scene.collisions.sliding;
  if (is_plain) return violation_of_box(scene, fmt::format("expected {}", expected_box));
  return violation_of_box(scene, fmt::format("expected {}{}", room.expected_instead_of(box),
                                             composition.has_own_sizes() ? ", of the longest body"
                                             : composition.is_mixture() ? ", of the longest species"
                                                                        : ""));
}

std::optional<Violation> needles_are_too_sparse(const Scene& scene) {
  const Composition composition = scene.composition();
  if (!is_too_sparse(scene.needles.box, static_cast<double>(composition.count()),
                     composition.longest()))
    return {};
  return violation_of_box(scene, fmt::format("expected {}", not_too_sparse));
}

std::optional<Violation> numbers_cannot_be_followed(const Scene& scene) {
  const std::string reason = out_of_range(numbers_of_drawn(scene));
  if (reason.empty()) return {};
  return Violation{.key = {}, .value = {}, .reason = "its needles and temperatures give " + reason};
}

std::optional<Violation> rods_fill_more_than_any_packing(const Scene& scene) {
  const Composition composition = scene.composition();
  if (!composition.has_width() || !composition.all_meet()) return {};
  // There is room beyond the edge of the box.
  if (std::ranges::any_of(gaps_of(scene), &Gap::is_open)) return {};
  const auto& box = scene.needles.box;
  const double packing = composition.packing_fraction(box[0] * box[1] * box[2]),
               most = densest_packing(composition);
  if (!(packing > most)) return {};
  return violation_of_box(
      scene,
      fmt::format("{} {} take up {:.4g} of it, and no packing more than {:.4g}: expected a larger "
                  "box",
                  composition.count(), composition.are_spheres() ? "spheres" : "rods", packing,
                  most));
}

}  // namespace

SceneSection needles_section() {
  using namespace from_value;
  using V = const Value&;
  using R = const ValueRange&;
  return {
      .name = "needles",
      .keys =
          {
              {"count", Aspect::start, counts_of_needles, expected_count,
               [](Scene& s, V v, R r) { return store(s.needles.count, whole_number(v, r)); },
               Presence::to_draw},
              {"box", Aspect::start, box_edges, expected_box,
               [](Scene& s, V v, R r) { return store(s.needles.box, box_in(v, r)); },
               Presence::to_draw},
              {"k", Aspect::bodies, range_of_k, expected_k,
               [](Scene& s, V v, R r) { return store(s.needles.k, number(v, r)); }},
              {"diameter", Aspect::bodies, lengths, expected_diameter,
               [](Scene& s, V v, R r) { return store(s.needles.diameter, number(v, r)); }},
              {"seed", Aspect::output, seeds,
               "a whole number in digits, from 0 to 9223372036854775807",
               [](Scene& s, V v, R r) { return store(s.needles.seed, whole_number(v, r)); }},
          },
      .rules = {{Aspect::room, box_is_too_small_or_large},
                {Aspect::start, needles_are_too_sparse},
                {Aspect::start, numbers_cannot_be_followed},
                {Aspect::start, rods_fill_more_than_any_packing}},
  };
}

}  // namespace needlework
