// Fuzz target: any bytes are pairs of needles or an error, and each pair has a first contact or
// not.
#include <cmath>
#include <sstream>

#include "needlework/predict.h"
#include "src/cli/pairs_file.h"
#include "tests/fuzz/target.h"

using namespace needlework;

namespace {

// The search follows needles up to 4e6 radians and says so then, which takes some seconds.
constexpr double most_turns = 1e4;

double turns(const PairLine& pair) {
  const auto speed = [](const std::array<double, 3>& w) { return std::hypot(w[0], w[1], w[2]); };
  return (speed(pair.first.angular_velocity) + speed(pair.second.angular_velocity)) * pair.horizon;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream in{std::string(fuzz::text_of(data, size))};
  fuzz::allow_bad_input([&] {
    for (const PairLine& pair : read_pairs(in, "pairs")) {
      if (!(turns(pair) < most_turns)) continue;
      fuzz::allow_bad_input([&] {
        const FirstContact contact =
            predict(pair.first, pair.second, pair.horizon, pair.just_collided);
        fuzz::require(contact.time >= 0 &&
                      (contact.time <= pair.horizon || std::isinf(contact.time)));
      });
    }
  });
  return 0;
}
