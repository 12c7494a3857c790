// Every allocation may fail: the failure is reported, nothing leaks or crashes, and a simulation
// either goes on as if nothing had happened or says that it cannot.
//
// Allocations by new fail one after the other, first the first one of a program, then the second,
// and so on. Those of HDF5, which is in C, do not.
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <new>

#include "tests/c/c_simulation.h"
#include "tests/support/temporary_folder.h"

namespace {

/// Number of allocations until all fail; negative: none does. The tests run on one thread.
long left = -1;
/// Smaller ones succeed and do not count [bytes].
std::size_t least = 0;

bool may_allocate(std::size_t size) {
  return left < 0 || size < least || left-- > 0 || (left = 0, false);
}

}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  void* memory = may_allocate(size) ? std::malloc(size) : nullptr;
  if (!memory) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return may_allocate(size) ? std::malloc(size) : nullptr;
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto unit = static_cast<std::size_t>(alignment);
  void* memory =
      may_allocate(size) ? std::aligned_alloc(unit, (size + unit - 1) / unit * unit) : nullptr;
  if (!memory) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace needlework {
namespace {

using test::Arrays;
using test::cooling;
using test::CSimulation;

/// All allocations from the nth on fail while it exists.
struct FailFrom {
  explicit FailFrom(long n, std::size_t of_size = 0) {
    left = n;
    least = of_size;
  }
  ~FailFrom() { left = -1; }
};

/// The parser of TOML ends the process where small allocations fail; a large one before it begins
/// makes sure that they will not.
constexpr std::size_t beyond_toml = 2048;

/// Calls attempt(n) with allocation n and all later ones failing, for each n until it succeeds, but
/// only for some of large n. attempt() says whether it did.
void with_each_failure(const std::function<bool(long)>& attempt) {
  long n = 0, failed = 0;
  for (;; n += 1 + n / 64) {
    if (attempt(n)) break;
    ++failed;
    ASSERT_LT(n, 1000000) << "expected success with so much memory";
  }
  EXPECT_GT(failed, 1) << "expected failures";
  std::printf("failed %ld times, succeeds with %ld allocations\n", failed, n);
}

void expect_memory_error(int code, const std::string& message) {
  EXPECT_EQ(code, NEEDLEWORK_INPUT);
  EXPECT_TRUE(message.starts_with("not enough memory")) << message;
}

TEST(CWithoutMemory, MakesNoSimulation) {
  const test::TemporaryFolder folder;
  const std::string scene = cooling + "output = { events = true, file = \"" +
                            (folder.path() / "a.h5").string() + "\" }\n";
  with_each_failure([&](long n) {
    needlework_error error;
    needlework_simulation* simulation = nullptr;
    {
      const FailFrom failing(n, beyond_toml);
      simulation = needlework_create(scene.c_str(), NEEDLEWORK_REPLACE, &error);
    }
    if (!simulation) expect_memory_error(error.code, error.message);
    needlework_destroy(simulation);
    return simulation != nullptr;
  });
}

TEST(CWithoutMemory, MakesNoSimulationOfArrays) {
  const Arrays arrays{CSimulation(cooling)};
  const needlework_initial initial = arrays.initial(5);
  with_each_failure([&](long n) {
    needlework_error error;
    needlework_simulation* simulation = nullptr;
    {
      const FailFrom failing(n, beyond_toml);
      simulation = needlework_create_from("", &initial, 0, &error);
    }
    if (!simulation) expect_memory_error(error.code, error.message);
    needlework_destroy(simulation);
    return simulation != nullptr;
  });
}

// It may be in the middle of an event.
TEST(CWithoutMemory, RunsNoFurther) {
  const std::string scene = "needles = { count = 400, box = 7 }\nengine.threads = 1\n";
  const CSimulation undisturbed(scene);
  undisturbed.run_to(4000);
  with_each_failure([&](long n) {
    const CSimulation simulation(scene);
    const needlework_limits limits{0, 4000, 0, 0, 0};
    int code = NEEDLEWORK_OK;
    {
      const FailFrom failing(n);
      code = needlework_run_until(simulation, &limits, nullptr);
    }
    if (code == NEEDLEWORK_OK) {
      EXPECT_EQ(simulation.hash(), undisturbed.hash());
      return true;
    }
    expect_memory_error(code, simulation.message());
    needlework_totals totals;
    EXPECT_EQ(needlework_run_until(simulation, &limits, nullptr), NEEDLEWORK_INVALID_STATE);
    EXPECT_EQ(needlework_get_totals(simulation, &totals), NEEDLEWORK_INVALID_STATE);
    EXPECT_TRUE(simulation.message().starts_with("an error came in the middle of an event"))
        << simulation.message();
    return false;
  });
}

TEST(CWithoutMemory, HandsOverSmallerBatches) {
  const CSimulation simulation(cooling);
  struct Seen {
    std::size_t collisions = 0, calls = 0;
    static int add(const needlework_collision*, std::size_t count, void* user) {
      Seen& seen = *static_cast<Seen*>(user);
      seen.collisions += count;
      ++seen.calls;
      return 0;
    }
  } seen;
  EXPECT_EQ(needlework_set_callback(simulation, 1000000, Seen::add, &seen), NEEDLEWORK_OK);
  simulation.run_to(1);  // the first search of all needles takes memory, too
  {
    const FailFrom failing(0, 32 * sizeof(needlework_collision));
    simulation.run_to(200);
  }
  EXPECT_EQ(seen.collisions, 200u);
  EXPECT_GT(seen.calls, 5u);
}

TEST(CWithoutMemory, LooksAtNothingAndStaysWhole) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "state.h5").string();
  const CSimulation simulation(cooling), undisturbed(cooling);
  simulation.run_to(50);
  Arrays arrays(60);
  const needlework_state into{{arrays.position.data(), 0, 0}, {}, {}, {}, nullptr, nullptr};
  needlework_totals totals;
  char hash[33];
  const std::function<int()> calls[] = {
      [&] { return needlework_get_state(simulation, &into); },
      [&] { return needlework_get_totals(simulation, &totals); },
      [&] { return needlework_get_hash(simulation, hash); },
      [&] { return needlework_write_state(simulation, file.c_str(), NEEDLEWORK_REPLACE); },
      [&] { return needlework_setting(simulation, "search") ? NEEDLEWORK_OK : NEEDLEWORK_INPUT; },
  };
  for (const auto& call : calls) {
    for (long n = 0;; n += 1 + n / 16) {
      const FailFrom failing(n);
      const int code = call();
      left = -1;
      if (code == NEEDLEWORK_OK) break;
      expect_memory_error(code, simulation.message());
      ASSERT_LT(n, 100000);
    }
  }
  simulation.run_to(100);
  undisturbed.run_to(100);
  EXPECT_EQ(simulation.hash(), undisturbed.hash());
}

TEST(CWithoutMemory, ComputesNoTheory) {
  const needlework_gas gas{6, 0.8, -1};
  const double tau[2] = {1, 10};
  double t_tr[2], ratio;
  needlework_error error;
  for (long n = 0;; ++n) {
    const FailFrom failing(n);
    int code = needlework_cooling(&gas, 1, 1, 2, tau, t_tr, t_tr, &error);
    if (code == NEEDLEWORK_OK) code = needlework_ratio(&gas, &ratio, &error);
    left = -1;
    if (code == NEEDLEWORK_OK) break;
    expect_memory_error(code, error.message);
    ASSERT_LT(n, 100000);
  }
}

}  // namespace
}  // namespace needlework
