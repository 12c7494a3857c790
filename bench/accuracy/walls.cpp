// bench_wall_accuracy CASES [SEED]: how often the first contact of a tip with a wall differs from
// that of an oracle of 113 bits, of so many cases of each family. Exit code 1 if it ever does.
#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>

#include "tests/support/wall_oracle.h"

int main(int count, char** arguments) {
  using namespace needlework::test;
  if (count < 2) {
    fmt::print(stderr, "usage: bench_wall_accuracy CASES [SEED]\n");
    return 2;
  }
  const auto cases = static_cast<std::uint64_t>(std::strtod(arguments[1], nullptr));
  const std::uint64_t seed = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1;
  constexpr double to = 3;
  std::uint64_t wrong = 0;
  fmt::print("{:9} {:>10} {:>10} {:>7} {:>9} {:>10} {:>6}\n", "family", "cases", "contacts",
             "missed", "invented", "wrong tip", "off");
  for (int family = 0; family < wall_families; ++family) {
    DrawnWalls drawn(seed * wall_families + static_cast<std::uint64_t>(family));
    WallComparison found;
    for (std::uint64_t n = 0; n < cases; ++n) {
      found.add(drawn.draw(static_cast<WallFamily>(family)), to);
    }
    fmt::print("{:9} {:10} {:10} {:7} {:9} {:10} {:6}\n", name_of(static_cast<WallFamily>(family)),
               found.cases, found.contacts, found.missed, found.invented, found.wrong_tip,
               found.off);
    std::fflush(stdout);
    wrong += found.wrong();
  }
  return wrong == 0 ? 0 : 1;
}
