// A checksum of bytes.
#pragma once

#include <cstdint>
#include <string_view>

namespace needlework::runs {

/// The cyclic redundancy check of ECMA-182.
std::uint64_t checksum_of(std::string_view bytes);

}  // namespace needlework::runs
