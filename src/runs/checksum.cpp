#include "src/runs/checksum.h"

#include <boost/crc.hpp>

namespace needlework::runs {

std::uint64_t checksum_of(std::string_view bytes) {
  boost::crc_optimal<64, 0x42f0e1eba9ea3693, ~std::uint64_t{0}, ~std::uint64_t{0}, true, true> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

}  // namespace needlework::runs
