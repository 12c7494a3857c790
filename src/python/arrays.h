// NumPy arrays as the library's arrays, and the other way round.
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace needlework::python {

/// One number for each row. What is passed is converted, and copied if need be.
using Column = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// One vector for each needle, [N][3]. The Python side has checked the shape.
using Rows = Column;

template <class Number, int flags>
std::array<Number, 3> row(const pybind11::array_t<Number, flags>& rows, std::size_t i) {
  const Number* begin = rows.data() + 3 * i;
  return {begin[0], begin[1], begin[2]};
}

template <class Number, int flags>
std::vector<std::array<Number, 3>> vectors(const pybind11::array_t<Number, flags>& rows) {
  std::vector<std::array<Number, 3>> out(static_cast<std::size_t>(rows.size()) / 3);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = row(rows, i);
  return out;
}

/// An array of this shape with a copy of the numbers, which cannot be written to.
template <class Number>
pybind11::array read_only(const Number* numbers, std::vector<pybind11::ssize_t> shape) {
  pybind11::array_t<Number> array(std::move(shape), numbers);
  array.attr("setflags")(pybind11::arg("write") = false);
  return array;
}

/// The same for one number a row.
template <class Number>
pybind11::array read_only(const std::vector<Number>& values) {
  return read_only(values.data(), {static_cast<pybind11::ssize_t>(values.size())});
}

/// The same for vectors, [N][3].
template <class Number>
pybind11::array read_only(const std::vector<std::array<Number, 3>>& values) {
  const Number* begin = values.empty() ? nullptr : values.front().data();
  return read_only(begin, {static_cast<pybind11::ssize_t>(values.size()), 3});
}

}  // namespace needlework::python
