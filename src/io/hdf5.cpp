#include "src/io/hdf5.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <optional>
#include <utility>

#include "needlework/error.h"

namespace needlework::io::hdf5 {
namespace {

// The error handling of the caller, from its construction to restore(). HDF5 has two kinds of error
// handlers, and a handler of one kind cannot be read or set by the functions of the other. None of
// the functions used here clears the error stack.
class CallerErrors {
 public:
  CallerErrors() : stack_(H5Eget_current_stack()) {
#ifndef H5_NO_DEPRECATED_SYMBOLS
    H5Eauto_is_v2(H5E_DEFAULT, &is_v2_);
    if (!is_v2_) {
      H5Eget_auto1(&handler_v1_, &data_);
      H5Eset_auto1(nullptr, nullptr);
      return;
    }
#endif
    H5Eget_auto2(H5E_DEFAULT, &handler_v2_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }

  void restore() {
    if (stack_ >= 0) H5Eset_current_stack(stack_);  // closes stack_ too
#ifndef H5_NO_DEPRECATED_SYMBOLS
    if (!is_v2_) {
      H5Eset_auto1(handler_v1_, data_);
      return;
    }
#endif
    H5Eset_auto2(H5E_DEFAULT, handler_v2_, data_);
  }

 private:
  hid_t stack_;
#ifndef H5_NO_DEPRECATED_SYMBOLS
  unsigned is_v2_ = 1;
  H5E_auto1_t handler_v1_ = nullptr;
#endif
  H5E_auto2_t handler_v2_ = nullptr;
  void* data_ = nullptr;
};

// Whether HDF5 loads plugins, as it was at the construction.
class CallerPlugins {
 public:
  CallerPlugins() {
    if (H5PLget_loading_state(&kinds_) < 0) kinds_ = H5PL_ALL_PLUGIN;
    H5PLset_loading_state(0);
  }
  void restore() { H5PLset_loading_state(kinds_); }

 private:
  unsigned kinds_ = 0;
};

struct Caller {
  CallerErrors errors;
  CallerPlugins plugins;
};

// What the sessions of the process share. The mutex protects the other members.
struct Shared {
  std::recursive_mutex mutex;
  int sessions = 0;  // open ones, all of the thread that holds the mutex
  std::optional<Caller> caller;
};

Shared*& shared_pointer() {
  static Shared* shared = new Shared;
  return shared;
}

Shared& shared() { return *shared_pointer(); }

// What fork_process() passes through HDF5.
struct Fork {
  const std::function<void()>& child;
  pid_t process = -1;
  int error = ENOSYS;
};

herr_t fork_in_callback(hid_t, const char*, void* data) {
  Fork& request = *static_cast<Fork*>(data);
  request.process = fork();
  request.error = errno;
  if (request.process != 0) return 1;
  // The mutex is that of a thread that does not exist here.
  shared_pointer() = new Shared;
  try {
    request.child();
  } catch (...) {
    std::terminate();
  }
  _exit(0);
}

herr_t keep_innermost(unsigned depth, const H5E_error2_t* error, void* text) {
  if (depth == 0 && error->desc) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

std::string innermost_error() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &text);
  return text;
}

// The text that HDF5 reports for a failed system call has several lines. It contains the reason as
// "error message = 'REASON', buf = ...".
std::string system_reason(const std::string& text) {
  const std::string mark = "error message = '";
  const auto mark_at = text.find(mark);
  if (mark_at == std::string::npos) return {};
  const auto begin = mark_at + mark.size();
  const auto end = text.find('\'', begin);
  return end == std::string::npos ? std::string() : text.substr(begin, end - begin);
}

std::vector<std::string> split_fixed(const std::vector<char>& bytes, std::size_t length) {
  std::vector<std::string> strings;
  for (std::size_t at = 0; at + length <= bytes.size(); at += length) {
    std::string text(bytes.data() + at, length);
    strings.push_back(text.substr(0, text.find('\0')));
  }
  return strings;
}

// Before memory is taken for them; see Source::require_possible().
void require_possible_strings(hid_t object, std::size_t count, std::size_t length,
                              const std::string& place) {
  const Handle file(H5Iget_file_id(object), H5Fclose, place);
  hsize_t file_bytes = 0;
  check(H5Fget_filesize(file.get(), &file_bytes), place);
  std::size_t bytes = 0;
  const bool too_many = __builtin_mul_overflow(count, length, &bytes);
  if (!too_many && is_possible_size(bytes, file_bytes)) return;
  throw InputError(fmt::format("{}: {} texts of {} bytes: expected fewer in a file of {} bytes",
                               place, count, length, file_bytes));
}

// Reads strings by calling `read(memory_type, buffer)`, because HDF5 has different functions for
// attributes and datasets.
template <class Read>
std::vector<std::string> read_strings_with(hid_t object, hid_t type, hid_t space,
                                           const std::string& place, Read read) {
  if (H5Tget_class(type) != H5T_STRING) return {};
  const auto count = static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space), place));
  const Handle memory(H5Tcopy(type), H5Tclose, place);
  require_possible_strings(object, count, std::max(H5Tget_size(type), sizeof(char*)), place);
  if (check(H5Tis_variable_str(type), place) == 0) {
    const std::size_t length = H5Tget_size(type);
    std::vector<char> bytes(count * length);
    check(read(memory.get(), bytes.data()), place);
    return split_fixed(bytes, length);
  }
  std::vector<char*> pointers(count, nullptr);
  check(read(memory.get(), pointers.data()), place);
  std::vector<std::string> strings;
  strings.reserve(count);
  for (const char* pointer : pointers) strings.emplace_back(pointer ? pointer : "");
  check(H5Dvlen_reclaim(memory.get(), space, H5P_DEFAULT, pointers.data()), place);
  return strings;
}

