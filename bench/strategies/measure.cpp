#include "bench/strategies/measure.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <system_error>
#include <type_traits>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "needlework/simulation.h"
#include "src/runs/resources.h"

namespace needlework::bench {
namespace {

using Text = std::array<char, 256>;

// A sample as it is sent through a pipe, with an error message if there is one.
struct Message {
  double setup_s, cpu_s, wall_s;
  std::uint64_t collisions, bytes;
  Counters counters;
  Text search, calendar, effects, warm_up_hash, error;
};
static_assert(std::is_trivially_copyable_v<Message>);

Text text_of(const std::string& words) {
  Text out{};
  words.copy(out.data(), out.size() - 1);
  return out;
}

Counters difference(Counters now, const Counters& before) {
  for (const Counters::Named& counter : Counters::all) {
    now.*counter.value -= before.*counter.value;
  }
  return now;
}

State initial_state(const Case& what) {
  if (what.initial) return *what.initial;
  State out = draw_initial_state(what.scene);
  for (auto& r : out.position) {
    for (double& x : r) x *= what.filled;
  }
  return out;
}

Message measure_here(const Case& what, double min_time) {
  Message out{};
  const std::uint64_t before = runs::peak_memory();
  runs::Stopwatch setup, loop;
  setup.start();
  const bool draws = what.filled == 1 && !what.initial;
  Simulation simulation =
      draws ? Simulation(what.scene) : Simulation(what.scene, initial_state(what));
  Scene::Until until;
  until.collisions_per_needle = warm_up;
  simulation.prepare(until);
  setup.stop();

  simulation.advance(until);
  out.warm_up_hash = text_of(simulation.trajectory_hash());
  const Counters counters = simulation.counters();
  const std::uint64_t collisions = simulation.totals().collisions;
  loop.start();
  do {
    *until.collisions_per_needle += stretch;
    if (simulation.advance(until) != Stop::collisions) {
      throw InvalidStateError("nothing can happen: expected needles that collide");
    }
    loop.stop();
    loop.start();
  } while (loop.cpu() < min_time);

  out.setup_s = setup.cpu();
  out.cpu_s = loop.cpu();
  out.wall_s = loop.wall();
  out.collisions = simulation.totals().collisions - collisions;
  out.bytes = runs::peak_memory() - before;
  out.counters = difference(simulation.counters(), counters);
  out.search = text_of(simulation.search());
  out.calendar = text_of(simulation.queue());
  out.effects = text_of(simulation.effects());
  return out;
}

[[noreturn]] void be_child(int pipe, const Case& what, double min_time) {
  Message message{};
  try {
    message = measure_here(what, min_time);
  } catch (const std::exception& error) {
    message.error = text_of(error.what());
  }
  const ssize_t written = write(pipe, &message, sizeof message);  // smaller than the capacity of a
                                                                  // pipe
  _exit(written == sizeof message ? 0 : 1);
}

bool receive(int pipe, Message& message) {
  std::size_t size = 0;
  char* bytes = reinterpret_cast<char*>(&message);
  while (size < sizeof message) {
    const ssize_t got = read(pipe, bytes + size, sizeof message - size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    size += static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace

Sample measure(const Case& what, double min_time) {
  int ends[2];
  if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) {
    close(ends[0]);
    be_child(ends[1], what, min_time);
  }
  close(ends[1]);
  Message message{};
  const bool complete = receive(ends[0], message);
  close(ends[0]);
  waitpid(child, nullptr, 0);
  if (!complete) throw InvalidStateError(what.name() + ": its process was killed");
  if (message.error[0]) throw InvalidStateError(what.name() + ": " + message.error.data());

  Sample out;
  out.setup_s = message.setup_s;
  out.cpu_s = message.cpu_s;
  out.wall_s = message.wall_s;
  out.collisions = message.collisions;
  out.counters = message.counters;
  out.bytes = message.bytes;
  out.search = message.search.data();
  out.calendar = message.calendar.data();
  out.effects = message.effects.data();
  out.warm_up_hash = message.warm_up_hash.data();
  return out;
}

}  // namespace needlework::bench
