// A run of a C program is stopped from anywhere, and goes on as if it had not been.
#include <csignal>
#include <thread>

#include "tests/c/c_simulation.h"

namespace needlework {
namespace {

using test::cooling;
using test::CSimulation;

const needlework_limits an_hour{0, 0, 0, 0, 3600};

// Waits for collisions, so that how fast the machine is does not matter.
struct Waiter {
  std::atomic<bool> running = false;
  static int note(const needlework_collision*, std::size_t, void* waiter) {
    static_cast<Waiter*>(waiter)->running = true;
    return 0;
  }
};

TEST(CInterrupt, StopsARunFromAnotherThread) {
  const CSimulation simulation(cooling);
  Waiter waiter;
  EXPECT_EQ(needlework_set_callback(simulation, 1, Waiter::note, &waiter), NEEDLEWORK_OK);
  std::thread other([&] {
    while (!waiter.running) std::this_thread::yield();
    needlework_interrupt(simulation);
  });
  int stop = -1;
  EXPECT_EQ(needlework_run_until(simulation, &an_hour, &stop), NEEDLEWORK_OK);
  other.join();
  EXPECT_EQ(stop, NEEDLEWORK_STOP_INTERRUPTED);

  const std::uint64_t target = simulation.totals().collisions + 50;
  simulation.run_to(target);
  const CSimulation undisturbed(cooling);
  undisturbed.run_to(target);
  EXPECT_EQ(simulation.hash(), undisturbed.hash());
}

needlework_simulation* of_handler;
void interrupt_it(int) { needlework_interrupt(of_handler); }

TEST(CInterrupt, StopsARunFromASignalHandler) {
  const CSimulation simulation(cooling);
  of_handler = simulation;
  const auto before = std::signal(SIGUSR1, interrupt_it);
  // Sent by the running thread to itself, in the middle of a run.
  const auto send = [](const needlework_collision*, std::size_t, void* left) {
    if (--*static_cast<int*>(left) == 0) std::raise(SIGUSR1);
    return 0;
  };
  int left = 20, stop = -1;
  EXPECT_EQ(needlework_set_callback(simulation, 1, send, &left), NEEDLEWORK_OK);
  EXPECT_EQ(needlework_run_until(simulation, &an_hour, &stop), NEEDLEWORK_OK);
  EXPECT_EQ(stop, NEEDLEWORK_STOP_INTERRUPTED);
  EXPECT_EQ(std::signal(SIGUSR1, before), interrupt_it) << "the handler of the host stays";
}

TEST(CInterrupt, StopsTheNextRunIfNoneIsRunning) {
  const CSimulation simulation(cooling);
  needlework_interrupt(simulation);
  int stop = -1;
  EXPECT_EQ(needlework_run_until(simulation, &an_hour, &stop), NEEDLEWORK_OK);
  EXPECT_EQ(stop, NEEDLEWORK_STOP_INTERRUPTED);
  EXPECT_EQ(simulation.totals().collisions, 0u);
  simulation.run_to(5);
  EXPECT_EQ(simulation.totals().collisions, 5u);
  needlework_interrupt(nullptr);
}

}  // namespace
}  // namespace needlework
