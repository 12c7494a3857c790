// Numbers with their rate of change. Over balls of time, the rate holds all that the derivative
// takes in an interval, which bounds what the number itself does there.
#pragma once

#include "src/audit/ball.h"

namespace needlework::audit {

template <class Number>
struct Dual {
  Number value, rate;

  Dual() = default;
  Dual(double constant) : value(constant), rate(0.0) {}  // implicit, as that of balls
  Dual(const Number& its_value, const Number& its_rate) : value(its_value), rate(its_rate) {}
};

template <class Number>
Dual<Number> operator+(const Dual<Number>& a, const Dual<Number>& b) {
  return {a.value + b.value, a.rate + b.rate};
}

template <class Number>
Dual<Number> operator-(const Dual<Number>& a, const Dual<Number>& b) {
  return {a.value - b.value, a.rate - b.rate};
}

template <class Number>
Dual<Number> operator*(const Dual<Number>& a, const Dual<Number>& b) {
  return {a.value * b.value, a.rate * b.value + a.value * b.rate};
}

/// The value of b must not contain 0.
template <class Number>
Dual<Number> operator/(const Dual<Number>& a, const Dual<Number>& b) {
  const Number quotient = a.value / b.value;
  return {quotient, (a.rate - quotient * b.rate) / b.value};
}

}  // namespace needlework::audit
