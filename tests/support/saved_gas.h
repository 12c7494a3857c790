// What Simulation::checkpoint() saves, as numbers that tests can change.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "needlework/simulation.h"
#include "src/archive/archive.h"
#include "src/engine/energy_shares.h"
#include "src/engine/tally.h"
#include "src/engine/temperature_integral.h"
#include "src/physics/gas.h"
#include "src/physics/transfer.h"

namespace needlework {

void transfer(Archive& archive, Counters& counters);  // of src/engine/saved_run.cpp

namespace test {

struct SavedNeedle {
  std::uint32_t id = 0;
  std::array<std::int32_t, 3> image{};
  Time time;
  kernels::Flight flight;
  std::uint32_t serial = 0;
  std::uint8_t species = 0;
  std::vector<RecordedTouch> touches;
  Time last_collision;  ///< if the scene has the t_c rule
};

struct SavedGas {
  explicit SavedGas(const Scene& scene, const Checkpoint& saved)
      : has_contact_time(scene.collisions.tc || scene.collisions.tc_relative) {
    Archive archive = Archive::from(saved.bytes);
    transfer(archive);
    archive.require_end();
  }
  Checkpoint checkpoint() {
    Checkpoint out;
    Archive archive = Archive::to(out.bytes);
    transfer(archive);
    return out;
  }

  /// Passes all times to a function, apart from those that stand for never or for long ago.
  template <class Change>
  void for_each_time(Change&& change) {
    const auto pass = [&](Time& time) {
      if (time.epoch > -(std::int64_t{1} << 61) && time != Time::never()) change(time);
    };
    for (SavedNeedle& needle : needles) {
      pass(needle.time);
      if (has_contact_time) pass(needle.last_collision);
    }
    pass(now);
    pass(window_end);
    pass(tally.instant);
  }

  void transfer(Archive& archive) {
    std::uint64_t count = needles.size();
    archive(physics, count, epoch_length);
    needles.resize(count);
    for (SavedNeedle& n : needles) {
      archive(n.id, n.image, n.time, n.flight, n.serial, n.species, n.touches);
      if (has_contact_time) archive(n.last_collision);
    }
    archive(now, window_end, mean_free_time, initial_energy, energy_at_window, motion_at_window,
            quanta_at_window, drift_of_windows);
    archive(tally.collisions, tally.tc_collisions, tally.energy, tally.hash, tally.counters,
            tally.instant, tally.at_instant);
    energy_shares.transfer(archive, 0, 0);  // without walls and driving
    temperature_integral.transfer(archive);
  }

  bool has_contact_time;
  std::vector<double> physics;  ///< the box comes first
  double epoch_length = 1;
  std::vector<SavedNeedle> needles;
  Time now, window_end;
  double mean_free_time = 0, initial_energy = 0, energy_at_window = 0, motion_at_window = 0;
  Quanta quanta_at_window;
  double drift_of_windows = 0;
  Tally tally;
  EnergyShares energy_shares;
  TemperatureIntegral temperature_integral;
};

}  // namespace test
}  // namespace needlework