herr_t refuse_link(const char*, const char*, const char*, const char*, unsigned*, hid_t, void*) {
  return -1;
}

// Access properties of this kind (H5P_LINK_ACCESS or what is derived from it) with which no link is
// followed into another file, neither directly nor by way of a soft link.
Handle within_file(hid_t kind, const std::string& place) {
  Handle properties(H5Pcreate(kind), H5Pclose, place);
  check(H5Pset_elink_cb(properties.get(), refuse_link, nullptr), place);
  return properties;
}

H5I_type_t kind_of(hid_t parent, const std::string& name, const std::string& place) {
  return H5Iget_type(open_object(parent, name, place).get());
}

H5L_type_t type_of_link(hid_t parent, const std::string& name, const std::string& place) {
  const Handle access = within_file(H5P_LINK_ACCESS, place);
  H5L_info_t info;
  check(H5Lget_info(parent, name.c_str(), &info, access.get()), place);
  return info.type;
}

// Throws InputError unless the values are in the file itself, and can be read. To be called before
// HDF5 is asked for the shape: for that of a virtual dataset it opens other files.
void require_own_values(hid_t dataset, const std::string& place) {
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose, place);
  const bool is_virtual = H5Pget_layout(creation.get()) == H5D_VIRTUAL;
  if (is_virtual || H5Pget_external_count(creation.get()) > 0) {
    throw InputError(place +
                     ": a dataset whose values are in other files: expected them in the file "
                     "itself");
  }
  const int filters = H5Pget_nfilters(creation.get());
  for (int n = 0; n < filters; ++n) {
    unsigned flags = 0, settings = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter =
        check(H5Pget_filter2(creation.get(), static_cast<unsigned>(n), &flags, &values, nullptr, 0,
                             nullptr, &settings),
              place);
    if (H5Zfilter_avail(filter) > 0) continue;
    throw InputError(fmt::format(
        "{}: stored with filter {} of HDF5, for which a plugin would be needed: expected gzip or "
        "another filter that HDF5 itself has (h5repack can change it)",
        place, static_cast<int>(filter)));
  }
}

}  // namespace

