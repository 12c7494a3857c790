#include "src/io/source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <system_error>
#include <type_traits>

#include "needlework/error.h"
#include "src/io/write_lock.h"
#include "src/machine/descriptors.h"

namespace needlework::io {

using hdf5::check;
using hdf5::Handle;
using hdf5::Shape;

namespace {

// The number of elements, or the largest number if there are more.
std::uint64_t product(const Shape& shape, std::size_t first) {
  std::uint64_t out = 1;
  for (std::size_t n = first; n < shape.size(); ++n) {
    if (__builtin_mul_overflow(out, shape[n], &out)) {
      const bool empty = std::count(shape.begin(), shape.end(), hsize_t{0}) > 0;
      return empty ? 0 : std::numeric_limits<std::uint64_t>::max();
    }
  }
  return out;
}

// In SWMR mode (single writer, multiple readers) HDF5 looks beyond the size that the file had when
// it was opened, and reads a block of metadata again whose checksum is wrong, as it can be in the
// middle of a write. It waits between these attempts, twice as long each time: 20 take about 1 ms,
// and the 100 that are its default never end. A reader that was kept waiting while it opened the
// file can find the file longer than its size was, and tries again. Without the mode if this
// process has opened it without.
hid_t open_growing(const std::string& path, const Handle& access) {
  check(H5Pset_metadata_read_attempts(access.get(), 20), path);
  hid_t file = H5I_INVALID_HID;
  for (int attempt = 0; attempt < 3 && file < 0; ++attempt) {
    if (attempt > 0) usleep(1000);
    file = H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access.get());
  }
  if (file < 0) return H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get());
  // In this mode HDF5 1.14 opens files that are cut short, too.
  haddr_t end = 0;
  check(H5Fget_eoa(file, &end), path);
  const std::uintmax_t bytes = std::filesystem::file_size(path);
  if (end > bytes) {
    H5Fclose(file);
    throw IoError(
        fmt::format("{}: damaged or cut short: HDF5: {} bytes of {} are there", path, bytes, end));
  }
  return file;
}

[[noreturn]] void fail_to_open(const std::string& path, const LockState& locks) {
  const std::string reason = hdf5::last_system_error();
  if (reason.empty()) {
    throw IoError(fmt::format("{}: damaged or cut short: {}", path, hdf5::last_error()));
  }
  if (locks.hdf5_can_lock) throw IoError(fmt::format("{}: cannot be read: {}", path, reason));
  throw IoError(
      fmt::format("{}: cannot be read: {}: expected HDF5_USE_FILE_LOCKING=FALSE, or none, where "
                  "HDF5 cannot lock files",
                  path, reason));
}

// HDF5 is not to lock where it cannot. What HDF5_USE_FILE_LOCKING says counts more for HDF5.
hid_t open_for_reading(const std::string& path, const LockState& locks) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path);
  if (!locks.hdf5_can_lock) check(H5Pset_file_locking(access.get(), false, true), path);
  const hid_t file = locks.may_grow ? open_growing(path, access)
                                    : H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get());
  if (file < 0) fail_to_open(path, locks);  // before another call replaces the error
  return file;
}

}  // namespace

Source::Source(const std::string& path) : path_(path) {
  const auto fail = [&](int error) {
    throw IoError(fmt::format("{}: {}", path_, std::generic_category().message(error)));
  };
  // With O_NONBLOCK, open does not wait for a writer if the file is a pipe.
  const int descriptor = open_descriptor(path, O_RDONLY | O_NONBLOCK);
  if (descriptor < 0) fail(errno);
  struct stat status;
  const int error = fstat(descriptor, &status) == 0 ? 0 : errno;
  const LockState locks = lock_state(descriptor);
  close(descriptor);
  if (error != 0) fail(error);
  if (S_ISDIR(status.st_mode)) fail(EISDIR);
  if (!S_ISREG(status.st_mode)) throw IoError(path + ": not a regular file");
  bytes_ = static_cast<std::uint64_t>(status.st_size);

  if (H5Fis_hdf5(path.c_str()) <= 0) throw IoError(path + ": not an HDF5 file");
  file_ = Handle(open_for_reading(path, locks), H5Fclose, path);
  if (locks.may_grow) hold_datasets();
}

// A dataset keeps its number of rows while it is open. When one that was closed is opened again,
// HDF5 reads again only what has left its cache: a new number of rows with an old index of chunks
// gives rows of zeros. The numbers of complete rows are read first, even before the others are
// listed: all else has as many rows by then, or more.
void Source::hold_datasets() {
  const auto hold = [&](const std::string& path) {
    held_.push_back(hdf5::open_dataset(get(), path, place(path)));
  };
  for (const std::string counts :
       {"/particles/needles/position/step", "/series/step", "/events/time"}) {
    if (hdf5::is_dataset(get(), counts, place(counts))) hold(counts);
  }
  for (const std::string& path : hdf5::datasets(get(), path_)) hold(path);
}

void Source::require_possible(std::uint64_t numbers, const std::string& dataset) const {
  if (hdf5::is_possible_size(numbers, bytes_)) return;  // of one byte each
  throw InputError(fmt::format("{}: {} numbers: expected fewer in a file of {} bytes",
                               place(dataset), numbers, bytes_));
}

