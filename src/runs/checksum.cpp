#include "src/runs/checksum.h"

#include <algorithm>
#include <boost/crc.hpp>

#include "src/machine/stop_request.h"

namespace needlework::runs {

constexpr std::size_t piece = std::size_t{1} << 26;

std::uint64_t checksum_of(std::string_view bytes) {
  boost::crc_optimal<64, 0x42f0e1eba9ea3693, ~std::uint64_t{0}, ~std::uint64_t{0}, true, true> crc;
  // In pieces, between which it can be stopped.
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), piece))) {
    StopRequest::check();
    crc.process_bytes(bytes.data(), std::min(bytes.size(), piece));
  }
  return crc.checksum();
}

}  // namespace needlework::runs