Session::Session() : lock_(shared().mutex) {
  if (shared().sessions++ == 0) shared().caller.emplace();
}

Session::~Session() {
  if (--shared().sessions > 0) return;
  shared().caller->plugins.restore();
  shared().caller->errors.restore();
  shared().caller.reset();
}

// HDF5 locks its mutex, if it has one, while it calls a function of the caller, and the new process
// inherits the lock along with its owner, this thread. A fork outside of a callback could leave the
// new process with a mutex that is locked by another thread, which does not exist there.
pid_t fork_process(const std::function<void()>& child) {
  const Session session;
  const Handle properties(H5Pcreate(H5P_LINK_ACCESS), H5Pclose, "fork");
  Fork request{.child = child};
  int first = 0;
  H5Piterate(properties.get(), &first, fork_in_callback, &request);
  errno = request.error;
  return request.process;
}

bool is_possible_size(std::uint64_t bytes, std::uint64_t file_bytes) {
  // Deflate shrinks nothing by more than a factor of 1032. Small datasets may be left out of a file
  // altogether, which then stand for zeros.
  constexpr std::uint64_t most_per_byte = 1032, always = std::uint64_t{1} << 23;
  return bytes <= always || bytes / most_per_byte <= file_bytes;
}

std::string last_system_error() { return system_reason(innermost_error()); }

std::string last_error() {
  std::string text = innermost_error();
  if (std::string reason = system_reason(text); !reason.empty()) return reason;
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "unknown HDF5 error" : "HDF5: " + text;
}

void fail(const std::string& place) { throw IoError(fmt::format("{}: {}", place, last_error())); }

Handle::Handle(Handle&& other) noexcept
    : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}

Handle& Handle::operator=(Handle&& other) noexcept {
  if (this != &other) {
    release();
    id_ = std::exchange(other.id_, H5I_INVALID_HID);
    close_ = other.close_;
  }
  return *this;
}

void Handle::close(const std::string& place) {
  const Session session;
  check(release(), place);
}

herr_t Handle::release() noexcept {
  const hid_t id = std::exchange(id_, H5I_INVALID_HID);
  if (id < 0) return 0;
  const Session session;
  return close_(id);
}

std::string to_string(const Shape& shape) {
  if (shape.empty()) return "[]";
  std::string text;
  for (const hsize_t extent : shape) text += fmt::format("[{}]", extent);
  return text;
}

Handle without_times(hid_t kind, const std::string& place) {
  Handle properties(H5Pcreate(kind), H5Pclose, place);
  check(H5Pset_obj_track_times(properties.get(), false), place);
  return properties;
}

Handle create_dataset(hid_t parent, const std::string& name, hid_t type, hid_t space,
                      const std::string& place) {
  const Handle timeless = without_times(H5P_DATASET_CREATE, place);
  return {H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, timeless.get(), H5P_DEFAULT),
          H5Dclose, place};
}

Handle create_group(hid_t parent, const std::string& name, const std::string& place) {
  const Handle timeless = without_times(H5P_GROUP_CREATE, place);
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, timeless.get(), H5P_DEFAULT), H5Gclose,
          place};
}

Handle open_group(hid_t parent, const std::string& name, const std::string& place) {
  const Handle access = within_file(H5P_GROUP_ACCESS, place);
  return {H5Gopen2(parent, name.c_str(), access.get()), H5Gclose, place};
}

Handle open_dataset(hid_t parent, const std::string& name, const std::string& place) {
  const Handle access = within_file(H5P_DATASET_ACCESS, place);
  Handle dataset(H5Dopen2(parent, name.c_str(), access.get()), H5Dclose, place);
  require_own_values(dataset.get(), place);
  return dataset;
}

Handle open_object(hid_t parent, const std::string& name, const std::string& place) {
  const Handle access = within_file(H5P_LINK_ACCESS, place);
  return {H5Oopen(parent, name.c_str(), access.get()), H5Oclose, place};
}

