#include "src/box/shear.h"

#include <cmath>
#include <type_traits>

namespace needlework {

Shear::Shear(double rate, const Vector& edges, double offset)
    : velocity_(rate * edges[1]), rate_(velocity_ / edges[1]), edge_(edges[0]), start_(offset) {
  set_epoch(1);
}

void Shear::set_epoch(double length) {
  // Exact, as the length is a power of two; and so are remainders.
  const double way = std::abs(velocity_) * length;
  double rest = std::fmod(way, edge_);
  boxes_per_epoch_ = std::nearbyint((way - rest) / edge_);
  high_ = low_ = 0;
  for (int bit = 0; bit < 128; ++bit) {
    high_ = high_ << 1 | low_ >> 63;
    low_ <<= 1;
    rest *= 2;
    if (rest < edge_) continue;
    rest -= edge_;
    low_ |= 1;
  }
}

template <class Real>
RowSlide Shear::at(std::int64_t epoch, double offset) const {
  __extension__ using Fraction = unsigned __int128;
  const auto epochs = static_cast<std::uint64_t>(epoch);
  const Fraction low = Fraction{low_} * epochs;
  const Fraction high = Fraction{high_} * epochs + static_cast<std::uint64_t>(low >> 64);
  const auto whole = static_cast<std::uint32_t>(high >> 64) +
                     static_cast<std::uint32_t>(static_cast<std::uint64_t>(boxes_per_epoch_)) *
                         static_cast<std::uint32_t>(epochs);
  const auto first = static_cast<std::uint64_t>(high), second = static_cast<std::uint64_t>(low);
  const bool backwards = velocity_ < 0;
  const std::uint32_t boxes = backwards ? 0u - whole : whole;
  if constexpr (std::is_same_v<Real, double>) {
    const double slid =
        static_cast<double>(first >> 11) * 0x1p-53 * edge_ + std::abs(velocity_) * offset;
    return reduced(velocity_, DoubleDouble((backwards ? -slid : slid) + start_), boxes, edge_);
  }
  // In parts that doubles hold.
  const DoubleDouble share =
      DoubleDouble(static_cast<double>(first >> 11) * 0x1p-53) +
      DoubleDouble(static_cast<double>((first & 0x7ff) << 42 | second >> 22) * 0x1p-106);
  DoubleDouble slid = share * DoubleDouble(edge_) + two_prod(std::abs(velocity_), offset);
  if (backwards) slid = -slid;
  return reduced(velocity_, slid + DoubleDouble(start_), boxes, edge_);
}

template RowSlide Shear::at<double>(std::int64_t, double) const;
template RowSlide Shear::at<DoubleDouble>(std::int64_t, double) const;

RowSlide reduced(double velocity, const DoubleDouble& offset, std::uint32_t boxes, double edge) {
  const double more = std::floor(offset.hi / edge);
  if (more == 0) return {velocity, offset, boxes};
  return {velocity, offset - two_prod(more, edge),
          boxes + static_cast<std::uint32_t>(static_cast<std::int64_t>(more))};
}

}  // namespace needlework
