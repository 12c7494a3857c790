// A gas that moves, collides and is renewed under the eyes of many searches at once, all of which
// must propose the contacts that first_contact finds among all images of all needles.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kernels/first_contact.h"
#include "tests/support/random.h"
#include "tests/support/renew.h"
#include "tests/support/searches.h"

namespace needlework::test {

/// `count` needles, of these lengths in turn, all of them still to be set by put().
Gas gas_of(std::size_t count, std::array<double, 3> box, const std::vector<double>& lengths = {1});
/// Gives needle i its first record, at time 0, the centre wrapped into the box.
void put(Gas& gas, Needle i, const Vec3d& r, const Vec3d& u, const Vec3d& v, const Vec3d& w);

/// Speeds of needles, drawn for each: Gaussian velocities, angular ones of the same size.
struct Speeds {
  double sigma = 1;
  double fast = 1;      ///< every fourth needle is so much faster,
  double slow = 1;      ///< the next so much slower,
  bool resting = true;  ///< and every sixteenth at rest, or does not rotate
};

/// Of a needle: linear and angular.
Velocities draw_velocities(Random& random, const Speeds& speeds);

/// `count` needles anywhere in the box.
Gas random_gas(Random& random, std::size_t count, std::array<double, 3> box, const Speeds& speeds,
               const std::vector<double>& lengths = {1});

using Candidate = std::pair<Needle, Shift>;

/// All images of all other needles whose bounding spheres overlap at this time, beyond rounding.
std::vector<Candidate> within_reach(const Gas& gas, Needle i, Time now);

/// A contact that lies ahead of a needle.
struct Ahead {
  Needle partner;
  Shift shift;
  double after;  ///< time from now; 0 for a pair that touches to within rounding
  kernels::Contact contact;
};

/// The first contacts of i with all images of all other needles, up to `span` from now. Those that
/// begin in the past, as no event has made them happen, are left out.
std::vector<Ahead> contacts_ahead(const Gas& gas, Needle i, Time now, double span);

/// Takes searches through the events that event loops would, one gas for all.
class GasDrive {
 public:
  /// `span`: how far ahead contacts are looked for. [time]
  GasDrive(Gas& gas, Random& random, std::span<const SearchChoice> choices, double span);

  /// Lets time pass: needles are placed when their times come, records renewed.
  void advance(double dt);
  /// Gives a needle new velocities, as a collision would.
  void strike(Needle i, const Velocities& velocities);
  /// Gives a needle a new record altogether.
  void set(Needle i, const Vec3d& r, const Vec3d& u, const Velocities& velocities);
  /// Lets time pass until the next contact of i, if there is one, and lets both needles rebound
  /// with this coefficient of normal restitution, as the event loop does. They are checked then.
  void bounce(Needle i, double epsilon);
  /// Stores the needles in another order.
  void shuffle();
  void look_ahead(double span) { span_ = span; }

  /// Needle i is placed and searches: each search proposes all contacts that come in time, none
  /// later than it is, and nothing twice.
  void check(Needle i);
  void check_all();
  /// Lets time pass until shortly before the next contact of i, if there is one, and checks both
  /// needles: then even the bounding volumes that last least last to the contact.
  void check_before_contact(Needle i);
  /// The plain searches propose all that comes near while no needle is placed again.
  void check_near(Needle i);

  Time now() const { return now_; }
  AnySearch& search(std::size_t n) { return *followed_[n].search; }
  const Counters& counters(std::size_t n) const { return *followed_[n].counters; }
  std::span<const SearchChoice> choices() const { return choices_; }
  /// Contacts that have had to be proposed, over all searches.
  long contacts() const { return contacts_; }
  /// Of these, pairs that touch to within rounding.
  long touches() const { return touches_; }
  long bounces() const { return bounces_; }
  long near() const { return near_; }

 private:
  struct Followed {
    std::unique_ptr<Counters> counters;
    std::unique_ptr<AnySearch> search;
    std::vector<Time> placed_until;
  };
  struct Proposal {
    Needle partner;
    Shift shift;
    double from;
  };

  /// The needle that i has just hit, if any.
  JustHit just_hit(Needle i);
  void place(Followed& followed, Needle i);
  void place_everywhere(Needle i);
  void settle_next(Needle i);
  std::optional<Ahead> next_contact(Needle i) const;
  std::vector<Proposal> proposals(Followed& followed, Needle i, double ahead);
  void expect_proposed(std::size_t n, Needle i, double ahead, std::span<const Ahead> contacts);

  Gas& gas_;
  Random& random_;
  /// For what is drawn for each search: a machine has more searches with more instruction sets, and
  /// the gas shall be the same on all.
  Random search_random_;
  std::vector<SearchChoice> choices_;
  double span_;
  std::vector<Followed> followed_;
  std::vector<Time> next_;  ///< of each needle: when it is placed again in some search, or renewed
  Time now_;
  Needle struck_[2];  ///< the pair that collided last, and when
  Shift struck_shift_{};
  double apart_ = 0;
  Time struck_at_ = Time::never();
  long contacts_ = 0, touches_ = 0, bounces_ = 0, near_ = 0;
};

}  // namespace needlework::test
