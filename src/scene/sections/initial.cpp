// [initial].
#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

// Files that exist may have any name that the system allows. Messages escape what is not printable.
std::optional<std::string> path_to_read(const Value& value) {
  const auto* string = value.as<std::string>();
  const bool is_path = string && !string->empty() && string->find('\0') == string->npos;
  return is_path ? std::optional(*string) : std::nullopt;
}

}  // namespace

SceneSection initial_section() {
  using namespace from_value;
  using V = const Value&;
  using R = const ValueRange&;
  constexpr const char* not_both = "expected either file or temperatures to draw, not both";
  constexpr Replaces replaces = Replaces::first_the_second;
  return {
      .name = "initial",
      .keys =
          {
              {"t_tr", Aspect::start, or_zero(temperatures), expected_temperature,
               [](Scene& s, V v, R r) { return store(s.initial.t_tr, number(v, r)); }},
              {"t_rot", Aspect::start, or_zero(temperatures), expected_temperature,
               [](Scene& s, V v, R r) { return store(s.initial.t_rot, number(v, r)); }},
              {"file",
               Aspect::output,
               {},
               "the path of an H5MD file",
               [](Scene& s, V v, R) { return store(s.initial.file, path_to_read(v)); }},
              {"packing",
               Aspect::start,
               {},
               R"("auto", "insertion", "lattice", "crossed" or "compress")",
               [](Scene& s, V v, R) {
                 return store(s.initial.packing,
                              one_of(v, {"auto", "insertion", "lattice", "crossed", "compress"}));
               }},
          },
      .exclusions = {{"initial.file", "initial.t_tr", not_both, replaces},
                     {"initial.file", "initial.t_rot", not_both, replaces},
                     {"initial.file", "species.t_tr", not_both, replaces},
                     {"initial.file", "species.t_rot", not_both, replaces},
                     {"initial.file", "initial.packing",
                      "expected either file or packing, not both: a file says places", replaces}},
  };
}

}  // namespace needlework
