// What C callers learn of a simulation: state, sums, counters, settings.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include "src/c/handle.h"
#include "src/c/numbers.h"
#include "src/c/totals.h"
#include "src/c/vectors.h"
#include "src/runs/output_path.h"
#include "src/runs/state_file.h"

using namespace needlework;

namespace {

/// Calls that do not change the simulation still claim it: another thread may be running it.
needlework_simulation* mutable_of(const needlework_simulation* simulation) {
  return const_cast<needlework_simulation*>(simulation);
}

}  // namespace

size_t needlework_count(const needlework_simulation* simulation) {
  return simulation ? simulation->run.scene().needles.count : 0;
}

int needlework_get_box(const needlework_simulation* simulation, double box[3]) {
  return c::guarded(mutable_of(simulation), [&](needlework_simulation& self) {
    c::require(box, "box");
    std::ranges::copy(self.run.simulation().box(), box);
  });
}

int needlework_get_state(needlework_simulation* simulation, const needlework_state* into) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(into, "into");
    const State state = self.run.simulation().copy();
    c::copy_rows(state.position, into->position);
    c::copy_rows(state.velocity, into->velocity);
    c::copy_rows(state.orientation, into->orientation);
    c::copy_rows(state.angular_velocity, into->angular_velocity);
    const bool flows = !state.peculiar_velocity.empty();
    c::copy_rows(flows ? state.peculiar_velocity : state.velocity, into->peculiar_velocity);
    if (into->slide) *into->slide = state.slide;
    if (into->low) std::ranges::copy(state.low, into->low);
    if (into->id) std::copy(state.id.begin(), state.id.end(), into->id);
    if (!into->image) return;
    for (std::size_t n = 0; n < state.size(); ++n) {
      std::copy_n(state.image[n].begin(), 3, into->image + 3 * n);
    }
  });
}

int needlework_write_state(needlework_simulation* simulation, const char* path, unsigned flags) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(path, "path");
    c::require_flags(flags);
    std::error_code ignored;
    if (!self.closed && std::filesystem::equivalent(path, self.run.scene().output.file, ignored)) {
      throw c::UsageError(std::string(path) +
                          ": is the output file, which is still written: expected another file");
    }
    const bool replaces = flags & NEEDLEWORK_REPLACE;
    runs::require_writable(path, replaces, path, "NEEDLEWORK_REPLACE");
    runs::write_state(self.run.simulation(), self.run.scene(), self.run.data(), path, replaces);
  });
}

int needlework_get_totals(needlework_simulation* simulation, needlework_totals* totals) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(totals, "totals");
    const Simulation& source = self.run.simulation();
    const c::AllTotals numbers{.sums = source.totals(),
                               .initial_energy = source.initial_energy(),
                               .mean_free_time = source.mean_free_time(),
                               .epoch_length = source.epoch_length()};
    c::copy_numbers(numbers, *totals, &needlework_totals::time);
  });
}

int needlework_get_hash(needlework_simulation* simulation, char hash[33]) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(hash, "hash");
    const std::string text = self.run.simulation().trajectory_hash();
    std::memcpy(hash, text.c_str(), 33);
  });
}

const char* needlework_counter_name(size_t index) {
  return index < Counters::all.size() ? Counters::all[index].name : nullptr;
}

int needlework_get_counter(needlework_simulation* simulation, const char* name, uint64_t* value) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(name, "name");
    c::require(value, "value");
    const std::string_view wanted = name;
    const auto found = std::find_if(Counters::all.begin(), Counters::all.end(),
                                    [&](const Counters::Named& c) { return c.name == wanted; });
    if (found == Counters::all.end()) {
      throw c::UsageError("name = \"" + std::string(wanted) +
                          "\": expected one of needlework_counter_name()");
    }
    *value = self.run.simulation().counters().*found->value;
  });
}

const char* needlework_setting(needlework_simulation* simulation, const char* name) {
  const char* setting = nullptr;
  c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(name, "name");
    const std::string_view wanted = name;
    const Simulation& source = self.run.simulation();
    if (wanted == "search")
      self.setting = source.search();
    else if (wanted == "queue")
      self.setting = source.queue();
    else if (wanted == "isa")
      self.setting = source.isa();
    else if (wanted == "effects")
      self.setting = source.effects();
    else
      throw c::UsageError("name = \"" + std::string(wanted) +
                          "\": expected search, queue, isa or effects");
    setting = self.setting.c_str();
  });
  return setting;
}
