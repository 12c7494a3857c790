#include "src/io/tables.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "src/box/box.h"
#include "src/io/sums.h"

namespace needlework::io {

using hdf5::check;
using hdf5::type_of;

namespace {

// Calls `numbers(row, put)` for each row, and appends the numbers that it passes to `put`.
template <class Number, class Row, class Numbers>
void append_each(Column& column, std::span<const Row> rows, Numbers numbers) {
  std::vector<Number> values;
  const auto put = [&](auto value) { values.push_back(static_cast<Number>(value)); };
  for (const Row& row : rows) numbers(row, put);
  column.append(values.data(), rows.size());
}

// Calls put(number) for a number, or for each of an array.
template <class Value, class Put>
void put_numbers(const Value& value, const Put& put) {
  if constexpr (std::is_arithmetic_v<Value>) {
    put(value);
  } else {
    for (const auto& number : value) put(number);
  }
}

template <class Value>
void append_member(Column& column, std::span<const Totals> samples, Value Totals::*member) {
  append_each<typename InFile<Value>::Number>(
      column, samples, [&](const Totals& sample, auto put) { put_numbers(sample.*member, put); });
}

}  // namespace

StepsAndTimes::StepsAndTimes(hid_t file, const std::string& group, const std::string& place)
    : step_(file, group + "/step", place), time_(file, group + "/time", place) {}

void StepsAndTimes::append_times(std::span<const Totals> samples) {
  append_member(time_, samples, &Totals::time);
}

void StepsAndTimes::append_steps(std::span<const Totals> samples) {
  append_member(step_, samples, &Totals::collisions);
}

TotalsTable::TotalsTable(hid_t file, const std::string& group, const std::string& place) {
  Totals::for_each_sum([&](const Described& sum, auto) {
    columns_.emplace_back(file, fmt::format("{}/{}/value", group, sum.name), place);
  });
}

void TotalsTable::append(std::span<const Totals> samples) {
  auto column = columns_.begin();
  Totals::for_each_sum(
      [&](const Described&, auto member) { append_member(*column++, samples, member); });
}

FieldsTable::FieldsTable(hid_t file, const std::vector<SeriesGroup>& groups,
                         const std::string& place) {
  for (const SeriesGroup& group : groups) {
    for (const SeriesField& field : group.fields) {
      if (field.kind == SeriesField::Kind::constant) continue;
      const std::string path = fmt::format("/series/{}/{}/value", group.name, field.name);
      fields_.push_back({width_, field.width(), Column(file, path, place)});
      width_ += field.width();
    }
  }
}

void FieldsTable::append(std::span<const double> samples) {
  if (samples.empty()) return;
  const std::size_t count = samples.size() / width_;
  std::vector<double> rows;
  for (Field& field : fields_) {
    rows.clear();
    for (std::size_t n = 0; n < count; ++n) {
      const auto row = samples.subspan(n * width_ + field.begin, field.width);
      rows.insert(rows.end(), row.begin(), row.end());
    }
    // HDF5 converts counts, which are exact in double precision, to integers.
    field.column.append(rows.data(), count);
  }
}

Frames::Frames(hid_t file, const std::string& place, std::uint64_t rows)
    : place_(place),
      id_(hdf5::open_dataset(file, "/particles/needles/id", place)),
      needles_(hdf5::shape_of(id_.get(), place).at(0)),
      ids_(needles_),
      ids_written_(rows > 0),
      edges_(file, "/particles/needles/box/edges/value", place),
      position_(file, "/particles/needles/position/value", place),
      image_(file, "/particles/needles/image/value", place),
      velocity_(file, "/particles/needles/velocity/value", place),
      orientation_(file, "/particles/needles/orientation/value", place),
      angular_velocity_(file, "/particles/needles/angular_velocity/value", place) {
  constexpr const char* peculiar = "/particles/needles/peculiar_velocity";
  if (check(H5Lexists(file, peculiar, H5P_DEFAULT), place) > 0)
    peculiar_velocity_.emplace(file, std::string(peculiar) + "/value", place);
  constexpr const char* low = "/particles/needles/box/low";
  if (check(H5Lexists(file, low, H5P_DEFAULT), place) > 0)
    low_.emplace(file, std::string(low) + "/value", place);
  constexpr const char* scale = "/particles/needles/box/scale";
  if (check(H5Lexists(file, scale, H5P_DEFAULT), place) > 0)
    scale_.emplace(file, std::string(scale) + "/value", place);
  if (needles_ == 0) return;
  check(H5Dread(id_.get(), type_of<std::uint32_t>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, ids_.data()),
        place_);
}

void Frames::append(const State& state) {
  const auto fits = [&](const auto& array) { return array.size() == needles_; };
  if (!fits(state.position) || !fits(state.velocity) || !fits(state.orientation) ||
      !fits(state.angular_velocity) || (peculiar_velocity_ && !fits(state.peculiar_velocity)) ||
      !(state.image.empty() || fits(state.image)) || !(state.id.empty() || fits(state.id))) {
    throw std::invalid_argument(fmt::format("{}: a frame of {} needles: expected {} in each array",
                                            place_, state.size(), needles_));
  }
  write_ids(state);
  const auto vectors = box_of(state).vectors();
  edges_.append(vectors.front().data(), 1);
  if (low_) low_->append(state.low.data(), 1);
  if (scale_) {
    const double scale = state.scale.value_or(1);
    scale_->append(&scale, 1);
  }
  const auto append_frame = [](Column& column, const auto& rows) {
    column.append(
        reinterpret_cast<const typename std::decay_t<decltype(rows[0])>::value_type*>(rows.data()),
        1);
  };
  append_frame(position_, state.position);
  append_frame(velocity_, state.velocity);
  if (peculiar_velocity_) append_frame(*peculiar_velocity_, state.peculiar_velocity);
  append_frame(orientation_, state.orientation);
  append_frame(angular_velocity_, state.angular_velocity);
  if (state.image.empty()) {
    append_frame(image_, std::vector<std::array<std::int32_t, 3>>(needles_));
  } else {
    append_frame(image_, state.image);
  }
}

void Frames::write_ids(const State& state) {
  const bool first = !std::exchange(ids_written_, true);
  if (state.id.empty() || state.id == ids_) return;
  if (!first) {
    throw std::invalid_argument(
        fmt::format("{}: ids of a frame: expected those of the frame before", place_));
  }
  ids_ = state.id;
  check(H5Dwrite(id_.get(), type_of<std::uint32_t>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, ids_.data()),
        place_);
}

VelocitiesSetTable::VelocitiesSetTable(hid_t file, const std::string& place)
    : step_(file, "/velocities_set/step", place), time_(file, "/velocities_set/time", place) {
  for_each_of_velocities([&](const Described& sum, auto) {
    columns_.emplace_back(file, fmt::format("/velocities_set/{}", sum.name), place);
  });
}

void VelocitiesSetTable::append(std::span<const VelocitiesSet> changes) {
  append_each<double>(time_, changes,
                      [](const VelocitiesSet& change, auto put) { put(change.after.time); });
  auto column = columns_.begin();
  for_each_of_velocities([&](const Described&, auto member) {
    append_each<double>(*column++, changes, [&](const VelocitiesSet& change, auto put) {
      put_numbers(change.before.*member, put);
      put_numbers(change.after.*member, put);
    });
  });
}

void VelocitiesSetTable::append_steps(std::span<const VelocitiesSet> changes) {
  append_each<std::int64_t>(
      step_, changes, [](const VelocitiesSet& change, auto put) { put(change.after.collisions); });
}

hdf5::Handle data_name_type(const std::string& place) {
  hdf5::Handle type(H5Tcopy(H5T_C_S1), H5Tclose, place);
  check(H5Tset_size(type.get(), longest_data_name), place);
  check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), place);
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), place);
  return type;
}

