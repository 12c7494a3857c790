// The tables of an H5MD file that a run fills: frames, sums over all needles, collisions.
//
// The datasets of a table grow one after the other. The steps are written last, of events the
// times, by a function of their own, and a row is complete when that is in the file.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "needlework/happening.h"
#include "needlework/scene.h"
#include "needlework/series.h"
#include "needlework/state.h"
#include "needlework/totals.h"
#include "needlework/user_data.h"
#include "src/io/column.h"
#include "src/io/hdf5.h"

namespace needlework::io {

/// The datasets step and time that all elements of one table share. The step is the number of
/// collisions so far.
class StepsAndTimes {
 public:
  /// Opens the datasets in `group`.
  StepsAndTimes(hid_t file, const std::string& group, const std::string& place);

  void append_times(std::span<const Totals> samples);
  void append_steps(std::span<const Totals> samples);

 private:
  Column step_, time_;
};

/// The sums over all needles, one H5MD element each.
class TotalsTable {
 public:
  TotalsTable(hid_t file, const std::string& group, const std::string& place);

  /// Writes the values. Their steps and times are written by StepsAndTimes.
  void append(std::span<const Totals> samples);

 private:
  std::vector<Column> columns_;  ///< in the order of Totals::for_each_sum()
};

/// The fields of groups in /series, one H5MD element each, apart from constants.
class FieldsTable {
 public:
  FieldsTable(hid_t file, const std::vector<SeriesGroup>& groups, const std::string& place);

  /// Numbers in the rows of all fields.
  std::size_t width() const { return width_; }
  /// Writes samples, each of width() numbers, whose steps and times are written by StepsAndTimes.
  void append(std::span<const double> samples);

 private:
  struct Field {
    std::size_t begin, width;  ///< its numbers within a sample
    Column column;
  };
  std::vector<Field> fields_;
  std::size_t width_ = 0;
};

/// /particles/needles: the phase-space states of a fixed number of needles.
class Frames {
 public:
  /// `rows` is the number of frames in the file.
  Frames(hid_t file, const std::string& place, std::uint64_t rows);

  /// Writes a frame. Its step and time are written by StepsAndTimes. Throws std::invalid_argument
  /// if an array does not have one entry for each needle, or if the ids differ from those of the
  /// frame before.
  void append(const State& state);

 private:
  void write_ids(const State& state);

  std::string place_;
  hdf5::Handle id_;
  std::size_t needles_;
  std::vector<std::uint32_t> ids_;
  bool ids_written_;
  Column edges_, position_, image_, velocity_, orientation_, angular_velocity_;
  std::optional<Column> peculiar_velocity_;  ///< in a uniform flow
  std::optional<Column> low_;                ///< where walls move edges
  std::optional<Column> scale_;              ///< of bodies that grow
};

/// A change of all velocities by a caller.
struct VelocitiesSet {
  Totals before, after;
};

/// /velocities_set: one row for each change.
class VelocitiesSetTable {
 public:
  VelocitiesSetTable(hid_t file, const std::string& place);

  void append(std::span<const VelocitiesSet> changes);        ///< all columns except the steps
  void append_steps(std::span<const VelocitiesSet> changes);  ///< by which rows are complete

 private:
  Column step_, time_;
  std::vector<Column> columns_;  ///< in the order of for_each_of_velocities()
};

/// What was set under a name at one instant.
struct DataEntry {
  Totals now;
  std::string name;
  std::optional<UserData> data;  ///< none: the name was removed
};

/// The type of names in /user_data: strings of a fixed length, as SWMR mode demands.
hdf5::Handle data_name_type(const std::string& place);

/// /user_data: one row for each entry, and the bytes of all values one after the other.
class UserDataTable {
 public:
  /// `bytes` is the number of those in the file.
  UserDataTable(hid_t file, const std::string& place, std::uint64_t bytes);

  void append(std::span<const DataEntry> entries);        ///< all columns except the steps
  void append_steps(std::span<const DataEntry> entries);  ///< by which rows are complete

 private:
  std::string place_;
  std::uint64_t end_;
  Column step_, time_, name_, json_, begin_, size_, bytes_;
};

/// /events: one row for each event.
class Events {
 public:
  /// `has_kinds`: whether there are others than collisions of two needles.
  Events(hid_t file, bool has_kinds, const std::string& place);

  void append(std::span<const Happening> happenings);  ///< writes all columns except the times
  void append_times(std::span<const Happening> happenings);

 private:
  std::optional<Column> kind_;
  Column time_, epoch_, offset_, pair_, arms_, normal_velocity_, tc_, shift_, impulse_;
};

}  // namespace needlework::io
