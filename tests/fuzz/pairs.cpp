// Fuzz target: any bytes are pairs of needles or an error, and each pair has a first contact or
// not.
#include <cmath>
#include <sstream>
#include <vector>

#include "needlework/predict.h"
#include "src/cli/pairs_file.h"
#include "tests/fuzz/target.h"

using namespace needlework;

namespace {

// The search for a contact of one pair may take a second, and more in a program that is
// instrumented.
constexpr std::size_t most_pairs = 4;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream in{std::string(fuzz::text_of(data, size))};
  fuzz::allow_bad_input([&] {
    std::vector<PairLine> pairs = read_pairs(in, "pairs");
    if (pairs.size() > most_pairs) pairs.resize(most_pairs);
    for (const PairLine& pair : pairs) {
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
