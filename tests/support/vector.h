// Three-vectors over any number type, for the oracle and the generators of test pairs.
#pragma once

#include <array>
#include <cmath>

namespace needlework::test {

template <class T>
using Vec = std::array<T, 3>;

template <class T>
Vec<T> operator+(const Vec<T>& a, const Vec<T>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

template <class T>
Vec<T> operator-(const Vec<T>& a, const Vec<T>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class T>
Vec<T> operator*(const T& factor, const Vec<T>& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

template <class T>
T dot(const Vec<T>& a, const Vec<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class T>
T norm(const Vec<T>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

template <class To, class From>
Vec<To> convert(const Vec<From>& a) {
  return {static_cast<To>(a[0]), static_cast<To>(a[1]), static_cast<To>(a[2])};
}

}  // namespace needlework::test
