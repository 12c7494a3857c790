// An effect that the scene does not use costs nothing: its code is not in the loop that runs,
// and it holds nothing for any needle.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdio.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <map>
#include <memory>
#include <new>
#include <regex>
#include <string>

#include "needlework/initial_state.h"
#include "needlework/simulation.h"
#include "src/engine/initial_gas.h"
#include "src/engine/make_loop.h"
#include "src/engine/run.h"

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

/// The code of the event processor that the compiler has made for one model: its meet(), and
/// what it has for walls and thermostats, which are sources of events.
struct CollideCode {
  int smooth_calls = 0, rough_calls = 0;  ///< of the collision rule without and with beta
  int contact_times = 0;                  ///< instructions that read the contact time of the run
  int species = 0;                        ///< instructions that read the species of a record
  int sources = 0;  ///< functions that ask sources, or let their events happen
};

/// By object file and search, then by whether the model has effects.
using CodeByLoop = std::map<std::string, std::map<bool, CollideCode>>;

// An instruction's access to a member of a large struct, by its place in there. What lies on the
// stack may have any place.
std::regex member_at(std::size_t offset) {
  return std::regex(fmt::format("[ ,]{:#x}\\((?!%[er]sp)", offset));
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"
const std::regex contact_time = member_at(offsetof(Run, contact_time));
#pragma GCC diagnostic pop
const std::regex species = member_at(offsetof(Record, species));

CodeByLoop read_library() {
  CodeByLoop out;
  const std::string command =
      std::string(NEEDLEWORK_OBJDUMP) + " -drC --no-show-raw-insn " + NEEDLEWORK_LIBRARY;
  const auto close = [](FILE* file) { EXPECT_EQ(pclose(file), 0); };
  const std::unique_ptr<FILE, decltype(close)> pipe(popen(command.c_str(), "r"), close);
  const std::regex loop(
      "<needlework::EventProcessor<needlework::(\\w+), "
      "needlework::NeedleModel<(true|false), needlework::NeedleContact> *>::"
      "(meet|consider_sources|happen)\\(");
  std::string object;
  CollideCode* code = nullptr;
  char buffer[1 << 16];  // names of templates are long
  while (fgets(buffer, sizeof buffer, pipe.get())) {
    const std::string line(buffer);
    if (line.find("file format") != line.npos) object = line.substr(0, line.find(':'));
    if (line.find(">:\n") != line.npos && line.front() != ' ') {
      std::smatch match;
      code = nullptr;
      const std::string symbol = line.substr(line.find('<'));
      if (!std::regex_search(symbol, match, loop)) continue;
      CollideCode& of_model = out[object + ", " + match[1].str()][match[2] == "true"];
      if (match[3] == "meet") {
        code = &of_model;
      } else {
        ++of_model.sources;
      }
    } else if (code && line.find("R_") != line.npos) {
      code->smooth_calls += line.find("needlework::collide<(needlework::Surface)0>") != line.npos;
      code->rough_calls += line.find("needlework::collide<(needlework::Surface)1>") != line.npos;
    } else if (code && line.find(":\t") != line.npos) {
      code->contact_times += std::regex_search(line, contact_time);
      code->species += std::regex_search(line, species);
    }
  }
  return out;
}

TEST(EffectThatIsOff, HasNoCodeInTheLoop) {
#ifndef NDEBUG
  GTEST_SKIP() << "checks and sanitizers add code of their own; built for release it is read";
#endif
#ifndef __x86_64__
  GTEST_SKIP() << "reads the instructions of x86-64";
#endif
  const CodeByLoop loops = read_library();
  EXPECT_EQ(loops.size(), 4u) << "three searches on one thread, and one on several";
  for (const auto& [loop, by_effects] : loops) {
    ASSERT_EQ(by_effects.size(), 2u) << loop;
    for (const auto& [has_effects, code] : by_effects) {
      SCOPED_TRACE(loop + (has_effects ? ", with effects" : ", without"));
      EXPECT_GT(code.smooth_calls, 0);
      EXPECT_EQ(code.rough_calls > 0, has_effects);
      EXPECT_EQ(code.contact_times > 0, has_effects);
      EXPECT_EQ(code.species > 0, has_effects);
      EXPECT_EQ(code.sources > 0, has_effects);
    }
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
  EXPECT_NEAR(difference(with_tc), 500 * 16, 256);
}

// Nor does the table of species, by needle.
TEST(EffectThatIsOff, HoldsAsMuchWithATable) {
  Scene scene;
  scene.needles.count = 500;
  scene.needles.box = {10, 10, 10};
  const State state = draw_initial_state(scene);
  const auto bytes = [&](bool table) {
    const std::size_t before = bytes_allocated;
    needlework::Run run(scene, make_gas(scene, state));
    run.effects.table = table;
    const auto loop = make_loop(run, {.search = "linked-cells", .calendar = "tournament"});
    loop->advance(StopConditions(
        run, {.time = 0.1, .collisions_per_needle = {}, .energy_ratio = {}, .wall_s = {}}));
    return bytes_allocated - before;
  };
  const std::size_t without = bytes(false);
  EXPECT_GT(without, 500u * 500);
  EXPECT_EQ(bytes(true), without);
}

}  // namespace
}  // namespace needlework
