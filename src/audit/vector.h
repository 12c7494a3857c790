// Three-vectors over any number type.
#pragma once

#include <array>
#include <cmath>

namespace needlework::audit {

template <class T>
struct Vector {
  std::array<T, 3> components;

  T& operator[](int axis) { return components[axis]; }
  const T& operator[](int axis) const { return components[axis]; }
};

template <class T>
Vector<T> operator+(const Vector<T>& a, const Vector<T>& b) {
  return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}};
}

template <class T>
Vector<T> operator-(const Vector<T>& a, const Vector<T>& b) {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}

template <class T>
Vector<T> operator*(const Vector<T>& a, const T& factor) {
  return {{a[0] * factor, a[1] * factor, a[2] * factor}};
}

template <class T>
T dot(const Vector<T>& a, const Vector<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
Vector<T> cross(const Vector<T>& a, const Vector<T>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

template <class T>
T norm(const Vector<T>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

inline Vector<double> vector(const std::array<double, 3>& a) { return {a}; }

/// The same vector in another number type.
template <class To, class From>
Vector<To> to(const Vector<From>& a) {
  return {{To(a[0]), To(a[1]), To(a[2])}};
}

}  // namespace needlework::audit
