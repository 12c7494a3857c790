// Measures calendars by themselves: the time for each event that is taken out and replaced.
//
// hold, the classical test of priority queues (Jones 1986): replaces the earliest event, and the
// event of one other needle, chosen at random. mix: follows the engine. In every other event (48 %
// of them in a dilute gas, 54 % in a dense one) a needle's next event is a horizon, at most a
// cell's flight ahead. Otherwise it is a contact with a needle near it in storage, which replaces
// the events of both.
//
// Names are MODEL/CALENDAR/NEEDLES; an iteration is an event.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/calendar/all.h"

namespace needlework {
namespace {

// splitmix64 (Steele, Lea, Flood 2014).
class Random {
 public:
  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>(((bits() >> 32) * n) >> 32);
  }
  double uniform() { return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52; }

 private:
  std::uint64_t state_ = 1;
};

// All times are in the first epoch, so that the arithmetic of times is not measured.
const Clock clock_of_play(0x1p40);
Time later(Time now, double ahead) { return {now.epoch, now.offset + ahead}; }

// Drawn beforehand, so that drawing is not measured either.
const std::vector<double>& exponentials() {
  static const std::vector<double> drawn = [] {
    std::vector<double> x(1 << 16);
    Random random;
    for (double& value : x) value = -std::log(random.uniform());
    return x;
  }();
  return drawn;
}

struct Hold {
  static constexpr const char* name = "hold";

  Event draw(Needle owner, std::uint32_t, Time now) {
    Event event;
    event.owner = owner;
    event.lower_id = event.higher_id = Id{owner.index};
    event.time = later(now, times[random.bits() & 0xffff]);
    return event;
  }
  Needle other(const Event&, std::uint32_t n) { return Needle(random.below(n)); }

  Random random;
  const std::vector<double>& times = exponentials();
};

struct Mix {
  static constexpr const char* name = "mix";

  Event draw(Needle owner, std::uint32_t n, Time now) {
    Event event;
    event.owner = owner;
    const std::uint64_t bits = random.bits();
    double ahead = 0.2 * times[bits & 0xffff];
    event.lower_id = event.higher_id = Id{owner.index};
    if ((bits >> 16 & 0xff) < 128) {
      const std::uint32_t near = static_cast<std::uint32_t>(bits >> 24 & 0x3f) + 1;
      const std::uint32_t mine = owner.index;
      const std::uint32_t other = mine + near < n ? mine + near : mine - std::min(mine, near);
      event.kind = EventKind::contact;
      event.partner = Needle(other);
      event.lower_id = Id{std::min(mine, other)};
      event.higher_id = Id{std::max(mine, other)};
      event.owner_is_lower = mine <= other;
    } else {
      ahead = 0.4 * static_cast<double>(bits >> 32) * 0x1p-32;
    }
    event.time = later(now, ahead);
    return event;
  }
  Needle other(const Event& event, std::uint32_t) { return event.partner; }

  Random random;
  const std::vector<double>& times = exponentials();
};

template <class Model, Calendar C>
class Play {
 public:
  explicit Play(std::uint32_t n)
      : calendar_(n, clock_of_play, (std::size_t{n} + in_cell - 1) / in_cell), n_(n) {
    for (Needle i{0}; i < n; ++i) set(model_.draw(i, n, {}));
  }
  Event step() {
    const Event event = calendar_.top();
    const Needle other = model_.other(event, n_);
    set(model_.draw(event.owner, n_, event.time));
    if (other != no_needle) set(model_.draw(other, n_, event.time));
    return event;
  }

 private:
  static constexpr std::uint32_t in_cell = 16;  // needles, by index

  void set(const Event& event) { calendar_.set(event, event.owner.index / in_cell); }

  Model model_;
  C calendar_;
  std::uint32_t n_;
};

template <class Model, Calendar C>
void check_against_plain() {
  Play<Model, C> play(1000);
  Play<Model, LazyHeap> plain(1000);
  for (int n = 0; n < 20000; ++n) {
    const Event event = play.step(), expected = plain.step();
    if (event < expected || expected < event) {
      throw std::logic_error(std::string(C::name) + ": wrong event");
    }
  }
}

// The play that was measured last, whatever its type, and its name.
struct Kept {
  std::string name;
  std::shared_ptr<void> play;
} kept;

/// A play of n needles in its stationary state. It is kept until another one is asked for, as
/// Google Benchmark calls a benchmark several times to find how many iterations to make.
template <class Model, Calendar C>
Play<Model, C>& stationary_play(std::uint32_t n) {
  const std::string name = std::string(Model::name) + "/" + C::name + "/" + std::to_string(n);
  if (kept.name != name) {
    kept = {};
    check_against_plain<Model, C>();
    const auto play = std::make_shared<Play<Model, C>>(n);
    for (std::uint32_t step = 0; step < 2 * n; ++step) play->step();
    kept = {name, play};
  }
  return *static_cast<Play<Model, C>*>(kept.play.get());
}

template <class Model, Calendar C>
void measure(benchmark::State& state) {
  Play<Model, C>& play = stationary_play<Model, C>(static_cast<std::uint32_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(play.step());
  state.SetItemsProcessed(state.iterations());
}

template <class Model, class... Calendars>
void add(CalendarList<Calendars...>) {
  for (const std::int64_t n : {1000, 10000, 100000, 1000000}) {
    (benchmark::RegisterBenchmark((std::string(Model::name) + "/" + Calendars::name).c_str(),
                                  measure<Model, Calendars>)
         ->Arg(n),
     ...);
  }
}

const bool added =
    (add<Hold>(AllCalendars<CalendarList>()), add<Mix>(AllCalendars<CalendarList>()), true);

}  // namespace
}  // namespace needlework
