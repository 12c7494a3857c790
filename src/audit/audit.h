// The audit: checks every collision of a run with an independent implementation of the physics.
//
// It receives the initial state and every collision, and follows each needle from one collision to
// the next. Each flight starts from the engine's own record, so that differences cannot grow by
// chaos. For each pair it certifies that the needles do not touch between their collisions, and
// that they touch at each collision. It uses nothing of the engine's kernels, physics or search.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "needlework/composition.h"
#include "needlework/simulation.h"
#include "src/audit/contact_finder.h"
#include "src/audit/cooling.h"
#include "src/audit/encounters.h"
#include "src/audit/guided_flight.h"
#include "src/audit/joint_motion.h"
#include "src/audit/kicks.h"
#include "src/audit/pair_flight.h"
#include "src/audit/rod_flight.h"
#include "src/audit/rule.h"
#include "src/audit/walls.h"
#include "src/audit/windows.h"

namespace needlework::audit {

enum class Kind { missed, spurious, late, early, wrong_order, wrong_rule, wrong_start, wrong_end };
inline constexpr std::array kinds = {Kind::missed,      Kind::spurious,    Kind::late,
                                     Kind::early,       Kind::wrong_order, Kind::wrong_rule,
                                     Kind::wrong_start, Kind::wrong_end};
const char* name(Kind kind);
/// Whether it is about collisions, or otherwise about the run as a whole.
constexpr bool is_of_collisions(Kind kind) {
  return kind != Kind::wrong_start && kind != Kind::wrong_end;
}
/// The greatest number of differences that are listed.
inline constexpr std::size_t most_listed = 100;

/// A difference between the run and the result of the audit.
struct Difference {
  Kind kind;
  double time = 0;  ///< of the collision, or of the contact that was missed [time]
  std::uint32_t first = 0, second = 0;  ///< ids of the needles, if it is of collisions
  bool at_wall = false;                 ///< whether `second` is the index of a wall
};

/// By how much rods of finite width overlap, as a share of the distance of the axes of two at a
/// contact.
struct RodOverlaps {
  double at_collisions = 0;  ///< the largest one found at a collision, before or after it
  double at_most = 0;        ///< certified: none is larger, at any time, but for what is reported
};

/// The results of an audit so far.
struct Findings {
  std::uint64_t collisions = 0;  ///< collisions received; order and rule are checked for each
  std::uint64_t hits = 0;        ///< hits on walls received; the same
  std::uint64_t draws = 0;       ///< events of a thermostat received; their rule is not checked
  std::uint64_t kicks = 0;       ///< of all needles; the rule is checked for each needle
  std::uint64_t coolings = 0;    ///< of bodies that grow; the same
  std::uint64_t entered = 0;     ///< collisions that began a sliding contact
  std::uint64_t ended = 0;       ///< ends of sliding contacts received
  std::uint64_t at_walls = 0;    ///< flights of a needle that are checked against all walls
  std::uint64_t contacts = 0;    ///< collisions between pairs that are checked
  std::uint64_t checked = 0;     ///< flights of a pair, from a collision of either needle to the
                                 ///< next
  std::uint64_t escalated = 0;   ///< flights that needed more digits than double has
  std::uint64_t undecided = 0;   ///< flights whose result depends on less than rounding errors
  std::optional<RodOverlaps> overlaps;  ///< of rods of finite width
  std::array<std::uint64_t, kinds.size()> differences{};
  std::vector<Difference> listed;  ///< the first differences

