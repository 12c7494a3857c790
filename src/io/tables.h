// The tables of an H5MD file that a run fills: frames, sums over all needles, collisions.
//
// Every table has its times written apart from the rest, and last: the datasets of a file do not
// grow together, so that a row counts as written when its time is.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "needlework/collision.h"
#include "needlework/scene.h"
#include "needlework/state.h"
#include "needlework/totals.h"
#include "src/io/column.h"
#include "src/io/hdf5.h"

namespace needlework::io {

/// The step and time datasets of one time grid. The step is the number of collisions so far.
class Clock {
 public:
  /// Opens those in `group`.
  Clock(hid_t file, const std::string& group, const std::string& place);

  void append(std::span<const Totals> samples);

 private:
  Column step_, time_;
};

/// The sums over all needles, one H5MD element each.
class TotalsTable {
 public:
  TotalsTable(hid_t file, const std::string& group, const std::string& place);

  /// Writes the values; steps and times are for a Clock.
  void append(std::span<const Totals> samples);

 private:
  Column t_tr_, t_rot_, energy_, momentum_, collisions_, tc_collisions_;
};

/// /particles/needles: the phase-space states of a fixed number of needles.
class Frames {
 public:
  Frames(hid_t file, const std::string& place);

  /// Writes a frame; its step and time are for a Clock. Throws std::invalid_argument when the
  /// arrays do not have one entry a needle or the ids are not those of the frame before.
  void append(const State& state);

 private:
  void keep_ids(const State& state);

  std::string place_;
  hdf5::Handle id_;
  std::size_t needles_;
  std::vector<std::uint32_t> ids_;
  bool ids_kept_ = false;
  Column edges_, position_, image_, velocity_, orientation_, angular_velocity_;
};

/// /events: collisions, one row each.
class Events {
 public:
  Events(hid_t file, const std::string& place);

  void append(std::span<const Collision> collisions);  ///< all but the times
  void append_times(std::span<const Collision> collisions);

 private:
  Column time_, epoch_, offset_, pair_, arms_, normal_velocity_, tc_, shift_, impulse_;
};

}  // namespace needlework::io
