#include "src/io/continuation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>
#include <vector>

#include "needlework/error.h"
#include "src/io/hdf5.h"
#include "src/io/layout.h"

namespace needlework::io {

using hdf5::check;
using hdf5::Handle;
using hdf5::Shape;

namespace {

bool grows(hid_t dataset, const std::string& place) {
  const Shape most = hdf5::greatest_shape_of(dataset, place);
  return !most.empty() && most[0] == H5S_UNLIMITED;
}

// Rows up to `position` of a dataset that grows.
std::uint64_t rows_at(const Writer::Position& position, const std::string& path) {
  if (path.starts_with("/events/")) return position.events;
  if (path.starts_with("/series/")) return position.samples;
  if (path.starts_with("/velocities_set/")) return position.velocities_set;
  if (path == "/user_data/bytes") return position.data_bytes;
  return path.starts_with("/user_data/") ? position.data : position.frames;
}

// A row is complete if it is in these datasets.
bool marks_complete_rows(const std::string& path) {
  return path.ends_with("/step") || path == "/events/time";
}

// What does not belong to the trajectory may change between the parts of a run. Ids are written
// with the first frame, and compared on their own.
bool may_differ(const std::string& path) {
  constexpr std::array paths{"/parameters/isa", "/parameters/threads", "/parameters/version",
                             "/particles/needles/id"};
  return std::find(paths.begin(), paths.end(), path) != paths.end();
}

// The layout that the file must have, in memory.
Handle make_expected(const std::string& path, const Scene& scene, const RunInfo& run) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path);
  constexpr std::size_t increment = 1 << 16;
  check(H5Pset_fapl_core(access.get(), increment, false), path);
  check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110), path);
  // HDF5 reads a file of this name if there is one, but there is none below a file.
  const std::string name = path + "/expected";
  Handle file(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose, path);
  make_layout(file.get(), scene, run, path);
  return file;
}

// Compares the objects of two files.
class Comparison {
 public:
  Comparison(const Source& source, hid_t expected, const Writer::Position& position)
      : source_(source), expected_(expected), position_(position) {}

  void groups(const std::string& path) const;

 private:
  [[noreturn]] void fail(const std::string& path, const std::string& reason) const {
    throw InputError(fmt::format("{}: {}", source_.place(path), reason));
  }

  void objects(const std::string& path) const;
  void datasets(const std::string& path) const;
  void shapes(const std::string& path, const Shape& found, const Shape& expected) const;
  void values(const std::string& path, hid_t found, hid_t expected) const;
  void texts(const std::string& path, const std::string& found, const std::string& expected) const;
  template <class Number>
  void numbers(const std::string& path, hid_t found, hid_t expected) const;

  const Source& source_;
  hid_t expected_;
  const Writer::Position& position_;
};

void Comparison::groups(const std::string& path) const {
  const auto names = [&](hid_t file) {
    const Handle group = hdf5::open_group(file, path.empty() ? "/" : path, source_.place(path));
    return hdf5::children(group.get(), source_.place(path));
  };
  const std::vector<std::string> expected = names(expected_);
  for (const std::string& name : expected) objects(path + "/" + name);
  for (const std::string& name : names(source_.get())) {
    if (!std::binary_search(expected.begin(), expected.end(), name)) {
      fail(path + "/" + name, "expected nothing of this name in a file of this run");
    }
  }
}

void Comparison::objects(const std::string& path) const {
  const std::string place = source_.place(path);
  const bool group = hdf5::is_group(expected_, path, place);
  const bool same = group ? hdf5::is_group(source_.get(), path, place)
                          : hdf5::is_dataset(source_.get(), path, place);
  if (!same) {
    fail(path, fmt::format("missing: expected a {}, as in files of this run that needlework has "
                           "written",
                           group ? "group" : "dataset"));
  }
  group ? groups(path) : datasets(path);
}

void Comparison::datasets(const std::string& path) const {
  const std::string place = source_.place(path);
  const Handle found = hdf5::open_dataset(source_.get(), path, place);
  const Handle expected = hdf5::open_dataset(expected_, path, place);
  const Handle found_type(H5Dget_type(found.get()), H5Tclose, place);
  const Handle expected_type(H5Dget_type(expected.get()), H5Tclose, place);
  if (check(H5Tequal(found_type.get(), expected_type.get()), place) == 0) {
    fail(path,
         fmt::format("type {}: expected {}, in the form that needlework writes",
                     hdf5::type_name(found.get(), place), hdf5::type_name(expected.get(), place)));
  }
  Shape found_shape = hdf5::shape_of(found.get(), place);
  Shape expected_shape = hdf5::shape_of(expected.get(), place);
  if (!grows(expected.get(), place)) {
    shapes(path, found_shape, expected_shape);
    if (!may_differ(path)) values(path, found.get(), expected.get());
    return;
  }
  if (!grows(found.get(), place)) fail(path, "cannot grow: expected a dataset without a limit");
  if (found_shape.size() == expected_shape.size()) expected_shape[0] = found_shape[0];
  shapes(path, found_shape, expected_shape);
  // HDF5 takes a step for each chunk that is removed, also of those that were never written.
  source_.require_possible(found_shape[0], path);
  const std::uint64_t rows = rows_at(position_, path);
  if (found_shape[0] < rows) {
    fail(path, fmt::format("{} rows: expected at least {}, where the run is to be continued",
                           found_shape[0], rows));
  }
}

