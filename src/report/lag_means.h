// Correlation functions in time, from the rows of /series/time_correlation.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "src/io/contents.h"

namespace needlework::report {

/// The mean of its datasets over all rows, at each lag over those that are as far apart in time as
/// most samples of this lag: a run may end, or be sampled by callers, between them. Where most
/// samples are not evenly spaced there is no such mean, and the values are those of the last row.
class LagMeans {
 public:
  /// `group`: the path of time_correlation.
  LagMeans(const io::Contents& contents, const std::string& group);

  /// How many rows the mean is of; 0 where it is the last row alone.
  std::size_t rows() const { return is_mean_ ? rows_ : 0; }
  /// One row of a dataset of the group that has as many values as the dataset `lag`. NaN where
  /// there is no value.
  std::vector<double> of(const std::string& dataset) const;

 private:
  const io::Contents& contents_;
  std::size_t rows_ = 0;
  bool is_mean_ = false;
  std::vector<bool> counts_;  ///< of each value of each row, whether it is of the mean
};

}  // namespace needlework::report
