#include "tests/search/gas_drive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include "src/engine/space_order.h"
#include "src/physics/collision.h"
#include "src/search/lengths.h"
#include "tests/support/kernel_pair.h"

namespace needlework::test {

// Of shifts.
using needlework::operator-;
using needlework::operator+;

namespace {

std::array<double, 3> components(const Vec3d& a) { return {a.x, a.y, a.z}; }

Vec3d centre(const Gas& gas, Needle i, Time now) {
  const Record& record = gas.records[i];
  return centre_after(record.flight, gas.clock.difference(now, record.time));
}

// Whole numbers of boxes m for which a centre at r, drifting by `drift`, comes within `reach` of m
// boxes.
struct Images {
  std::int32_t first, last;
};
Images images(double r, double drift, double box, double reach) {
  const double low = std::min(r, r + drift) - reach, high = std::max(r, r + drift) + reach;
  return {static_cast<std::int32_t>(std::ceil(low / box)),
          static_cast<std::int32_t>(std::floor(high / box))};
}

template <class Visit>
void for_each_image(const Gas& gas, Needle i, Needle j, Time now, double span, Visit&& visit) {
  const auto r = components(centre(gas, i, now) - centre(gas, j, now));
  const auto v = components(gas.records[i].flight.v - gas.records[j].flight.v);
  Images range[3];
  for (int axis = 0; axis < 3; ++axis) {
    range[axis] = images(r[axis], v[axis] * span, gas.box.edge(axis), gas.longest * (1 + 1e-9));
  }
  for (std::int32_t x = range[0].first; x <= range[0].last; ++x) {
    for (std::int32_t y = range[1].first; y <= range[1].last; ++y) {
      for (std::int32_t z = range[2].first; z <= range[2].last; ++z) visit(Shift{x, y, z});
    }
  }
}

std::string describe(Needle i, Needle j, const Shift& shift) {
  return "needle " + std::to_string(i) + " and " + std::to_string(j) + " shifted by " +
         std::to_string(shift[0]) + " " + std::to_string(shift[1]) + " " + std::to_string(shift[2]);
}

double length_of(const Gas& gas, Needle i) { return 2 * BodyLengths{gas}.half_length(i); }

double reach_of(const Gas& gas, Needle i, Needle j) {
  return 0.5 * (length_of(gas, i) + length_of(gas, j));
}

kernels::Pair pair_in_order(const Gas& gas, Needle a, Needle b, const Shift& shift) {
  kernels::Pair pair = make_pair(gas, a, gas.records[a], b, gas.records[b], shift);
  pair.half_first = BodyLengths{gas}.half_length(a);
  pair.half_second = BodyLengths{gas}.half_length(b);
  return pair;
}

// The needle with the lower id comes first; `shift` is added to the centre of j.
kernels::Pair pair_of(const Gas& gas, Needle i, Needle j, const Shift& shift) {
  const bool in_order = gas.ids[i] < gas.ids[j];
  const Needle a = in_order ? i : j, b = in_order ? j : i;
  return pair_in_order(gas, a, b, in_order ? shift : -shift);
}

}  // namespace

Gas gas_of(std::size_t count, std::array<double, 3> box, const std::vector<double>& lengths) {
  Gas gas;
  gas.records.resize(count);
  gas.ids.resize(count);
  for (Needle i{0}; i < count; ++i) {
    gas.ids[i] = Id{i.index};
    gas.records[i].species = static_cast<SpeciesIndex>(i % lengths.size());
  }
  std::vector<Species> species;
  species.reserve(lengths.size());
  for (const double length : lengths) species.push_back({.length = length});
  gas.set_composition(Composition(species, {}));
  gas.images.resize(count);
  gas.box = box;
  return gas;
}

void put(Gas& gas, Needle i, const Vec3d& r, const Vec3d& u, const Vec3d& v, const Vec3d& w) {
  gas.records[i].flight.r = r;
  gas.records[i].flight.v = {};
  renew_in_flight(gas, i, gas.records[i].time, u, {v, w});
}

Velocities draw_velocities(Random& random, const Speeds& speeds) {
  const int kind = random.below(16);
  double sigma = speeds.sigma;
  if (kind % 4 == 0) sigma *= speeds.fast;
  if (kind % 4 == 1) sigma *= speeds.slow;
  Velocities out{vec3(random.normal_vector(sigma)), vec3(random.normal_vector(3 * sigma))};
  if (speeds.resting && kind == 2) out = {};
  if (speeds.resting && kind == 3) out.w = {};
  return out;
}

Gas random_gas(Random& random, std::size_t count, std::array<double, 3> box, const Speeds& speeds,
               const std::vector<double>& lengths) {
  Gas gas = gas_of(count, box, lengths);
  gas.clock = Clock(gas.longest / std::max(speeds.sigma, speeds.sigma * speeds.fast));
  for (Needle i{0}; i < count; ++i) {
    const Velocities velocities = draw_velocities(random, speeds);
    put(gas, i,
        {random.uniform(-0.2, 1.2) * box[0], random.uniform() * box[1], random.uniform() * box[2]},
        vec3(random.direction()), velocities.v, velocities.w);
  }
  return gas;
}

std::vector<Candidate> within_reach(const Gas& gas, Needle i, Time now) {
  std::vector<Candidate> out;
  const Vec3d mine = centre(gas, i, now);
  for (Needle j{0}; j < gas.size(); ++j) {
    if (j == i) continue;
    const Vec3d r = mine - centre(gas, j, now);
    for_each_image(gas, i, j, now, 0, [&](const Shift& shift) {
      const Vec3d image{shift[0] * gas.box.edge(0), shift[1] * gas.box.edge(1),
                        shift[2] * gas.box.edge(2)};
      const double reach = reach_of(gas, i, j);
      if (dot(r - image, r - image) < reach * reach * (1 - 1e-12)) out.push_back({j, shift});
    });
  }
  return out;
}

std::vector<Ahead> contacts_ahead(const Gas& gas, Needle i, Time now, double span) {
  std::vector<Ahead> out;
  kernels::EvaluationCounters work;
  for (Needle j{0}; j < gas.size(); ++j) {
    if (j == i) continue;
    const Time start = Gas::start_of(gas.records[i], gas.records[j]);
    const double since = gas.clock.difference(now, start);
    for_each_image(gas, i, j, now, span, [&](const Shift& shift) {
      const kernels::Contact contact =
          first_contact(pair_of(gas, i, j, shift), since, since + span, work);
      const double after = contact.elapsed.hi - since;
      if (contact.found && after > 0) out.push_back({j, shift, after, contact});
      // The engine settles these by the records before, as soon as it sees them.
      if (contact.side_unknown) out.push_back({j, shift, 0, contact});
    });
  }
  return out;
}

GasDrive::GasDrive(Gas& gas, Random& random, std::span<const SearchChoice> choices, double span)
    : gas_(gas),
      random_(random),
      search_random_(random.bits()),
      choices_(choices.begin(), choices.end()),
      span_(span),
      next_(gas.size()) {
  for (const SearchChoice& choice : choices) {
    Followed& followed = followed_.emplace_back();
    followed.counters = std::make_unique<Counters>();
    followed.search = make_search(choice, gas, *followed.counters);
    followed.placed_until.resize(gas.size());
    for (Needle i{0}; i < gas.size(); ++i) place(followed, i);
  }
  for (Needle i{0}; i < gas.size(); ++i) settle_next(i);
}

void GasDrive::place(Followed& followed, Needle i) {
  Time& until = followed.placed_until[i];
  until = followed.search->place(i, now_);
  // As if a contact came before.
  if (search_random_.below(4) == 0) {
    const double left = std::min(gas_.clock.difference(until, now_), span_);
    until = gas_.clock.add(now_, search_random_.uniform() * left);
    followed.search->set_next_event(i, until);
  }
}

void GasDrive::place_everywhere(Needle i) {
  for (Followed& followed : followed_) place(followed, i);
  settle_next(i);
}

void GasDrive::settle_next(Needle i) {
  next_[i] = gas_.records[i].renewal;
  for (const Followed& followed : followed_) {
    next_[i] = std::min(next_[i], followed.placed_until[i]);
  }
}

void GasDrive::advance(double dt) {
  const Time end = gas_.clock.add(now_, dt);
  Time instant;
  std::size_t at_instant = 0;
  for (;;) {
    const auto it = std::min_element(next_.begin(), next_.end());
    if (it == next_.end() || *it > end) break;
    const auto i = static_cast<Needle>(it - next_.begin());
    ASSERT_GE(*it, now_);
    now_ = *it;
    at_instant = now_ == instant ? at_instant + 1 : 0;
    instant = now_;
    ASSERT_LT(at_instant, 4 * gas_.size() * followed_.size()) << "time stands still";
    const Record& record = gas_.records[i];
    if (record.renewal <= now_) {
      strike(i, {record.flight.v, record.flight.w});
      continue;
    }
    for (Followed& followed : followed_) {
      if (followed.placed_until[i] <= now_) place(followed, i);
    }
    settle_next(i);
  }
  now_ = end;
}

void GasDrive::strike(Needle i, const Velocities& velocities) {
  const Record& record = gas_.records[i];
  const Vec3d u = director_after(record.flight, gas_.clock.difference(now_, record.time));
  renew_in_flight(gas_, i, now_, u, velocities);
  struck_at_ = Time::never();
  place_everywhere(i);
}

void GasDrive::set(Needle i, const Vec3d& r, const Vec3d& u, const Velocities& velocities) {
  gas_.records[i].time = now_;
  put(gas_, i, r, u, velocities.v, velocities.w);
  struck_at_ = Time::never();
  place_everywhere(i);
}

JustHit GasDrive::just_hit(Needle i) {
  // Of an image that is not near, whatever is said changes nothing.
  if (search_random_.below(16) == 0) {
    return {Needle(search_random_.below(static_cast<int>(gas_.size()))), Shift{99, 0, 0},
            std::numeric_limits<double>::infinity()};
  }
  if (now_ != struck_at_) return {};
  if (i == struck_[0]) return {struck_[1], struck_shift_, apart_};
  if (i == struck_[1]) return {struck_[0], -struck_shift_, apart_};
  return {};
}

std::vector<GasDrive::Proposal> GasDrive::proposals(Followed& followed, Needle i, double ahead) {
  std::vector<Proposal> out;
  followed.search->find({i, just_hit(i), now_, ahead},
                        [&](Needle j, const Shift& shift, double from) {
                          out.push_back({j, shift, from});
                          return ahead;
                        });
  return out;
}

void GasDrive::expect_proposed(std::size_t n, Needle i, double ahead,
                               std::span<const Ahead> contacts) {
  Followed& followed = followed_[n];
  std::map<Candidate, Proposal> proposed;
  for (const Proposal& proposal : proposals(followed, i, ahead)) {
    ASSERT_NE(proposal.partner, i);
    ASSERT_TRUE(proposed.try_emplace({proposal.partner, proposal.shift}, proposal).second)
        << describe(i, proposal.partner, proposal.shift) << " proposed twice";
  }
  double earliest = ahead;
  std::map<Candidate, double> known;
  for (const Ahead& contact : contacts) {
    const Needle j = contact.partner;
    known[{j, contact.shift}] = contact.after;
    const Time placed = std::min(followed.placed_until[j], gas_.records[j].renewal);
    if (!(contact.after < std::min(ahead, gas_.clock.difference(placed, now_)))) continue;
    ++contacts_;
    touches_ += contact.after == 0;
    earliest = std::min(earliest, contact.after);
    const auto it = proposed.find({j, contact.shift});
    ASSERT_NE(it, proposed.end()) << describe(i, j, contact.shift) << " not proposed; meet after "
                                  << contact.after << " of " << ahead;
    ASSERT_LE(it->second.from, contact.after) << describe(i, j, contact.shift) << " of " << ahead;
  }
  // An event loop wants the earliest and shortens the time ahead by what it finds.
  double shortened = ahead;
  followed.search->find({i, just_hit(i), now_, ahead},
                        [&](Needle j, const Shift& shift, double from) {
                          EXPECT_LE(from, shortened);
                          const auto it = known.find({j, shift});
                          if (it != known.end()) shortened = std::min(shortened, it->second);
                          return shortened;
                        });
  ASSERT_LE(shortened, earliest) << "needle " << i << " lacks its earliest contact";
}

void GasDrive::check(Needle i) {
  place_everywhere(i);
  const Time end = std::min(gas_.records[i].renewal, gas_.clock.add(now_, span_));
  std::vector<double> ahead;
  for (const Followed& followed : followed_) {
    ahead.push_back(gas_.clock.difference(std::min(end, followed.placed_until[i]), now_));
    // Searches may also be cut short.
    if (search_random_.below(4) == 0) ahead.back() *= search_random_.uniform();
  }
  const double longest = ahead.empty() ? 0 : *std::max_element(ahead.begin(), ahead.end());
  const std::vector<Ahead> contacts = contacts_ahead(gas_, i, now_, longest);
  for (std::size_t n = 0; n < followed_.size(); ++n) {
    ASSERT_NO_FATAL_FAILURE(expect_proposed(n, i, ahead[n], contacts))
        << choices_[n].name() << " at time " << gas_.clock.since_start(now_);
  }
}

void GasDrive::check_all() {
  for (Needle i{0}; i < gas_.size(); ++i) ASSERT_NO_FATAL_FAILURE(check(i));
}

std::optional<Ahead> GasDrive::next_contact(Needle i) const {
  const auto contacts = contacts_ahead(gas_, i, now_, span_);
  const auto next = std::min_element(contacts.begin(), contacts.end(),
                                     [](auto& a, auto& b) { return a.after < b.after; });
  return next == contacts.end() ? std::nullopt : std::optional(*next);
}

void GasDrive::check_before_contact(Needle i) {
  const auto next = next_contact(i);
  if (!next) return;
  ASSERT_NO_FATAL_FAILURE(advance(next->after * (1 - random_.log_uniform(1e-9, 1))));
  ASSERT_NO_FATAL_FAILURE(check(i));
  ASSERT_NO_FATAL_FAILURE(check(next->partner));
}

void GasDrive::bounce(Needle i, double epsilon) {
  auto next = next_contact(i);
  if (!next || next->after == 0) return;
  // A little before, so that renewals on the way are past.
  ASSERT_NO_FATAL_FAILURE(advance(next->after * 0.999));
  next = next_contact(i);
  if (!next || next->after == 0) return;
  const bool is_first = gas_.ids[i] < gas_.ids[next->partner];
  const Needle a = is_first ? i : next->partner, b = is_first ? next->partner : i;
  const Shift shift = is_first ? next->shift : -next->shift;
  const Record &first = gas_.records[a], &second = gas_.records[b];
  const Time start = Gas::start_of(first, second);
  const Time then = gas_.clock.add(start, next->contact.elapsed.hi);
  ASSERT_NO_FATAL_FAILURE(advance(gas_.clock.difference(then, now_)));
  if (Gas::start_of(first, second) != start) return;  // renewed on the way
  now_ = then;
  const kernels::ContactGeometry at =
      contact_geometry(pair_in_order(gas_, a, b, shift), gas_.clock.exact_difference(now_, start));
  const Impact impact =
      collide<Surface::smooth>({first.flight.v, first.flight.w, second.flight.v, second.flight.w,
                                gas_.body(a), gas_.body(b), at, next->contact.side},
                               {.epsilon = epsilon, .beta = -1});
  const Shift wraps_a =
      renew_in_flight(gas_, a, now_, at.u_first, {impact.v_first, impact.w_first});
  const Shift wraps_b =
      renew_in_flight(gas_, b, now_, at.u_second, {impact.v_second, impact.w_second});
  const Shift wrapped = shift + wraps_b - wraps_a;
  const kernels::Touch touch{
      .touching = true, .collided = true, .side = next->contact.side, .gap = 0};
  gas_.add_touch(a, RecordedTouch::of(gas_.ids[b], gas_.records[b].serial, wrapped, touch));
  gas_.add_touch(b, RecordedTouch::of(gas_.ids[a], gas_.records[a].serial, -wrapped, touch));
  ++bounces_;
  struck_[0] = a;
  struck_[1] = b;
  struck_shift_ = wrapped;
  apart_ = kernels::time_apart(pair_in_order(gas_, a, b, wrapped));
  struck_at_ = now_;
  place_everywhere(a);
  place_everywhere(b);
  ASSERT_NO_FATAL_FAILURE(check(a));
  ASSERT_NO_FATAL_FAILURE(check(b));
}

void GasDrive::shuffle() {
  std::vector<Needle> order(gas_.size());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = Needle(n);
  for (std::size_t n = order.size(); n > 1; --n) {
    std::swap(order[n - 1], order[random_.below(static_cast<int>(n))]);
  }
  const std::vector<Needle> ranks = ranks_of(order);
  reorder(gas_, order);
  struck_at_ = Time::never();
  for (Followed& followed : followed_) {
    followed.search->renumber(ranks);
    permute(followed.placed_until, order);
  }
  permute(next_, order);
}

void GasDrive::check_near(Needle i) {
  place_everywhere(i);
  for (std::size_t n = 0; n < followed_.size(); ++n) {
    if (choices_[n].uses_simd()) continue;
    Followed& followed = followed_[n];
    Time until = gas_.clock.add(now_, span_);
    for (const Time placed : followed.placed_until) until = std::min(until, placed);
    const double ahead = gas_.clock.difference(until, now_);
    std::set<Candidate> proposed;
    for (const Proposal& p : proposals(followed, i, ahead)) proposed.insert({p.partner, p.shift});
    const Time between = std::min(until, gas_.clock.add(now_, search_random_.uniform() * ahead));
    for (const Time t : {now_, between, until}) {
      for (const Candidate& candidate : within_reach(gas_, i, t)) {
        ++near_;
        ASSERT_TRUE(proposed.contains(candidate))
            << choices_[n].name() << ": " << describe(i, candidate.first, candidate.second)
            << " not proposed, near after " << gas_.clock.difference(t, now_) << " of " << ahead;
      }
    }
  }
}

}  // namespace needlework::test