UserDataTable::UserDataTable(hid_t file, const std::string& place, std::uint64_t bytes)
    : place_(place),
      end_(bytes),
      step_(file, "/user_data/step", place),
      time_(file, "/user_data/time", place),
      name_(file, "/user_data/name", place),
      json_(file, "/user_data/json", place),
      begin_(file, "/user_data/begin", place),
      size_(file, "/user_data/size", place),
      bytes_(file, "/user_data/bytes", place) {}

void UserDataTable::append(std::span<const DataEntry> entries) {
  std::string names, bytes;
  std::vector<std::int64_t> begins;
  for (const DataEntry& entry : entries) {
    begins.push_back(static_cast<std::int64_t>(end_ + bytes.size()));
    names += entry.name;
    names.resize(begins.size() * longest_data_name, '\0');
    if (entry.data) bytes += entry.data->bytes;
  }
  bytes_.append(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  end_ += bytes.size();
  append_each<double>(time_, entries,
                      [](const DataEntry& entry, auto put) { put(entry.now.time); });
  name_.append_as(data_name_type(place_).get(), names.data(), entries.size());
  append_each<std::uint8_t>(json_, entries, [](const DataEntry& entry, auto put) {
    put(entry.data && entry.data->kind == UserData::Kind::json);
  });
  begin_.append(begins.data(), begins.size());
  append_each<std::int64_t>(size_, entries, [](const DataEntry& entry, auto put) {
    put(entry.data ? static_cast<std::int64_t>(entry.data->bytes.size()) : -1);
  });
}

void UserDataTable::append_steps(std::span<const DataEntry> entries) {
  append_each<std::int64_t>(step_, entries,
                            [](const DataEntry& entry, auto put) { put(entry.now.collisions); });
}

Events::Events(hid_t file, bool has_kinds, const std::string& place)
    : time_(file, "/events/time", place),
      epoch_(file, "/events/epoch", place),
      offset_(file, "/events/offset", place),
      pair_(file, "/events/pair", place),
      arms_(file, "/events/arms", place),
      normal_velocity_(file, "/events/normal_velocity", place),
      tc_(file, "/events/tc", place),
      shift_(file, "/events/shift", place),
      impulse_(file, "/events/impulse", place) {
  if (has_kinds) kind_.emplace(file, "/events/kind", place);
}

void Events::append(std::span<const Happening> happenings) {
  const auto each = [&]<class Number>(Column& column, Number, auto numbers) {
    append_each<Number>(column, happenings, [&](const Happening& happening, auto put) {
      for (const auto number : numbers(happening.event)) put(number);
    });
  };
  const auto member = [&]<class Number>(Column& column, Number Collision::*member) {
    each(column, Number{}, [&](const Collision& event) { return std::array{event.*member}; });
  };
  const auto members = [&]<class Number>(Column& column, std::array<Number, 3> Collision::*member) {
    each(column, Number{}, [&](const Collision& event) { return event.*member; });
  };
  if (kind_) {
    append_each<std::uint8_t>(*kind_, happenings, [](const Happening& happening, auto put) {
      put(static_cast<std::uint8_t>(happening.kind));
    });
  }
  member(epoch_, &Collision::epoch);
  member(offset_, &Collision::offset);
  each(pair_, std::uint32_t{}, [](const Collision& event) {
    return std::array{event.first, event.second};
  });
  each(arms_, double{}, [](const Collision& event) {
    return std::array{event.arm_first, event.arm_second};
  });
  member(normal_velocity_, &Collision::normal_velocity);
  each(tc_, std::uint8_t{},
       [](const Collision& event) { return std::array{event.contact_time_rule}; });
  members(shift_, &Collision::shift);
  members(impulse_, &Collision::impulse);
}

void Events::append_times(std::span<const Happening> happenings) {
  append_each<double>(time_, happenings,
                      [](const Happening& happening, auto put) { put(happening.event.time); });
}

}  // namespace needlework::io