  std::uint64_t events() const { return collisions + hits + draws + kicks + coolings + ended; }
  std::uint64_t count(Kind kind) const { return differences[static_cast<std::size_t>(kind)]; }
  bool clean() const { return differences == std::array<std::uint64_t, kinds.size()>{}; }
  /// Upper limit, with 95 % confidence, on the fraction of collisions and hits that differ in this
  /// way: a Poisson limit, 3 / n if none of n does. NaN without collisions, and if it is not of
  /// them.
  double bound95(Kind kind) const;
};

/// What the next flight of a pair continues from, if it touches at the end of a flight.
struct Continuation {
  Vector<double> r;  ///< r12
  Start start;       ///< how its next flight starts
};

/// The data from which an interrupted audit continues.
struct Checkpoint {
  Findings findings;
  std::uint64_t fingerprint = 0;  ///< hash of the collisions so far
  std::unordered_map<std::uint64_t, Continuation> continuations;
};

/// How needles that bounce ever faster stay in contact.
struct Sliding {
  double below = 1e-3;           ///< in flights shorter than this, in present mean free times
  bool elastic_strikes = false;  ///< whether strikes are done with epsilon = 1
};

/// Of a scene; empty if needles do not slide.
inline std::optional<Sliding> sliding_of(const Scene& scene) {
  const Scene::Collisions& collisions = scene.collisions;
  if (!collisions.sliding) return std::nullopt;
  return Sliding{collisions.sliding_below, collisions.elastic_strikes};
}

struct Setup {
  double epoch_length = 1;            ///< unit of the collisions' times, a power of two
  Composition composition;            ///< with the counts of the state
  std::optional<double> tc;           ///< absolute contact time
  std::optional<double> tc_relative;  ///< the same in present mean free times
  std::optional<Sliding> sliding;
  std::vector<Scene::Wall> walls = {};
  std::array<double, 3> gravity{};  ///< [L / time^2]
  std::optional<Scene::Shear> shear = {};
  Scene::Driving driving = {};
  std::uint64_t scene_seed = 1;  ///< of the random numbers of kicks
  double share = 1;              ///< fraction of all pairs that are checked
  std::uint64_t seed = 0;        ///< selects these pairs
};

class Audit {
 public:
  /// `initial` is the state at time 0 as the engine has it, in order of id.
  Audit(const State& initial, const Setup& setup);

  /// Continues an interrupted audit of the same run. The collisions that it has seen must be added
  /// again, and are not checked again.
  void resume(Checkpoint checkpoint);
  Checkpoint checkpoint() const;

  /// Checks that the state at time 0 is that of the scene: `given`, if it was read from a file, or
  /// otherwise one of its temperatures and without momentum. To be called before the first
  /// collision is added.
  void check_start(const Scene& scene, const State* given);

  /// Adds the next collision. Throws InputError if an audit is continued with collisions of
  /// another run.
  void add(const Collision& collision) { add(Happening{Happening::pair, 0, collision}); }
  /// The same for all that happens. Of a thermostat it is checked that the needle goes on from
  /// where it was, not which velocities it gets. Throws InputError for events of other kinds.
  void add(const Happening& happening);
  /// Adds a kick of all needles, or that the velocities of bodies that grow have been scaled back:
  /// `after` is the state at this time [time], in order of id, with which the engine goes on,
  /// before anything else happens. Checks the flights of all needles and pairs until then.
  void add_kick(const State& after, double time);
  /// Ends the run and checks the last flights. If `stop` returns true between two flights, returns
  /// false and restores the previous state.
  bool finish(double time, const std::function<bool()>& stop = {});

  /// Checks that the run ended for this reason where its conditions say, and not later. To be
  /// called after finish(), for a run that was neither interrupted nor ended by wall time.
  void check_end(const Scene::Until& until, Stop reason, double time);

  const Findings& findings() const { return findings_; }

 private:
  using Index = std::uint32_t;  // of needles, in order of id

  // A contact of two needles that slide on each other.
  struct Joint {
    Index first, second;  // in ascending order
    Instant begin;
    JointMotion motion;
    Index other(Index i) const { return i == first ? second : first; }
    int index(Index i) const { return i == first ? 0 : 1; }
  };
  // A contact of which one needle has been struck: at the same instant the two collide or part, or
  // they stay in contact.
  struct Cut {
    std::shared_ptr<Joint> joint;
    Instant time;
  };
  // When a needle has touched others.
  struct LastTouches {
    static constexpr Index wall = ~Index{0};   // in place of a partner
    std::optional<Index> last;                 // the latest partner
    std::optional<Instant> with_last, others;  // the latest times with it, and with any other
    int in_crowd = 0;                          // collisions soon after one with a third, in a row

