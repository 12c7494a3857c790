// Fuzz target: any bytes are a configuration of another program or an error.
#include <cmath>

#include "src/io/formats/read_configuration.h"
#include "tests/fuzz/target.h"

using namespace needlework;

namespace {

template <class Rows>
void require_finite(const Rows& rows, std::size_t count) {
  fuzz::require(rows.size() == count);
  for (const auto& row : rows) {
    for (const double value : row) fuzz::require(std::isfinite(value));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = fuzz::folder() / "input";
  fuzz::write_file(path, fuzz::text_of(data, size));
  fuzz::allow_bad_input([&] {
    const State state = io::read_configuration(path).state;
    for (const double edge : state.box) fuzz::require(edge > 0);
    for (const auto* rows :
         {&state.position, &state.velocity, &state.orientation, &state.angular_velocity}) {
      require_finite(*rows, state.size());
    }
    fuzz::require(state.image.empty() || state.image.size() == state.size());
    fuzz::require(state.id.empty() || state.id.size() == state.size());
  });
  return 0;
}
