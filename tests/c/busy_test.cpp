// A simulation in use refuses further calls instead of coming to harm.
#include <atomic>
#include <thread>

#include "tests/c/c_simulation.h"

namespace needlework {
namespace {

using test::cooling;
using test::CSimulation;

/// Calls every function on a simulation that is in use; all refuse, and its message says why.
void expect_in_use(needlework_simulation* simulation) {
  test::expect_all_refuse(simulation);
  EXPECT_STREQ(needlework_message(simulation),
               "another call uses the simulation: expected one call at a time");
  EXPECT_EQ(needlework_count(simulation), 60u) << "is for any time";
}

TEST(CBusy, RefusesCallsFromItsOwnCallback) {
  const CSimulation simulation(cooling);
  struct Inside {
    needlework_simulation* simulation;
    int calls = 0;
    static int call(const needlework_collision*, std::size_t, void* user) {
      Inside& inside = *static_cast<Inside*>(user);
      if (inside.calls++ == 0) expect_in_use(inside.simulation);
      return 0;
    }
  } inside{simulation};
  EXPECT_EQ(needlework_set_callback(simulation, 1, Inside::call, &inside), NEEDLEWORK_OK);
  simulation.run_to(50);
  EXPECT_EQ(inside.calls, 50);
  EXPECT_EQ(simulation.message(), "") << "what was refused is no failure of the run";
  const CSimulation undisturbed(cooling);
  undisturbed.run_to(50);
  EXPECT_EQ(simulation.hash(), undisturbed.hash());
}

TEST(CBusy, RefusesCallsFromAnotherThread) {
  const CSimulation simulation(cooling);
  struct Gate {
    std::atomic<bool> inside = false, open = false;
    static int wait(const needlework_collision*, std::size_t, void* user) {
      Gate& gate = *static_cast<Gate*>(user);
      gate.inside = true;
      while (!gate.open) std::this_thread::yield();
      return 0;
    }
  } gate;
  EXPECT_EQ(needlework_set_callback(simulation, 1, Gate::wait, &gate), NEEDLEWORK_OK);
  std::thread runs([&] { simulation.run_to(50); });
  while (!gate.inside) std::this_thread::yield();
  expect_in_use(simulation);
  // Others are free.
  const CSimulation other(cooling);
  other.run_to(50);
  gate.open = true;
  runs.join();
  EXPECT_EQ(simulation.hash(), other.hash());
}

TEST(CBusy, SimulationsOfTwoThreadsHaveTheSameHashWithDifferentInstructionSets) {
  std::vector<std::string> names;
  for (const char* name : {"scalar", "sse4", "avx2", "avx512"}) {
    if (needlework_has((std::string("isa/") + name).c_str())) names.emplace_back(name);
  }
  if (names.size() < 2) GTEST_SKIP() << "this processor has one instruction set";
  std::string hashes[2];
  const auto run = [&](const std::string& isa, std::string& hash) {
    const CSimulation simulation("needles = { count = 300, box = 7 }\nengine.isa = \"" + isa +
                                 "\"\n");
    EXPECT_STREQ(needlework_setting(simulation, "isa"), isa.c_str());
    for (std::uint64_t n = 100; n <= 1000; n += 100) simulation.run_to(n);
    hash = simulation.hash();
  };
  std::thread first(run, names.front(), std::ref(hashes[0]));
  std::thread second(run, names.back(), std::ref(hashes[1]));
  first.join();
  second.join();
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace needlework
