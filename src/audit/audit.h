// The audit: checks a run, collision by collision, with physics of its own.
//
// It gets the initial state and every collision, and follows each needle from one collision to the
// next from the engine's own record, so that nothing is left to chaos. For each pair it certifies
// that between their collisions the needles meet nowhere, and at each collision that they do.
// Nothing of the engine's kernels, physics or search is used here.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "needlework/simulation.h"
#include "src/audit/encounters.h"
#include "src/audit/pair.h"
#include "src/audit/rule.h"
#include "src/audit/search.h"

namespace needlework::audit {

enum class Kind { missed, spurious, late, early, wrong_order, wrong_rule };
inline constexpr std::array kinds = {Kind::missed, Kind::spurious,    Kind::late,
                                     Kind::early,  Kind::wrong_order, Kind::wrong_rule};
const char* name(Kind kind);

/// A difference between the run and what the audit finds.
struct Difference {
  Kind kind;
  double time = 0;  ///< of the collision, or of the contact that was missed [time]
  std::uint32_t first = 0, second = 0;  ///< ids
};

/// What an audit has found so far.
struct Tally {
  std::uint64_t collisions = 0;  ///< seen; order and rule are checked for each
  std::uint64_t contacts = 0;    ///< of these, between pairs that are checked
  std::uint64_t checked = 0;     ///< flights of a pair, from a collision of either to the next
  std::uint64_t escalated = 0;   ///< of these, such that needed more digits than double has
  std::uint64_t undecided = 0;   ///< of these, such that depend on less than rounding can tell
  std::array<std::uint64_t, kinds.size()> differences{};
  std::vector<Difference> listed;  ///< the first of the differences

  std::uint64_t count(Kind kind) const { return differences[static_cast<std::size_t>(kind)]; }
  bool clean() const { return differences == std::array<std::uint64_t, kinds.size()>{}; }
  /// The share of collisions that may differ in this way, at most, with 95 % confidence: an upper
  /// Poisson limit, 3 / n when none of n does. NaN without collisions.
  double bound95(Kind kind) const;
};

/// A pair at the end of a flight in which it came to touch.
struct Touch {
  Vector<double> r;  ///< r12
  Start start;       ///< of its next flight
};

/// What an interrupted audit needs to go on.
struct Checkpoint {
  Tally tally;
  std::uint64_t fingerprint = 0;  ///< of the collisions so far
  std::unordered_map<std::uint64_t, Touch> touches;
};

struct Setup {
  double epoch_length = 1;  ///< of the collisions' times; a power of two
  Rule rule;
  std::optional<double> tc;  ///< an absolute contact time, whose use can be checked
  bool tc_relative = false;
  double share = 1;        ///< of all pairs that are checked
  std::uint64_t seed = 0;  ///< says which
};

class Audit {
 public:
  /// The state at time 0, as the engine has it, ids ascending.
  Audit(const State& initial, const Setup& setup);

  /// Takes up where another audit of the same run was interrupted: the collisions that it has
  /// seen are to be added again and are not checked again.
  void resume(Checkpoint checkpoint);
  Checkpoint checkpoint() const;

  /// The next collision. Throws InputError when an audit is resumed with collisions of another run.
  void add(const Collision& collision);
  /// The run has ended; checks the last flights, unless `stop` says so between two of them: then
  /// false, and all is as before.
  bool finish(double time, const std::function<bool()>& stop = {});

  const Tally& tally() const { return tally_; }

 private:
  using Index = std::uint32_t;  // of needles, by ascending id

  // What two needles have flown since the later of their records, seen at one encounter.
  struct Flown {
    Index first, second;  // ascending
    const Approach& approach;
    const Encounter& encounter;
    double duration;
    Start start;
  };

  Index index_of(std::uint32_t id) const;
  bool is_chosen(Index i, Index j) const;
  double since_start(const Instant& time) const;
  Instant begin_of(Index i, Index j) const;  ///< the later of both records
  Approach approach_of(Index i, Index j) const;
  void check_order(const Instant& now, const Collision& collision);
  void check_rule(Index a, Index b, const Instant& now, const Collision& collision);
  bool contact_time_is_due(Index a, Index b, const Instant& now, bool reported) const;
  void check_flight(Index i, Index j, const Instant& now);
  void check_contact(Index a, Index b, const Instant& now);
  void go_on_from_contact(Index i, Index j, const Instant& now);
  void check_apart(const Flown& flown);
  void check_touching(const Flown& flown);
  std::optional<Touch> take_touch(Index i, Index j);
  void keep_touch(const Flown& flown, const Start& start);
  void settle(const Pair& pair, bool undecided);
  double tolerance(Pair& pair, double s) const;
  void report(Kind kind, Index i, Index j, const Instant& begin, double s = 0);
  void follow(Index a, Index b, const Instant& now, const Collision& collision);

  Setup setup_;
  Space space_;
  std::vector<std::uint32_t> ids_;
  std::vector<Needle> needles_;
  std::vector<bool> has_collided_;
  std::unordered_map<std::uint64_t, Touch> touches_;
  std::optional<std::pair<Instant, std::array<std::int64_t, 5>>> last_;
  Tally tally_;
  std::uint64_t fingerprint_ = 0;
  std::optional<Checkpoint> resumed_;
  double slack_ = 0;  ///< by which the end of the run may be off [epochs]
};

}  // namespace needlework::audit
