#include "tests/support/rod_oracle.h"

#include <cmath>
#include <type_traits>
#include <utility>

namespace needlework::test {
namespace {

using Extended = long double;

// Rods that turn fast and stay near contact for long are left undecided.
constexpr std::uint64_t most_evaluations = 1000000;

class RodOracle {
 public:
  explicit RodOracle(const RodCase& rods)
      : coarse_(rods),
        fine_(rods),
        speed_(fine_.speed + fine_.growth * Quad(rods.pair.distance)),
        contact_(rods.pair.distance) {
    size_ = static_cast<Extended>(norm(fine_.r) + fine_.half[0] + fine_.half[1] + contact_ +
                                  speed_ * rods.horizon);
    for (int i = 0; i < 2; ++i) {
      const Quad phase = fine_.omega[i] * (fine_.delay[i] + rods.horizon);
      size_ += static_cast<Extended>(fine_.half[i] * phase);
    }
  }

  RodAnswer run(const RodCase& rods) {
    const Quad start = fine_.distance(0);
    const Quad above = start - contact_;
    const Quad horizon = rods.horizon;
    if (above < Quad(1e-12) * Quad(size_)) {  // the records touch
      if (above < 0) contact_ = start;
      const Quad least = Quad(1e-27) * Quad(size_) / (speed_ > 0 ? speed_ : Quad(1));
      if (excess<Quad>(least) < 0) {
        answer_.contact = true;
        return answer_;
      }
      if (least >= horizon) return answer_;
      for (Quad from = least; from < horizon; from *= 2) {
        const Quad to = from * 2 < horizon ? Quad(from * 2) : horizon;
        if (search_in(from, to)) return answer_;
      }
      return answer_;
    }
    search_in(0, horizon);
    return answer_;
  }

 private:
  template <class Real>
  const RodMotion<Real>& motion() const {
    if constexpr (std::is_same_v<Real, Quad>)
      return fine_;
    else
      return coarse_;
  }
  template <class Real>
  Real excess(const Real& s) {
    ++answer_.evaluations;
    return motion<Real>().distance(s) - Real(contact_) * (1 + Real(fine_.growth) * s);
  }
  bool search_in(const Quad& from, const Quad& to) {
    if (Quad(to - from) * speed_ < fine_limit()) {
      return search<Quad>(from, excess<Quad>(from), to, excess<Quad>(to));
    }
    const auto a = static_cast<Extended>(from), b = static_cast<Extended>(to);
    return search<Extended>(a, excess<Extended>(a), b, excess<Extended>(b));
  }
  // Where the rods move by less than this, they may be seen to cross once.
  Quad crossing_limit() const { return Quad(1e-4) * (fine_.half[0] + fine_.half[1] + contact_); }
  Quad fine_limit() const { return Quad(1e-9) * Quad(size_); }

  // The first time in [a, b] at which the excess falls below 0; it is not below at a.
  template <class Real>
  bool search(const Real& a, const Real& at_a, const Real& b, const Real& at_b) {
    constexpr bool is_quad = std::is_same_v<Real, Quad>;
    if (answer_.evaluations > most_evaluations) answer_.undecided = true;
    if (answer_.undecided) return false;
    const Real h = b - a, way = Real(speed_) * h;
    const Real noise = Real(is_quad ? Quad(1e-32) : Quad(1e-17)) * Real(size_);
    if (at_a + at_b - way > noise) return false;
    const bool may_cross = at_a > noise && at_b < -noise && way < Real(crossing_limit());
    if (may_cross && crosses_once<Real>(a, at_a, b, at_b, noise)) return true;
    if constexpr (!is_quad) {
      if (Quad(way) < fine_limit()) {
        return search<Quad>(a, excess<Quad>(a), b, excess<Quad>(b));
      }
    } else {
      if (way < noise || !(a + h / 2 > a && a + h / 2 < b)) {
        if (at_b < -noise) {
          answer_.contact = true;
          answer_.time = b;
          return true;
        }
        answer_.undecided = true;
        return false;
      }
    }
    const Real middle = a + h / 2, at_middle = excess<Real>(middle);
    return search<Real>(a, at_a, middle, at_middle) || search<Real>(middle, at_middle, b, at_b);
  }

  // Regula falsi (Illinois) where the slopes at both ends of a short interval agree with the chord,
  // if Real has enough digits for its root.
  template <class Real>
  bool crosses_once(Real a, Real at_a, Real b, Real at_b, const Real& noise) {
    constexpr bool is_quad = std::is_same_v<Real, Quad>;
    using std::abs;
    const Real h = b - a, chord = (at_b - at_a) / h, step = h / 1024;
    if (!is_quad && noise > Real(1e-15) * -chord * a) return false;
    const Real first = (excess<Real>(a + step) - at_a) / step;
    const Real last = (at_b - excess<Real>(b - step)) / step;
    if (abs(first - chord) > abs(chord) / 4 || abs(last - chord) > abs(chord) / 4) return false;
    const Real enough = is_quad ? Real(1e-31) : Real(1e-18);
    int side = 0;
    Real s = b;
    for (int i = 0; i < 200; ++i) {
      s = b - at_b * (b - a) / (at_b - at_a);
      const Real at = excess<Real>(s);
      if (abs(at) < noise / 10) break;
      Real& end = at < 0 ? b : a;
      const bool is_done = abs(end - s) < enough * s;
      end = s;
      (at < 0 ? at_b : at_a) = at;
      const int now = at < 0 ? 1 : -1;
      if (side == now) (at < 0 ? at_a : at_b) /= 2;
      side = now;
      if (is_done) break;
    }
    answer_.time = s;
    answer_.contact = true;
    return true;
  }

  RodMotion<Extended> coarse_;
  RodMotion<Quad> fine_;
  Quad speed_, contact_;
  Extended size_;
  RodAnswer answer_;
};

}  // namespace

RodCase RodCase::exchanged() const {
  RodCase out = *this;
  std::swap(out.first, out.second);
  std::swap(out.pair.elapsed_first, out.pair.elapsed_second);
  std::swap(out.pair.half_first, out.pair.half_second);
  out.pair.shift = -pair.shift;
  if (pair.fall) out.pair.fall = kernels::Fall{-pair.fall->velocity, -pair.fall->place};
  return out;
}

RodAnswer first_rod_contact(const RodCase& rods) { return RodOracle(rods).run(rods); }

Quad rod_distance(const RodCase& rods, const Quad& s) { return RodMotion<Quad>(rods).distance(s); }

}  // namespace needlework::test
