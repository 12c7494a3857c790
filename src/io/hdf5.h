// A small layer over the HDF5 C API: handles that close themselves, failures that become IoError.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace needlework::io::hdf5 {

/// Exists while this library uses HDF5. Two things follow from it:
///
/// - One thread at a time uses HDF5, because not every build of HDF5 allows more. Sessions of
///   different threads wait for each other; one thread may open a session within a session.
/// - The caller's error handling stays as it was. During a session HDF5 calls no error handler, so
///   that failures are reported by exceptions only. The end of the outermost session restores the
///   error handler of the caller, its client data and the errors on the caller's error stack.
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};

/// Why the last HDF5 call failed, in one line: the operating system's reason where there is one,
/// else the innermost message of HDF5's error stack.
std::string last_error();

/// Throws IoError "PLACE: last_error()". `place` begins with the name of the file.
[[noreturn]] void fail(const std::string& place);

/// Passes the result of an HDF5 call on; a negative one is a failure.
template <class Result>
Result check(Result result, const std::string& place) {
  if (result < 0) fail(place);
  return result;
}

/// Owns one HDF5 identifier. Closing is silent; call close() where a failure matters.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle() = default;
  /// Takes `id`, which must come from a function that `closer` belongs to; see fail() for `place`.
  Handle(hid_t id, Close closer, const std::string& place)
      : id_(check(id, place)), close_(closer) {}
  Handle(Handle&& other) noexcept;
  Handle& operator=(Handle&& other) noexcept;
  ~Handle() { release(); }

  hid_t get() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }
  void close(const std::string& place);

 private:
  herr_t release() noexcept;

  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

using Shape = std::vector<hsize_t>;

/// "[2][100][3]", or "[]" for a scalar.
std::string to_string(const Shape& shape);

/// The HDF5 type of a C++ number in memory and, as it is, in files.
template <class T>
hid_t type_of();
template <>
inline hid_t type_of<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
inline hid_t type_of<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}
template <>
inline hid_t type_of<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
template <>
inline hid_t type_of<std::uint32_t>() {
  return H5T_NATIVE_UINT32;
}
template <>
inline hid_t type_of<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
inline hid_t type_of<std::uint64_t>() {
  return H5T_NATIVE_UINT64;
}

/// Properties of this kind (H5P_GROUP_CREATE and so on) with which an object does not keep the time
/// of its making, so that the same content makes the same file.
Handle without_times(hid_t kind, const std::string& place);

/// A dataset without values.
Handle create_dataset(hid_t parent, const std::string& name, hid_t type, hid_t space,
                      const std::string& place);

Handle create_group(hid_t parent, const std::string& name, const std::string& place);
Handle open_group(hid_t parent, const std::string& name, const std::string& place);
Handle open_dataset(hid_t parent, const std::string& name, const std::string& place);

/// A fixed-length string attribute (as H5MD wants them), or one of several strings of one length.
void write_attribute(hid_t object, const std::string& name, const std::string& value,
                     const std::string& place);
void write_attribute(hid_t object, const std::string& name, std::span<const std::string> values,
                     const std::string& place);
/// Whole numbers; without `dimensions` a scalar.
void write_attribute(hid_t object, const std::string& name, std::span<const std::int32_t> values,
                     const Shape& dimensions, const std::string& place);

/// A scalar dataset.
template <class T>
void write_scalar(hid_t group, const std::string& name, T value, const std::string& place);
/// A scalar dataset of a variable-length UTF-8 string.
void write_scalar(hid_t group, const std::string& name, const std::string& value,
                  const std::string& place);

/// A dataset of this shape, values in C order.
template <class T>
void write_array(hid_t group, const std::string& name, const Shape& shape,
                 std::span<const T> values, const std::string& place);

/// A dataset [n] of variable-length UTF-8 strings.
void write_array(hid_t group, const std::string& name, std::span<const std::string> values,
                 const std::string& place);

Shape shape_of(hid_t dataset, const std::string& place);

/// Whether `path`, relative to `object`, leads to something, each link on the way included.
bool exists(hid_t object, const std::string& path, const std::string& place);
/// Names of the links in a group, in alphabetical order.
std::vector<std::string> children(hid_t group, const std::string& place);
bool is_group(hid_t parent, const std::string& name, const std::string& place);
bool is_dataset(hid_t parent, const std::string& name, const std::string& place);

/// The strings of an attribute or of a dataset of any shape, of fixed or variable length.
std::vector<std::string> read_strings_attribute(hid_t object, const std::string& name,
                                                const std::string& place);
std::vector<std::string> read_strings(hid_t dataset, const std::string& place);

template <class T>
void write_scalar(hid_t group, const std::string& name, T value, const std::string& place) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, place);
  const Handle dataset = create_dataset(group, name, type_of<T>(), space.get(), place);
  check(H5Dwrite(dataset.get(), type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &value), place);
}

template <class T>
void write_array(hid_t group, const std::string& name, const Shape& shape,
                 std::span<const T> values, const std::string& place) {
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                     H5Sclose, place);
  const Handle dataset = create_dataset(group, name, type_of<T>(), space.get(), place);
  if (values.empty()) return;
  check(H5Dwrite(dataset.get(), type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), place);
}

}  // namespace needlework::io::hdf5