    void note(Index partner, const Instant& now) {
      if (last != partner) others = with_last;
      last = partner;
      with_last = now;
    }
  };
  enum class Answer { no, yes, open };
  // What a collision of needles that may slide should have been.
  struct Judgement {
    double excess = 0;     // over the rule
    bool crowded = false;  // soon after a collision of one of the two with a third
  };

  // The motion of two needles since the later of their records, for one encounter.
  struct Flown {
    Index first, second;  // in ascending order
    const Approach& approach;
    const Encounter& encounter;
    double duration;
    Start start;
  };

  void let_grow(const Scene::Growth& growth);
  std::vector<Needle> replaced(const State& after, const Instant& now) const;
  Index index_of(std::uint32_t id) const;
  /// The same for both orders.
  static std::uint64_t key_of(Index i, Index j) {
    return std::uint64_t{i < j ? i : j} << 32 | (i < j ? j : i);
  }
  bool meet(Index i, Index j) const;  ///< or they pass through each other
  /// Whether two touch where their axes are some distance apart, and not as two thin needles.
  bool have_width(Index i, Index j) const {
    return needles_[i].body.diameter + needles_[j].body.diameter > 0;
  }
  bool is_chosen(Index i, Index j) const;
  double since_start(const Instant& time) const;
  Instant begin_of(Index i, Index j) const;  ///< the later of the times of both records
  /// For a flight that lasts so long.
  Approach approach_of(Index i, Index j, double duration) const;
  Needle image_of(Index second, const Shift& shift, Index first) const;
  /// With velocities beside the flow of a sheared gas.
  std::vector<Needle> beside_flow(std::vector<Needle> needles, const Instant& now) const;
  double reach_of_pair(Index i, Index j, const Instant& now) const;
  Shift nearest_image(const Approach& approach, double s) const;  ///< at this time of a flight
  void check_order(const Instant& now, const Happening& happening);
  void check_pair(const Instant& now, const Collision& collision,
                  const std::optional<Judgement>& judgement);
  void check_kick(const Instant& now, const std::vector<Needle>& after);
  void check_cooling(const Instant& now, const std::vector<Needle>& after);
  void check_replaced(const Instant& now, const std::function<double(Index)>& excess);
  void go_on_if_resumed();
  void note_in_fingerprint(std::uint64_t word);
  void advance_windows(const Instant& now);
  void check_single(const Instant& now, const Happening& happening);
  void check_hit(Index i, const Instant& now, const Collision& hit);
  void check_walls(Index i, const Instant& now, const Collision* hit);
  void check_partners(Index mine, Index besides, const Instant& now);
  void check_rule(Index a, Index b, const Instant& now, const Collision& collision,
                  const std::optional<Judgement>& judgement);
  const Joint* joint_of(Index i, Index j) const;
  Approach chord_of(Index i, Index j, const Instant& begin, double duration) const;
  /// How it moves from so long after its record on.
  Guide guide_of(Index i, double delay) const;
  Needle present(Index i, const Instant& now) const;
  std::vector<Needle> present(const Instant& now) const;
  Vector<double> nearest_separation(const Needle& a, const Needle& b) const;
  Judgement judge(Index a, Index b, const Instant& now, const Happening& happening) const;
  Answer is_crowded(Index a, Index b, const Instant& now) const;
  bool is_strike(Index a, Index b, const Instant& now) const;
  Answer may_enter(const RelativeState& before, const std::array<AuditedBody, 2>& bodies, int side,
                   double epsilon) const;
  std::optional<double> threshold() const;
  void note_meeting(Index a, Index b, const Instant& now, bool crowded);
  void settle_cuts(const Instant& now, bool at_end = false);
  void check_owed(const Instant& now, const Happening* happening);
  void go_on_sliding(const Cut& cut);
  void check_held(Index i, const Instant& now);
  void check_contact_end(const Instant& now, const Collision& event);
  void check_end_time(const Joint& joint, const Instant& now);
  void part_all(const Instant& now);
  void follow_contact_end(const Instant& now, const Collision& event);
  void cut_contact(Index i, const Instant& now);
  void enter_contact(const Instant& now, const Collision& event);
  double excess_over_contact(const Joint& joint, const Instant& now, const Collision& event) const;
  int side_after_end(Joint& joint, const Instant& now) const;
  bool follows_windows() const;
  bool hit_is_elastic(Index i, const Instant& now, bool reported) const;
  bool contact_time_is_due(Index a, Index b, const Instant& now, bool reported) const;
  void check_flight(Index i, Index j, const Instant& now);
  void check_contact(Index a, Index b, const Instant& now);
  void go_on_from_contact(Index i, Index j, const Instant& now);
  /// Calls check(motion) with the motion of both.
  template <class Check>
  void with_motion(const Flown& flown, const Check& check) const;
  void check_apart(const Flown& flown);
  void check_apart(const Flown& flown, PairMotion& pair);
  void check_touching(const Flown& flown);
  void check_touching(const Flown& flown, PairMotion& pair);
  std::optional<Continuation> take_continuation(Index i, Index j);
  void keep_continuation(const Flown& flown, const Start& start);
  void settle(const PairMotion& pair, bool undecided);
  void check_rods_apart(const Flown& flown);
  void check_rods_touching(const Flown& flown);
  double after_overlap(const Flown& flown, RodFlight& pair) const;
  void keep_if_overlapping(const Flown& flown, RodFlight& pair);
  void measure_overlap(Index a, Index b);
  void settle(const RodFlight& pair);
  double tolerance(PairMotion& pair, double s) const;
  /// How far rounding may move a tip into a wall. [L]
  double tip_tolerance(const Needle& needle) const {
    return space_.continued() + 0x1p-50 * needle.worn * needle.body.length;
  }
  void report(Kind kind, Index i, Index j, const Instant& begin, double s = 0);
  void report(Kind kind);
  bool is_proper(const Needle& needle) const;
  bool is_as_given(const Needle& needle, const State& given, std::size_t i) const;
  bool is_at_rest() const;
  bool is_inside(const Needle& needle) const;
  void report_at_wall(Kind kind, Index i, std::size_t wall, const Instant& begin, double s);
  void follow(const Instant& now, const Happening& happening,
              const std::optional<Judgement>& judgement);
  double energy() const;
  double packing_fraction() const;
  bool has_no_room(double scale) const;
  bool is_at_pressure(double pressure) const;

