// Where the ticks of an axis are, and how values are mapped to it.
#pragma once

#include <string>
#include <vector>

namespace needlework::picture {

struct Range {
  double low = 0, high = 1;
};

/// A place on an axis with its number, such as "0.5" or "2·10⁻³".
struct Tick {
  double value;
  std::string label;
};

/// Whether an axis has a place for the value: it is finite and, on a logarithmic axis, positive.
bool can_be_placed(double value, bool logarithmic);

/// A range that an axis can show: finite, of positive length, and positive if logarithmic. It is
/// `range` itself wherever possible; an empty range is widened.
Range usable_range(Range range, bool logarithmic);

/// Least and greatest of the values that can be placed; a usable range if there are none.
class RangeOfValues {
 public:
  explicit RangeOfValues(bool logarithmic) : logarithmic_(logarithmic) {}
  void add(double value);
  void add(const std::vector<double>& values);
  bool empty() const { return empty_; }
  /// With a margin at both ends, as a share of the length of the axis.
  Range range(double margin = 0) const;

 private:
  bool logarithmic_;
  bool empty_ = true;
  Range range_;
};

/// About `count` ticks at multiples of 1, 2 or 5 times a power of ten, or at decades. The range
/// must be usable.
std::vector<Tick> ticks(Range range, bool logarithmic, int count);

/// Maps values to pixels.
struct Scale {
  Range range;
  bool logarithmic = false;
  double begin = 0, end = 1;  ///< pixels of range.low and range.high

  /// Pixel of a value, also outside of the range; NaN if the value cannot be placed.
  double operator()(double value) const;
};

}  // namespace needlework::picture