std::uint64_t number_of(hid_t parent, const std::string& name, const std::string& place) {
  hobj_ref_t reference = 0;
  check(H5Rcreate(&reference, parent, name.c_str(), H5R_OBJECT, -1), place);
  return reference;
}

void write_attribute(hid_t object, const std::string& name, const std::string& value,
                     const std::string& place) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, place);
  check(H5Tset_size(type.get(), std::max<std::size_t>(value.size(), 1)), place);
  check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), place);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, place);
  const Handle attribute(
      H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
      place);
  check(H5Awrite(attribute.get(), type.get(), value.c_str()), place);
}

void write_attribute(hid_t object, const std::string& name, std::span<const std::string> values,
                     const std::string& place) {
  std::size_t longest = 1;
  for (const std::string& value : values) longest = std::max(longest, value.size());
  std::string bytes;
  for (const std::string& value : values) {
    bytes += value;
    bytes.append(longest - value.size(), '\0');
  }
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, place);
  check(H5Tset_size(type.get(), longest), place);
  check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), place);
  const hsize_t count = values.size();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose, place);
  const Handle attribute(
      H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
      place);
  check(H5Awrite(attribute.get(), type.get(), bytes.data()), place);
}

void write_attribute(hid_t object, const std::string& name, double value,
                     const std::string& place) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, place);
  const Handle attribute(
      H5Acreate2(object, name.c_str(), type_of<double>(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, place);
  check(H5Awrite(attribute.get(), type_of<double>(), &value), place);
}

void write_attribute(hid_t object, const std::string& name, std::span<const std::int32_t> values,
                     const Shape& dimensions, const std::string& place) {
  const hid_t space_id = dimensions.empty() ? H5Screate(H5S_SCALAR)
                                            : H5Screate_simple(static_cast<int>(dimensions.size()),
                                                               dimensions.data(), nullptr);
  const Handle space(space_id, H5Sclose, place);
  const Handle attribute(
      H5Acreate2(object, name.c_str(), H5T_NATIVE_INT32, space.get(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, place);
  check(H5Awrite(attribute.get(), H5T_NATIVE_INT32, values.data()), place);
}

namespace {

Handle text_type(const std::string& place) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, place);
  check(H5Tset_size(type.get(), H5T_VARIABLE), place);
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), place);
  return type;
}

void write_strings(hid_t group, const std::string& name, const Handle& space,
                   std::span<const std::string> values, const std::string& place) {
  const Handle type = text_type(place);
  const Handle dataset = create_dataset(group, name, type.get(), space.get(), place);
  std::vector<const char*> texts;
  for (const std::string& value : values) texts.push_back(value.c_str());
  check(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()), place);
}

}  // namespace

void write_text_attribute(hid_t object, const std::string& name, const std::string& text,
                          const std::string& place) {
  const Handle type = text_type(place);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, place);
  const Handle attribute(
      H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
      place);
  const char* const pointer = text.c_str();
  check(H5Awrite(attribute.get(), type.get(), &pointer), place);
}

void write_scalar(hid_t group, const std::string& name, const std::string& value,
                  const std::string& place) {
  write_strings(group, name, Handle(H5Screate(H5S_SCALAR), H5Sclose, place), {&value, 1}, place);
}

void write_array(hid_t group, const std::string& name, std::span<const std::string> values,
                 const std::string& place) {
  const hsize_t count = values.size();
  write_strings(group, name, Handle(H5Screate_simple(1, &count, nullptr), H5Sclose, place), values,
                place);
}

std::string type_name(hid_t dataset, const std::string& place) {
  const Handle type(H5Dget_type(dataset), H5Tclose, place);
  const std::size_t bits = 8 * H5Tget_size(type.get());
  switch (H5Tget_class(type.get())) {
    case H5T_FLOAT:
      return fmt::format("float{}", bits);
    case H5T_INTEGER:
      return fmt::format("{}int{}", H5Tget_sign(type.get()) == H5T_SGN_NONE ? "u" : "", bits);
    case H5T_STRING:
      return "string";
    default:
      return "other";
  }
}