Element::Element(const Source& source, const std::string& path)
    : source_(&source),
      path_(path),
      is_group_(hdf5::is_group(source.get(), path, source.place(path))) {
  name_ = is_group_ ? path + "/value" : path;
  const std::string place = source.place(name_);
  if (!hdf5::is_dataset(source.get(), name_, place)) {
    throw InputError(fmt::format("{}: {}: expected a dataset", place,
                                 hdf5::why_absent(source.get(), name_, place)));
  }
  value_ = hdf5::open_dataset(source.get(), name_, place);
  const Handle type(H5Dget_type(value_.get()), H5Tclose, place);
  if (const H5T_class_t kind = H5Tget_class(type.get()); kind != H5T_FLOAT && kind != H5T_INTEGER) {
    throw InputError(
        fmt::format("{}: the values are not numbers: expected floating point or integers", place));
  }
  shape_ = hdf5::shape_of(value_.get(), place);
  rows_ = shape_.empty() ? 0 : shape_[0];
  source.require_possible(product(shape_, 0), name_);
  if (!is_group_) return;

  steps_ = read_grid<std::int64_t>("step");
  if (!steps_) return;
  if (steps_->size() > rows_) {
    throw InputError(fmt::format("{}: {} steps: expected {}, one for each row of {}",
                                 source.place(path_ + "/step"), steps_->size(), rows_, name_));
  }
  rows_ = steps_->size();
  const auto back = std::adjacent_find(steps_->begin(), steps_->end(), std::greater<>());
  if (back != steps_->end()) {
    throw InputError(fmt::format("{}[{}] = {}: expected {} or more, which is the step before it",
                                 source.place(path_ + "/step"), back - steps_->begin() + 1, back[1],
                                 back[0]));
  }
}

std::optional<std::vector<double>> Element::times() const {
  auto times = read_grid<double>("time");
  if (times) times->resize(std::min<std::size_t>(times->size(), rows_));
  return times;
}

// H5MD allows either one step and time for each row, or a scalar increment with an offset.
template <class Number>
std::optional<std::vector<Number>> Element::read_grid(const char* name) const {
  const std::string path = path_ + "/" + name;
  const std::string place = source_->place(path);
  if (!hdf5::is_dataset(source_->get(), path, place)) return {};
  const Handle dataset = hdf5::open_dataset(source_->get(), path, place);
  const Shape shape = hdf5::shape_of(dataset.get(), place);
  if (shape.size() > 1) {
    throw InputError(fmt::format("{}: shape {}: expected one number for each row", place,
                                 hdf5::to_string(shape)));
  }
  const hid_t type = hdf5::type_of<Number>();
  source_->require_possible(product(shape, 0), path);
  std::vector<Number> values(product(shape, 0));
  check(H5Dread(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), place);
  if (!shape.empty()) return values;

  Number offset = 0;
  if (check(H5Aexists(dataset.get(), "offset"), place) > 0) {
    const Handle attribute(H5Aopen(dataset.get(), "offset", H5P_DEFAULT), H5Aclose, place);
    check(H5Aread(attribute.get(), type, &offset), place);
  }
  const Number increment = values[0];
  values.resize(shape_.empty() ? 0 : shape_[0]);
  for (std::size_t row = 0; row < values.size(); ++row) {
    const auto number = static_cast<Number>(row);
    if constexpr (std::is_integral_v<Number>) {
      Number product = 0;
      if (__builtin_mul_overflow(number, increment, &product) ||
          __builtin_add_overflow(offset, product, &values[row])) {
        throw InputError(fmt::format("{}: {} + {} x {}: expected a number of 64 bits", place,
                                     offset, row, increment));
      }
    } else {
      values[row] = offset + number * increment;
    }
  }
  return values;
}

std::size_t Element::size(std::optional<hsize_t> row) const { return product(shape_, row ? 1 : 0); }

void Element::read_as(hid_t type, std::optional<hsize_t> row, void* values) const {
  if (size(row) == 0) return;
  const std::string place = source_->place(name_);
  if (!row) {
    check(H5Dread(value_.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), place);
    return;
  }
  Shape start(shape_.size(), 0);
  start[0] = *row;
  Shape block = shape_;
  block[0] = 1;
  const Handle in_file(H5Dget_space(value_.get()), H5Sclose, place);
  check(H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(), nullptr, block.data(),
                            nullptr),
        place);
  const Handle in_memory(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr),
                         H5Sclose, place);
  check(H5Dread(value_.get(), type, in_memory.get(), in_file.get(), H5P_DEFAULT, values), place);
}

std::string find_particles(const Source& source) {
  const std::string root = "/particles";
  const std::string place = source.place(root);
  if (!hdf5::is_group(source.get(), root, place)) {
    throw InputError(fmt::format("{}: {}: expected a group, as in H5MD files", place,
                                 hdf5::why_absent(source.get(), root, place)));
  }
  if (hdf5::is_group(source.get(), root + "/needles", place)) return root + "/needles";
  const Handle group = hdf5::open_group(source.get(), root, place);
  std::vector<std::string> names = hdf5::children(group.get(), place);
  std::erase_if(names,
                [&](const std::string& name) { return !hdf5::is_group(group.get(), name, place); });
  if (names.size() != 1) {
    throw InputError(fmt::format("{}: {} groups{}{}: expected one, or one named needles", place,
                                 names.size(), names.empty() ? "" : ": ", fmt::join(names, ", ")));
  }
  return root + "/" + names[0];
}

}  // namespace needlework::io
