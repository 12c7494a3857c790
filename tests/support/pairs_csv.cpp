#include "tests/support/pairs_csv.h"

#include <fmt/format.h>

#include <iterator>
#include <ostream>

namespace needlework::test {

std::string csv_line(std::size_t id, const NeedlePair& pair) {
  std::string line;
  auto out = std::back_inserter(line);
  fmt::format_to(out, "{},{},{:.17g}", id, pair.family, pair.horizon);
  for (const FreeNeedle* needle : {&pair.first, &pair.second}) {
    for (const auto& vector :
         {needle->position, needle->orientation, needle->velocity, needle->angular_velocity}) {
      for (const double value : vector) fmt::format_to(out, ",{:.17g}", value);
    }
  }
  fmt::format_to(out, ",{}", pair.just_collided ? 1 : 0);
  return line;
}

void write_pairs(std::ostream& out, std::span<const NeedlePair> pairs, std::size_t first_id) {
  out << "# id,family,horizon";
  for (const char needle : {'1', '2'}) {
    for (const char quantity : {'r', 'u', 'v', 'w'}) {
      for (const char axis : {'x', 'y', 'z'}) out << ',' << quantity << needle << axis;
    }
  }
  out << ",skip\n";
  for (std::size_t i = 0; i < pairs.size(); ++i) out << csv_line(first_id + i, pairs[i]) << '\n';
}

}  // namespace needlework::test
