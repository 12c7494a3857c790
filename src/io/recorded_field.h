// Reads the series of observables back from the file of a run.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace needlework::io {

/// One quantity of an observable: a row for each sample, or a constant of the run.
struct RecordedField {
  std::vector<std::size_t> shape;  ///< of a row; of all numbers of a constant
  std::vector<double> times;       ///< of the samples; empty for a constant
  std::vector<double> values;      ///< row after row

  /// The row of a sample, counted from 0.
  std::span<const double> row(std::size_t sample) const {
    const std::size_t width = times.empty() ? values.size() : values.size() / times.size();
    return std::span(values).subspan(sample * width, width);
  }
};

/// Reads /series/`name`, such as "flow_order/translational" or "alignment/borders", as far as its
/// rows are complete. Throws IoError if the file cannot be read, and InputError if it does not have
/// the field.
RecordedField read_field(const std::string& path, const std::string& name);

}  // namespace needlework::io
