#include "tests/support/oracle.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>

#include "tests/support/oracle_roots.h"

namespace needlework::test {
namespace {

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

void check(const FreeNeedle& needle) {
  for (const auto& vector :
       {needle.position, needle.orientation, needle.velocity, needle.angular_velocity}) {
    for (const double value : vector) require(std::isfinite(value), "a number that is not finite");
  }
  const auto& u = needle.orientation;
  require(u[0] != 0 || u[1] != 0 || u[2] != 0, "a director that is 0");
  require(needle.length > 0 && std::isfinite(needle.length), "a length that is not above 0");
}

struct Result {
  OracleAnswer answer;
  bool undecided;
};

template <class Real>
Result solve(const FreeNeedle& first, const FreeNeedle& second, double horizon, bool just_collided,
             KnownRoot known_root) {
  OracleSearch<Real> search(first, second, horizon, just_collided, known_root);
  OracleAnswer answer = search.run();
  return {answer, search.undecided()};
}

/// Whether doubles suffice for a pair: no square and no product of three of its numbers overflows
/// or underflows, and the parts removed from the angular velocities are not larger than these.
bool is_tame(const FreeNeedle& first, const FreeNeedle& second, double horizon) {
  const auto in_range = [](const Vec<double>& a) {
    const double most = std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
    return most == 0 || (most > 0x1p-100 && most < 0x1p100);
  };
  const auto is_normal = [](const FreeNeedle& needle) {
    const Vec<double>&u = needle.orientation, &w = needle.angular_velocity;
    const double along = dot(u, w);
    return 2 * along * along <= dot(u, u) * dot(w, w);
  };
  bool tame = horizon < 0x1p100 && in_range(first.position - second.position) &&
              in_range(first.velocity - second.velocity);
  for (const FreeNeedle* needle : {&first, &second}) {
    tame = tame && in_range(needle->orientation) && in_range(needle->angular_velocity) &&
           is_normal(*needle);
  }
  return tame;
}

OracleAnswer solve(const FreeNeedle& first, const FreeNeedle& second, double horizon,
                   bool just_collided, KnownRoot known_root, Digits digits) {
  if (digits == Digits::fewest && is_tame(first, second, horizon)) {
    const Result result = solve<double>(first, second, horizon, just_collided, known_root);
    if (!result.undecided && result.answer.decision_margin >= margin_cap) return result.answer;
  }
  if (digits != Digits::hundred) {
    Result result = solve<Quad>(first, second, horizon, just_collided, known_root);
    if (!result.undecided || digits == Digits::quad) {
      result.answer.undecidable = result.undecided;
      return result.answer;
    }
  }
  Result result = solve<Wide>(first, second, horizon, just_collided, known_root);
  result.answer.undecidable = result.undecided;
  return result.answer;
}

}  // namespace

const char* name(Outcome outcome) {
  switch (outcome) {
    case Outcome::contact:
      return "contact";
    case Outcome::spheres_apart:
      return "spheres apart";
    case Outcome::no_sign_change:
      return "no sign change";
    case Outcome::arms_outside:
      return "arms outside";
    case Outcome::parallel:
      return "parallel";
    case Outcome::coplanar:
      return "coplanar";
  }
  return "?";
}

OracleAnswer first_contact(const FreeNeedle& first, const FreeNeedle& second, double horizon,
                           bool just_collided, const OracleOptions& options) {
  check(first);
  check(second);
  require(!std::isnan(horizon) && horizon >= 0, "a horizon that is not a positive number");
  require(std::isfinite(horizon) || first.velocity != second.velocity,
          "an infinite horizon for needles that stay together");
  OracleAnswer answer =
      solve(first, second, horizon, just_collided, options.known_root, options.digits);
  if (!just_collided) return answer;

  const KnownRoot other_kind =
      options.known_root == KnownRoot::at_zero ? KnownRoot::as_rounded : KnownRoot::at_zero;
  const OracleAnswer other =
      solve(first, second, horizon, just_collided, other_kind, options.digits);
  answer.decision_margin = std::min(answer.decision_margin, other.decision_margin);
  if (answer.contact != other.contact) {
    answer.decision_margin = 0;
    answer.shift = std::numeric_limits<double>::infinity();
  } else if (answer.contact) {
    answer.shift = std::abs(answer.time - other.time + (answer.time_low - other.time_low));
    answer.time_limit += answer.shift / answer.time;
    answer.input_limit += answer.shift / answer.time;
  }
  return answer;
}

}  // namespace needlework::test