  Setup setup_;
  double unit_;                      ///< of lengths: a power of two that no needle is longer than
  std::vector<AuditedBody> bodies_;  ///< by species
  Space space_;
  std::vector<std::uint32_t> ids_;
  std::vector<Needle> needles_;
  std::vector<Wall> walls_;
  std::optional<Kicks> kicks_;
  std::optional<Cooling> cooling_;
  std::vector<bool> has_collided_;  ///< or hit a wall
  std::vector<Instant> met_;        ///< when a needle last did, ends of contacts apart
  Windows windows_;
  double initial_energy_;          ///< of all needles, in the units of the audit
  double last_energy_change_ = 0;  ///< in the last collision
  std::unordered_map<std::uint64_t, Continuation> continuations_;
  std::optional<std::pair<Instant, std::array<std::int64_t, 6>>> last_;
  Findings findings_;
  std::uint64_t fingerprint_ = 0;
  std::optional<Checkpoint> resumed_;
  std::vector<std::shared_ptr<Joint>> joints_;  ///< of each needle; null if it flies freely
  std::vector<Cut> cuts_;
  std::vector<LastTouches> last_touches_;
  std::optional<std::pair<Index, Index>> owed_;  ///< that must collide now, as a contact is cut
  double slack_ = 0;  ///< uncertainty of the end time of the run [epochs]
};

}  // namespace needlework::audit
