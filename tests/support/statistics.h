// Means with standard errors, and chi-square tests, for tests that are statistical.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <ostream>
#include <vector>

namespace needlework::test {

/// A measured number and its standard error.
struct Measured {
  double value = 0;
  double error = 0;

  Measured operator/(double unit) const { return {value / unit, error / std::abs(unit)}; }
  /// How many standard errors above this expectation.
  double deviation(double expected) const { return (value - expected) / error; }
};

inline std::ostream& operator<<(std::ostream& out, const Measured& measured) {
  return out << measured.value << " +- " << measured.error;
}

/// Whether the measured number is within this many standard errors of the expected one.
inline testing::AssertionResult agrees(const Measured& measured, double expected, double errors) {
  // Not >, so that NaN fails.
  const bool good = std::abs(measured.value - expected) <= errors * measured.error;
  return (good ? testing::AssertionSuccess() : testing::AssertionFailure())
         << measured << " is " << measured.deviation(expected) << " standard errors from "
         << expected;
}

/// Mean of independent samples, such as runs with different seeds or long batches of one run.
class Mean {
 public:
  void add(double sample) {
    ++count_;
    const double step = sample - mean_;
    mean_ += step / count_;
    squares_ += step * (sample - mean_);
  }
  double variance() const { return squares_ / (count_ - 1); }
  Measured measured() const { return {mean_, std::sqrt(variance() / count_)}; }

 private:
  double count_ = 0, mean_ = 0, squares_ = 0;
};

/// Outcome of a chi-square test.
struct ChiSquare {
  double value = 0;
  double degrees = 0;     ///< of freedom
  std::size_t worst = 0;  ///< bin that deviates most
  double deviation = 0;   ///< of that bin, in standard errors

  /// Probability of a value at least this large, if the law is true.
  double probability() const { return boost::math::gamma_q(degrees / 2, value / 2); }
};

inline std::ostream& operator<<(std::ostream& out, const ChiSquare& test) {
  return out << "chi-square " << test.value << " with " << test.degrees
             << " degrees of freedom, probability " << test.probability() << ", worst bin "
             << test.worst << " by " << test.deviation << " standard errors";
}

/// Counts in bins of known probabilities, sampled in batches of a run. Neighbouring samples are
/// correlated, so each bin's variance is the multinomial one times a factor above 1 if the scatter
/// of the batches shows more. (The scatter alone would not do: a rare bin that stays empty has
/// none.)
class BatchHistogram {
 public:
  /// `probabilities` sum to 1.
  explicit BatchHistogram(std::vector<double> probabilities)
      : probabilities_(std::move(probabilities)),
        batch_(probabilities_.size()),
        total_(probabilities_.size()),
        scatter_(probabilities_.size()) {}

  void add(std::size_t bin) { ++batch_[bin]; }

  void end_batch() {
    double samples = 0;
    for (const double count : batch_) samples += count;
    for (std::size_t bin = 0; bin < batch_.size(); ++bin) {
      const double p = probabilities_[bin];
      scatter_[bin].add((batch_[bin] - samples * p) / std::sqrt(samples * p * (1 - p)));
      total_[bin] += batch_[bin];
      batch_[bin] = 0;
    }
    samples_ += samples;
  }

  std::size_t bins() const { return total_.size(); }
  double expected(std::size_t bin) const { return samples_ * probabilities_[bin]; }
  double counted(std::size_t bin) const { return total_[bin]; }
  /// Variance of the bin over the multinomial one.
  double excess(std::size_t bin) const { return std::max(1.0, scatter_[bin].variance()); }

  ChiSquare chi_square() const {
    ChiSquare out;
    out.degrees = static_cast<double>(total_.size() - 1);
    for (std::size_t bin = 0; bin < total_.size(); ++bin) {
      const double variance = expected(bin) * excess(bin);
      const double deviation = (total_[bin] - expected(bin)) / std::sqrt(variance);
      out.value += deviation * deviation;
      if (std::abs(deviation) > std::abs(out.deviation)) {
        out.worst = bin;
        out.deviation = deviation;
      }
    }
    return out;
  }

 private:
  std::vector<double> probabilities_, batch_, total_;
  std::vector<Mean> scatter_;
  double samples_ = 0;
};

/// Bin of x among those that end at these ascending edges; values beyond the last edge are in the
/// last bin.
inline std::size_t bin_of(double x, const std::vector<double>& ends) {
  const auto end = std::upper_bound(ends.begin(), ends.end() - 1, x);
  return static_cast<std::size_t>(end - ends.begin());
}

}  // namespace needlework::test