namespace {

// The present and the greatest extents.
std::pair<Shape, Shape> extents_of(hid_t dataset, const std::string& place) {
  const Handle space(H5Dget_space(dataset), H5Sclose, place);
  Shape now(static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(space.get()), place)));
  Shape most(now.size());
  check(H5Sget_simple_extent_dims(space.get(), now.data(), most.data()), place);
  return {now, most};
}

}  // namespace

Shape shape_of(hid_t dataset, const std::string& place) { return extents_of(dataset, place).first; }

Shape greatest_shape_of(hid_t dataset, const std::string& place) {
  return extents_of(dataset, place).second;
}

namespace {

enum class Presence { present, absent, elsewhere };

// H5Lexists fails if the object before the last link is missing or not a group, so each link is
// tested in turn.
Presence presence_of(hid_t object, const std::string& path, const std::string& place) {
  const Handle access = within_file(H5P_LINK_ACCESS, place);
  for (auto end = path.find('/');; end = path.find('/', end + 1)) {
    const std::string part = path.substr(0, end);
    const bool last = end == std::string::npos;
    if (!part.empty() && part != "/") {
      if (check(H5Lexists(object, part.c_str(), access.get()), place) == 0) return Presence::absent;
      const H5L_type_t type = type_of_link(object, part, place);
      if (type == H5L_TYPE_EXTERNAL) return Presence::elsewhere;
      const htri_t leads = H5Oexists_by_name(object, part.c_str(), access.get());
      if (leads < 0 && type == H5L_TYPE_SOFT) return Presence::elsewhere;
      if (check(leads, place) == 0) return Presence::absent;
      if (!last && kind_of(object, part, place) != H5I_GROUP) return Presence::absent;
    }
    if (last) return Presence::present;
  }
}

}  // namespace

bool exists(hid_t object, const std::string& path, const std::string& place) {
  return presence_of(object, path, place) == Presence::present;
}

std::string why_absent(hid_t object, const std::string& path, const std::string& place) {
  return presence_of(object, path, place) == Presence::elsewhere
             ? "a link that leads out of the file, or to itself"
             : "missing";
}

std::vector<std::string> children(hid_t group, const std::string& place) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names), place);
  return names;
}

std::vector<std::string> datasets(hid_t file, const std::string& place) {
  std::vector<std::string> paths;
  const auto add = [](hid_t, const char* name, const H5L_info_t* link, void* list) -> herr_t {
    if (link->type == H5L_TYPE_HARD) {
      static_cast<std::vector<std::string>*>(list)->push_back(std::string("/") + name);
    }
    return 0;
  };
  check(H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, add, &paths), place);
  std::erase_if(paths, [&](const std::string& path) { return !is_dataset(file, path, place); });
  return paths;
}

bool is_group(hid_t parent, const std::string& name, const std::string& place) {
  return exists(parent, name, place) && kind_of(parent, name, place) == H5I_GROUP;
}

bool is_dataset(hid_t parent, const std::string& name, const std::string& place) {
  return exists(parent, name, place) && kind_of(parent, name, place) == H5I_DATASET;
}

std::vector<std::string> read_strings_attribute(hid_t object, const std::string& name,
                                                const std::string& place) {
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, place);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose, place);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose, place);
  return read_strings_with(
      attribute.get(), type.get(), space.get(), place,
      [&](hid_t memory, void* buffer) { return H5Aread(attribute.get(), memory, buffer); });
}

std::vector<std::string> read_strings(hid_t dataset, const std::string& place) {
  const Handle type(H5Dget_type(dataset), H5Tclose, place);
  const Handle space(H5Dget_space(dataset), H5Sclose, place);
  return read_strings_with(dataset, type.get(), space.get(), place,
                           [&](hid_t memory, void* buffer) {
                             return H5Dread(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer);
                           });
}

}  // namespace needlework::io::hdf5
