#include "src/audit/kicks.h"

#include <Random123/philox.h>

#include <algorithm>
#include <cmath>

#include "src/audit/there.h"

namespace needlework::audit {
namespace {

constexpr double half_unit_of_kicks = 0x1p-53;

// Standard normal numbers of one needle and kick, by the definition in docs/physics.md: the words
// of Philox-4x64-10 one after the other, each the upper 53 bits of a number in [0, 1); two of them
// a point in a square, until it is within the circle; from this, by Marsaglia's polar method, two
// normal numbers.
class Normals {
 public:
  Normals(std::uint64_t seed, std::uint64_t id, std::uint64_t kick)
      : key_{{seed, 0}}, counter_{{0, id, kick, kicks}} {}

  struct Three {
    Vector<Quad> numbers;
    double off;  ///< by how much each is off as the engine rounds squared distances
  };
  /// Of two pairs, the first three.
  Three vector() {
    const Pair first = pair(), second = pair();
    return {{{first.x, first.y, second.x}}, std::max(first.off, second.off)};
  }

 private:
  static constexpr std::uint64_t kicks = 3;  // what the numbers are for

  struct Pair {
    Quad x, y;
    double off;
  };

  double uniform() {
    if (used_ == 4) {
      words_ = r123::Philox4x64()(counter_, key_);
      ++counter_[0];
      used_ = 0;
    }
    return std::ldexp(static_cast<double>(words_[used_++] >> 11), -53);
  }
  Pair pair() {
    for (;;) {
      const Quad x = 2 * uniform() - 1, y = 2 * uniform() - 1;  // without rounding
      const Quad squared = x * x + y * y;
      if (!(squared > 0 && squared < 1)) continue;
      using std::log, std::sqrt;
      const Quad minus_log = -log(squared), scale = sqrt(Quad(2 * minus_log / squared));
      // Rounding makes squares off by two half units, of which the logarithm, which is near 0 next
      // to the circle, takes its share over itself, and the root half of that.
      return {x * scale, y * scale, half_unit_of_kicks * magnitude(Quad(scale / minus_log))};
    }
  }

  r123::Philox4x64::key_type key_;
  r123::Philox4x64::ctr_type counter_, words_{};
  std::size_t used_ = 4;
};

}  // namespace

Kicks::Kicks(const Scene::Kicks& kicks, std::uint64_t seed, double epoch_length, double unit)
    : seed_(seed) {
  using std::sqrt;
  const Quad root = sqrt(Quad(kicks.every));
  translational_ = root * kicks.translational * epoch_length / unit;
  rotational_ = root * kicks.rotational * epoch_length;
}

Kicks::Change Kicks::of(std::uint32_t id, std::uint64_t kick) const {
  Normals normals(seed_, id, kick);
  const Normals::Three v = normals.vector(), w = normals.vector();
  return {v.numbers * translational_, w.numbers * rotational_, v.off * magnitude(translational_),
          w.off * magnitude(rotational_)};
}

double excess_over_kick(const Needle& before, const Vector<double>& gravity, const Record& after,
                        const Kicks::Change& change, const Kicks::Change& of_all, double largest,
                        const Space& space) {
  const There there(before, gravity, after.time);
  Excess excess;
  add_place(excess, there, after.r, after.u, space);
  // Directors are off by half units, which grow with the angle turned; changes by what logarithm
  // and roots round.
  const double off =
      16 * half_unit_of_kicks * (2 + there.turned + there.flown / before.body.extent());
  const double speed = magnitude(norm(there.v)) + largest;
  const double spin = magnitude(norm(there.w)) + magnitude(norm(change.w));
  const Vector<Quad> v = there.v + change.v - of_all.v;
  // Spheres turn about any axis, smooth ones do not turn.
  const bool has_axis = before.body.has_axis(), turns = has_axis || before.body.q > 0;
  const Vector<Quad> turn = change.w * Quad(turns ? 1 : 0);
  const Vector<Quad> w = has_axis ? there.w + turn - there.u * dot(there.u, turn) : there.w + turn;
  for (int axis = 0; axis < 3; ++axis) {
    excess.add(v[axis] - Quad(after.v[axis]), off * speed + change.v_off + of_all.v_off);
    excess.add(w[axis] - Quad(after.w[axis]), off * spin + 2 * change.w_off);
  }
  return excess.most();
}

}  // namespace needlework::audit
