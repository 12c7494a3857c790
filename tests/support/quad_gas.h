// Follows a few needles in infinite space from collision to collision in quad precision, and two
// that slide along each other. Shares no code with the engine: contacts are roots of power series.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "needlework/simulation.h"
#include "tests/support/contact_state.h"

namespace needlework::test {

struct QuadRule {
  double k = 6, epsilon = 1, beta = -1;
  double tc = 0;  ///< contact time; 0: none
  /// Whether the state after a collision is rounded to doubles, as in any engine in double. The
  /// contact functions continue from their values before rounding.
  bool rounded = false;
};

struct QuadCollision {
  Real time;
  std::size_t first, second;  ///< ascending
  std::array<Real, 2> arms;   ///< s12, s21
  Real normal_velocity;       ///< V_n before
  bool contact_time_rule;     ///< done with epsilon = 1, beta = -1
};

/// The end of a sliding contact.
struct QuadSlide {
  Real time;
  bool over_a_tip;  ///< otherwise the needles have separated
  PairState end;
  Real gap, normal_velocity;  ///< exactly 0 in theory; errors of the integration
};

class QuadGas {
 public:
  /// Starts from the state of a run. There are no periodic images, so the needles must stay in the
  /// box.
  QuadGas(const State& state, const QuadRule& rule);

  /// Moves to the next contact up to `until` and processes the collision, or moves to `until` if
  /// there is none.
  std::optional<QuadCollision> collide(const Real& until);

  const Real& time() const { return time_; }
  Real energy() const;
  const std::vector<NeedleState>& needles() const { return needles_; }

  /// Follows needles 0 and 1, which have just collided and separate by almost nothing, while their
  /// contact points stay together: without friction, held by a force along the normal until it
  /// would have to pull. `steps` per unit of time.
  QuadSlide slide(int steps) const;

 private:
  struct Contact {
    Real after;
    std::size_t i, j;
  };
  std::optional<Contact> next_contact(const Real& within) const;
  Real gap(std::size_t i, std::size_t j) const;
  QuadCollision strike(std::size_t i, std::size_t j);

  QuadRule rule_;
  std::vector<NeedleState> needles_;
  Real time_ = 0;
  std::vector<std::optional<Real>> last_collision_;
  using IndexPair = std::pair<std::size_t, std::size_t>;  // ascending
  /// The two that are at a contact now, if any: f = 0.
  std::optional<IndexPair> touching_;
  std::map<IndexPair, Real> offsets_;  ///< added to f to correct for rounding
};

/// s12 and s21 of the lines' nearest points.
std::array<Real, 2> arms(const PairState& pair);
/// Velocity of the first contact point relative to the second, along the normal.
Real normal_velocity(const PairState& pair);

}  // namespace needlework::test
