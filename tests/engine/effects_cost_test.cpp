// An effect that the scene does not call for costs nothing: its code is not in the loop that runs,
// and it holds nothing for any needle.
#include <gtest/gtest.h>
#include <stdio.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <new>
#include <regex>
#include <string>

#include "needlework/initial_state.h"
#include "needlework/simulation.h"

namespace {
std::size_t bytes_allocated = 0;  // by new, in one thread
}

// Not inlined, or GCC takes new and free for mismatched.
[[gnu::noinline]] void* operator new(std::size_t size) {
  bytes_allocated += size;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  bytes_allocated += size;
  return std::malloc(size);
}
// Arrays of all needles are allocated by this one.
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  bytes_allocated += size;
  const auto unit = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(unit, (size + unit - 1) / unit * unit)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}

namespace needlework {
namespace {

/// A collide() of the event loop, as the compiler has made it for one choice of effects.
struct CollideCode {
  int instructions = 0;
  int smooth_calls = 0, rough_calls = 0;  ///< of the collision rule without and with beta
};

/// By search and calendar, then by effects: "-", "rough", "tc", "rough tc".
using CodeByLoop = std::map<std::string, std::map<std::string, CollideCode>>;

CodeByLoop read_library() {
  CodeByLoop out;
  const std::string command =
      std::string(NEEDLEWORK_OBJDUMP) + " -drC --no-show-raw-insn " + NEEDLEWORK_LIBRARY;
  const auto close = [](FILE* file) { EXPECT_EQ(pclose(file), 0); };
  const std::unique_ptr<FILE, decltype(close)> pipe(popen(command.c_str(), "r"), close);
  const std::regex loop("<needlework::Worker<(.*), needlework::Effects\\{(.*)\\}>::collide\\(.*");
  CollideCode* code = nullptr;
  char buffer[4096];
  while (fgets(buffer, sizeof buffer, pipe.get())) {
    const std::string line(buffer);
    if (line.find(">:\n") != line.npos && line.front() != ' ') {
      std::smatch match;
      code = nullptr;
      const std::string symbol = line.substr(line.find('<'));
      if (!std::regex_search(symbol, match, loop)) continue;
      const std::string flags = match[2];  // "", "true", "false, true" and the like
      const bool rough = flags.starts_with("true");
      const bool contact_time = flags.ends_with(", true");
      const char* effects = rough ? contact_time ? "rough tc" : "rough" : contact_time ? "tc" : "-";
      code = &out[match[1]][effects];
    } else if (code && line.find("R_") != line.npos) {
      code->smooth_calls += line.find("needlework::collide<true>") != line.npos;
      code->rough_calls += line.find("needlework::collide<false>") != line.npos;
    } else if (code && line.find(":\t") != line.npos) {
      ++code->instructions;
    }
  }
  return out;
}

TEST(EffectThatIsOff, HasNoCodeInTheLoop) {
#ifndef NDEBUG
  GTEST_SKIP() << "checks and sanitizers add code of their own; built for release it is read";
#endif
  const CodeByLoop loops = read_library();
  EXPECT_GE(loops.size(), 20u) << "searches times calendars";
  for (const auto& [loop, by_effects] : loops) {
    ASSERT_EQ(by_effects.size(), 4u) << loop;
    const CollideCode &plain = by_effects.at("-"), &rough = by_effects.at("rough"),
                      &tc = by_effects.at("tc"), &both = by_effects.at("rough tc");
    // What the t_c rule does is a collision of smooth needles.
    EXPECT_EQ(plain.rough_calls, 0) << loop;
    EXPECT_EQ(plain.smooth_calls, 1) << loop;
    EXPECT_EQ(tc.rough_calls, 0) << loop;
    EXPECT_EQ(rough.smooth_calls, 0) << loop;
    EXPECT_GT(rough.rough_calls, 0) << loop;
    EXPECT_GT(both.rough_calls * both.smooth_calls, 0) << loop;
    EXPECT_LT(plain.instructions, tc.instructions) << loop;
    EXPECT_LT(rough.instructions, both.instructions) << loop;
  }
}

std::size_t bytes_of(const Scene& scene) {
  const State state = draw_initial_state(scene);
  const std::size_t before = bytes_allocated;
  Simulation simulation(scene, state);
  simulation.advance({.time = 0.1, .collisions_per_needle = {}, .energy_ratio = {}, .wall_s = {}});
  return bytes_allocated - before;
}

TEST(EffectThatIsOff, HoldsNothing) {
  Scene scene;
  scene.needles.count = 500;
  scene.needles.box = {10, 10, 10};
  const std::size_t plain = bytes_of(scene);
  EXPECT_GT(plain, 500u * 500);

  Scene inelastic = scene, with_tc = scene;
  // On, but for rounding the same collisions, which come with memory of their own.
  inelastic.collisions.epsilon = std::nextafter(1.0, 0.0);
  inelastic.collisions.beta = std::nextafter(-1.0, 0.0);
  const auto difference = [&](const Scene& other) {
    // The scene's name of its effects may need a few bytes more.
    return static_cast<double>(bytes_of(other)) - static_cast<double>(plain);
  };
  EXPECT_NEAR(difference(inelastic), 0, 64);
  // With the t_c rule, the time of each needle's last collision.
  with_tc.collisions.tc = 1e-300;
  EXPECT_NEAR(difference(with_tc), 500 * 16, 64);
}

}  // namespace
}  // namespace needlework