void Comparison::shapes(const std::string& path, const Shape& found, const Shape& expected) const {
  if (found == expected) return;
  fail(path,
       fmt::format("shape {}: expected {}", hdf5::to_string(found), hdf5::to_string(expected)));
}

void Comparison::values(const std::string& path, hid_t found, hid_t expected) const {
  const std::string place = source_.place(path);
  const Handle type(H5Dget_type(expected), H5Tclose, place);
  if (H5Tget_class(type.get()) == H5T_STRING) {
    const auto texts_of = [&](hid_t dataset) {
      return fmt::format("{}", fmt::join(hdf5::read_strings(dataset, place), "\n"));
    };
    texts(path, texts_of(found), texts_of(expected));
  } else if (H5Tget_class(type.get()) == H5T_FLOAT) {
    numbers<double>(path, found, expected);
  } else if (H5Tget_sign(type.get()) == H5T_SGN_NONE) {
    numbers<std::uint64_t>(path, found, expected);
  } else {
    numbers<std::int64_t>(path, found, expected);
  }
}

void Comparison::texts(const std::string& path, const std::string& found,
                       const std::string& expected) const {
  if (found == expected) return;
  std::istringstream found_lines(found), expected_lines(expected);
  std::string found_line, expected_line;
  for (int number = 1;; ++number) {
    const bool more = static_cast<bool>(std::getline(found_lines, found_line));
    const bool more_expected = static_cast<bool>(std::getline(expected_lines, expected_line));
    if (!more) found_line.clear();
    if (!more_expected) expected_line.clear();
    if (found_line == expected_line && more && more_expected) continue;
    fail(path, fmt::format("line {} = '{}': expected '{}'", number, found_line, expected_line));
  }
}

template <class Number>
void Comparison::numbers(const std::string& path, hid_t found, hid_t expected) const {
  const std::string place = source_.place(path);
  const auto read = [&](hid_t dataset) {
    const Handle space(H5Dget_space(dataset), H5Sclose, place);
    std::vector<Number> numbers(
        static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space.get()), place)));
    check(H5Dread(dataset, hdf5::type_of<Number>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
          place);
    return numbers;
  };
  const std::vector<Number> all_found = read(found), all_expected = read(expected);
  for (std::size_t i = 0; i < all_found.size(); ++i) {
    if (std::memcmp(&all_found[i], &all_expected[i], sizeof(Number)) == 0) continue;
    const std::string index =
        hdf5::shape_of(found, place).empty() ? "" : fmt::format(", value {}", i);
    fail(path + index, fmt::format("{}: expected {}", all_found[i], all_expected[i]));
  }
}

// Calls `action` with the path and the handle of each dataset below `group`.
template <class Action>
void for_each_dataset(hid_t file, const std::string& group, const std::string& place,
                      const Action& action) {
  const Handle opened = hdf5::open_group(file, group.empty() ? "/" : group, place);
  for (const std::string& name : hdf5::children(opened.get(), place)) {
    const std::string path = group + "/" + name;
    if (hdf5::is_group(file, path, place)) {
      for_each_dataset(file, path, place, action);
    } else {
      action(path, hdf5::open_dataset(file, path, place).get());
    }
  }
}

// Calls `action` with each dataset that has rows beyond `position`: its path, its handle, and the
// shape that it has at `position`.
template <class Action>
void for_each_beyond(hid_t file, const std::string& place, const Writer::Position& position,
                     const Action& action) {
  for_each_dataset(file, "", place, [&](const std::string& path, hid_t dataset) {
    if (!grows(dataset, place)) return;
    Shape shape = hdf5::shape_of(dataset, place);
    const std::uint64_t rows = rows_at(position, path);
    if (shape[0] <= rows) return;
    shape[0] = rows;
    action(path, dataset, shape);
  });
}

void require_ids(const Source& source, const std::vector<std::uint32_t>& expected) {
  const Element element(source, "/particles/needles/id");
  const auto found = element.read<std::uint32_t>(std::nullopt);
  for (std::size_t n = 0; n < std::min(found.size(), expected.size()); ++n) {
    if (found[n] == expected[n]) continue;
    throw InputError(fmt::format("{}, value {}: {}: expected {}, as in the run that is continued",
                                 source.place(element.name()), n, found[n], expected[n]));
  }
}

}  // namespace

void require_continuable(const Source& source, const Scene& scene, const RunInfo& run,
                         const Writer::Position& position) {
  if (position.events > 0 && !scene.output.events) {
    throw InputError(fmt::format("{}: missing: expected at least {} rows", source.place("/events"),
                                 position.events));
  }
  const Handle expected = make_expected(source.path(), scene, run);
  Comparison(source, expected.get(), position).groups("");
  if (position.frames > 0) require_ids(source, run.ids);
}

// First the datasets that make rows complete, so that no row is complete of which a part is gone.
// `step` comes before `time`, because there may not be more steps than times.
void shorten(OutputFile& file, const std::string& place, const Writer::Position& position) {
  file.start_shortening();
  for (const bool markers : {true, false}) {
    for_each_beyond(file.get(), place, position,
                    [&](const std::string& path, hid_t dataset, const Shape& shape) {
                      if (marks_complete_rows(path) != markers) return;
                      check(H5Dset_extent(dataset, shape.data()), place);
                    });
    file.flush();
  }
  file.close();
}

}  // namespace needlework::io
