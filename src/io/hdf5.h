// A thin layer over the C interface of HDF5. Handles close themselves, and failures throw IoError.
#pragma once

#include <hdf5.h>
#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "src/machine/descriptors.h"

namespace needlework::io::hdf5 {

/// Exists while this library uses HDF5. It has these effects:
///
/// - One thread at a time uses HDF5, because not every build of HDF5 allows more. Sessions of
///   different threads wait for each other; one thread may open a session within a session.
/// - The caller's error handling stays as it was. During a session HDF5 calls no error handler, so
///   that failures are reported by exceptions only. The end of the outermost session restores the
///   error handler of the caller, its client data and the errors on the caller's error stack.
/// - No plugin is loaded: a file that names a filter which HDF5 does not have is refused instead.
///   The end of the outermost session restores the caller's choice.
/// - No file gets the descriptor of standard input, output or error.
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  std::unique_lock<std::recursive_mutex> lock_;
  StandardDescriptors occupied_;
};

/// Calls `child` in a new process, which ends when that returns or throws, and returns the number
/// of the process in this one, or -1 with errno. In the new process HDF5 can be used: the fork
/// waits until no other thread uses it, also threads of the caller that know nothing of sessions.
pid_t fork_process(const std::function<void()>& child);

/// The reason why the last HDF5 call failed, in one line: the message of the operating system if
/// there is one, and otherwise the innermost message on the error stack of HDF5.
std::string last_error();
/// The message of the operating system, or empty if it was not a system call that failed.
std::string last_system_error();

/// Throws IoError with the message "PLACE: REASON", where REASON is last_error(). `place` begins
/// with the name of the file.
[[noreturn]] void fail(const std::string& place);

/// Returns the result of an HDF5 call, or throws IoError if the result is negative, which means
/// that the call failed.
template <class Result>
Result check(Result result, const std::string& place) {
  if (result < 0) fail(place);
  return result;
}

/// Owns one HDF5 identifier. The destructor ignores failures; call close() where they matter.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle() = default;
  /// Takes ownership of `id`, which `closer` must be able to close. See fail() for `place`.
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

/// The HDF5 type of a C++ number, both in memory and in files.
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

/// Creation properties of this kind (H5P_GROUP_CREATE and so on) with which an object does not
/// store the time of its creation, so that files with the same content have the same bytes.
Handle without_times(hid_t kind, const std::string& place);

/// Creates a dataset without writing values.
Handle create_dataset(hid_t parent, const std::string& name, hid_t type, hid_t space,
                      const std::string& place);

Handle create_group(hid_t parent, const std::string& name, const std::string& place);
/// Links into other files are not followed: see exists().
Handle open_group(hid_t parent, const std::string& name, const std::string& place);
/// Throws InputError for a dataset whose values are in other files, and for one that is stored with
/// a filter which HDF5 does not have.
Handle open_dataset(hid_t parent, const std::string& name, const std::string& place);
/// An object of any kind, of which only attributes are to be read.
Handle open_object(hid_t parent, const std::string& name, const std::string& place);

/// Writes an attribute of fixed-length strings, which H5MD demands: one string, or several, of
/// which the longest gives the length.
void write_attribute(hid_t object, const std::string& name, const std::string& value,
                     const std::string& place);
void write_attribute(hid_t object, const std::string& name, std::span<const std::string> values,
                     const std::string& place);
/// Writes an attribute of integers, a scalar if `dimensions` is empty.
void write_attribute(hid_t object, const std::string& name, std::span<const std::int32_t> values,
                     const Shape& dimensions, const std::string& place);

/// Writes an attribute that is one number.
void write_attribute(hid_t object, const std::string& name, double value, const std::string& place);

/// Writes an attribute that is one variable-length UTF-8 string.
void write_text_attribute(hid_t object, const std::string& name, const std::string& text,
                          const std::string& place);

/// Writes a scalar dataset.
template <class T>
void write_scalar(hid_t group, const std::string& name, T value, const std::string& place);
/// Writes a scalar dataset that is one variable-length UTF-8 string.
void write_scalar(hid_t group, const std::string& name, const std::string& value,
                  const std::string& place);

/// Writes a dataset of this shape, with the values in C order.
template <class T>
void write_array(hid_t group, const std::string& name, const Shape& shape,
                 std::span<const T> values, const std::string& place);

/// Writes a dataset [n] of variable-length UTF-8 strings.
void write_array(hid_t group, const std::string& name, std::span<const std::string> values,
                 const std::string& place);

/// "float64", "uint8", "string" or "other".
std::string type_name(hid_t dataset, const std::string& place);
Shape shape_of(hid_t dataset, const std::string& place);
/// The extents that a dataset may grow to, H5S_UNLIMITED if there is no limit.
Shape greatest_shape_of(hid_t dataset, const std::string& place);

/// A number that is the same for all paths to one object of a file.
std::uint64_t number_of(hid_t parent, const std::string& name, const std::string& place);

/// Whether a file of this size can hold a dataset or an attribute of at least so many bytes, even
/// compressed.
bool is_possible_size(std::uint64_t bytes, std::uint64_t file_bytes);

/// Whether an object exists at `path`, relative to `object`. Broken links count as absent, and so
/// do links into other files, which nothing here follows: a file must not make the program open
/// another one.
bool exists(hid_t object, const std::string& path, const std::string& place);
/// Why nothing exists at `path`: "missing", or that it is a link into another file.
std::string why_absent(hid_t object, const std::string& path, const std::string& place);
/// The names of the links in a group, in alphabetical order.
std::vector<std::string> children(hid_t group, const std::string& place);
/// Paths of all datasets of a file in the order of paths, by hard links alone.
std::vector<std::string> datasets(hid_t file, const std::string& place);
bool is_group(hid_t parent, const std::string& name, const std::string& place);
bool is_dataset(hid_t parent, const std::string& name, const std::string& place);

/// Reads all strings, of fixed or variable length, of an attribute or dataset of any shape.
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
