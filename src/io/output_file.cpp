#include "src/io/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "src/io/system_calls.h"
#include "src/machine/descriptors.h"

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

namespace needlework::io {

using hdf5::check;
using hdf5::Handle;

namespace {

// The page size of the operating system. A write across a page boundary is not atomic: kill -9 can
// end it there, and a metadata block of which only a part was written has a wrong checksum. With
// this page size set, HDF5 keeps small metadata blocks within a page. (The blocks of its chunk
// index are larger than a page from the 8181st chunk of a dataset on.)
constexpr hsize_t page_size = 4096;

// See reserve().
constexpr haddr_t least_reserve = 1 << 24;
constexpr haddr_t flushes_reserved = 8;

// The settings of the driver in a list of file access properties.
struct DriverSettings {
  int* error;
  OutputMode mode;
};

// An open file. `kept` holds what HDF5 has written but the disk does not have: metadata between two
// flushes, everything after a failed write, and what a file that is shortened does not get.
struct DriverFile : H5FD_t {
  struct Kept {
    haddr_t address;
    H5FD_mem_t type;
    std::vector<std::byte> bytes;
  };

  int descriptor = -1;
  pid_t process = -1;  // which has opened it
  int* error = nullptr;
  OutputMode mode = OutputMode::whole;
  haddr_t end_of_allocation = 0;
  haddr_t end_of_file = 0;
  haddr_t size_on_disk = 0;
  haddr_t flushed_end = 0;  // of allocation, at the last flush
  haddr_t reserve = least_reserve;
  std::vector<Kept> kept;  // in the order of writing
};

DriverFile& driver_file(H5FD_t* file) { return *static_cast<DriverFile*>(file); }

const DriverFile& driver_file(const H5FD_t* file) { return *static_cast<const DriverFile*>(file); }

// Whether nothing more goes to the disk: after a failed write, and in a forked child, which would
// otherwise write what the file held at the fork, at the latest when HDF5 ends with the process.
bool is_lost(DriverFile& file) {
  if (*file.error == 0 && getpid() != file.process) *file.error = EPERM;
  return *file.error != 0;
}

// Exceptions must not pass through HDF5, which is written in C.
template <class Action>
herr_t guarded(Action action) noexcept {
  try {
    action();
    return 0;
  } catch (const std::exception&) {
    return -1;
  }
}

H5FD_t* driver_open(const char* name, unsigned flags, hid_t access, haddr_t) {
  const auto* settings = static_cast<const DriverSettings*>(H5Pget_driver_info(access));
  const int create = (flags & H5F_ACC_TRUNC) != 0 ? O_CREAT | O_TRUNC : 0;
  const int descriptor = open_descriptor(name, O_RDWR | create);
  if (descriptor < 0) {
    *settings->error = errno;
    return nullptr;
  }
  struct stat status;
  auto* file = fstat(descriptor, &status) == 0 ? new (std::nothrow) DriverFile : nullptr;
  if (!file) {
    close(descriptor);
    return nullptr;
  }
  file->descriptor = descriptor;
  file->process = getpid();
  file->error = settings->error;
  file->mode = settings->mode;
  file->end_of_file = file->size_on_disk = file->flushed_end = static_cast<haddr_t>(status.st_size);
  return file;
}

herr_t driver_query(const H5FD_t* file, unsigned long* flags) {
  if (!flags) return 0;
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_POSIX_COMPAT_HANDLE |
           H5FD_FEAT_SUPPORTS_SWMR_IO | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  // Without the accumulator each write is one block of metadata, whose kind can be seen.
  if (file && driver_file(file).mode == OutputMode::shortening)
    *flags &= ~H5FD_FEAT_ACCUMULATE_METADATA;
  return 0;
}

haddr_t driver_get_eoa(const H5FD_t* file, H5FD_mem_t) {
  return driver_file(file).end_of_allocation;
}

herr_t driver_set_eoa(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  driver_file(file).end_of_allocation = address;
  return 0;
}

haddr_t driver_get_eof(const H5FD_t* file, H5FD_mem_t) { return driver_file(file).end_of_file; }

herr_t driver_get_handle(H5FD_t* file, hid_t, void** handle) {
  *handle = &driver_file(file).descriptor;
  return 0;
}

// Copies the part of `kept` that lies within the `size` bytes from `address` on.
void copy_kept(const DriverFile::Kept& kept, haddr_t address, std::size_t size, std::byte* to) {
  const haddr_t begin = std::max(address, kept.address);
  const haddr_t end = std::min(address + size, kept.address + kept.bytes.size());
  if (begin >= end) return;
  std::memcpy(to + (begin - address), kept.bytes.data() + (begin - kept.address), end - begin);
}

// The other way: replaces that part of `kept`.
void replace_kept(DriverFile::Kept& kept, haddr_t address, std::size_t size,
                  const std::byte* from) {
  const haddr_t begin = std::max(address, kept.address);
  const haddr_t end = std::min(address + size, kept.address + kept.bytes.size());
  if (begin >= end) return;
  std::memcpy(kept.bytes.data() + (begin - kept.address), from + (begin - address), end - begin);
}

herr_t driver_read(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, std::size_t size,
                   void* buffer) {
  const DriverFile& file = driver_file(base);
  auto* const bytes = static_cast<std::byte*>(buffer);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = uninterrupted([&] {
      return pread(file.descriptor, bytes + done, size - done, static_cast<off_t>(address + done));
    });
    if (got < 0) return -1;
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  // Bytes that were allocated but not written yet are zero.
  std::fill(bytes + done, bytes + size, std::byte{0});
  for (const DriverFile::Kept& kept : file.kept) copy_kept(kept, address, size, bytes);
  return 0;
}

void write_to_disk(DriverFile& file, haddr_t address, const std::byte* bytes, std::size_t size) {
  *file.error = write_fully(file.descriptor, bytes, size, address);
  file.size_on_disk = std::max(file.size_on_disk, address + size);
}

// What there is no memory to keep goes to the disk at once: the order of writing then protects the
// file no more, should the program be killed, but the file itself is right.
void keep(DriverFile& file, H5FD_mem_t type, haddr_t address, const std::byte* bytes,
          std::size_t size) noexcept {
  try {
    file.kept.push_back({address, type, {bytes, bytes + size}});
  } catch (const std::bad_alloc&) {
    if (file.mode == OutputMode::shortening) {
      *file.error = ENOMEM;
      return;
    }
    for (DriverFile::Kept& kept : file.kept) replace_kept(kept, address, size, bytes);
    if (!is_lost(file)) write_to_disk(file, address, bytes, size);
  }
}

herr_t driver_write(H5FD_t* base, H5FD_mem_t type, hid_t, haddr_t address, std::size_t size,
                    const void* buffer) {
  DriverFile& file = driver_file(base);
  const auto* const bytes = static_cast<const std::byte*>(buffer);
  const bool at_once = type == H5FD_MEM_DRAW && file.mode != OutputMode::shortening;
  if (at_once && !is_lost(file)) write_to_disk(file, address, bytes, size);
  if (!at_once || *file.error != 0) keep(file, type, address, bytes, size);
  file.end_of_file = std::max(file.end_of_file, address + size);
  return 0;
}

void set_size_on_disk(DriverFile& file, haddr_t size) {
  if (is_lost(file) || size == file.size_on_disk) return;
  const auto resize = [&] { return ftruncate(file.descriptor, static_cast<off_t>(size)); };
  if (uninterrupted(resize) != 0) *file.error = errno;
  file.size_on_disk = size;
}

// Readers ask for the size of a file before they read the superblock. So that the file may grow in
// between, its size is kept ahead of the superblock, by 16 MiB or eight times what a flush has
// added so far at most. Beyond the limit of the sizes of files it would end the process.
void reserve(DriverFile& file) {
  const haddr_t end = file.end_of_allocation;
  const haddr_t growth = end - std::min(end, std::exchange(file.flushed_end, end));
  file.reserve = std::max(file.reserve, flushes_reserved * growth);
  struct rlimit limit;
  if (getrlimit(RLIMIT_FSIZE, &limit) != 0) limit.rlim_cur = RLIM_INFINITY;
  const haddr_t size = std::min<haddr_t>(end + file.reserve, limit.rlim_cur);
  set_size_on_disk(file, std::max(file.size_on_disk, size));
}

// HDF5 has the same type for the headers of chunk indexes.
bool is_object_header(const DriverFile::Kept& kept) {
  const auto begins_with = [&](const char* signature) {
    return kept.bytes.size() >= 4 && std::memcmp(kept.bytes.data(), signature, 4) == 0;
  };
  return kept.type == H5FD_MEM_OHDR && (begins_with("OHDR") || begins_with("OCHK"));
}

// When datasets are shortened, only the object headers are written, which contain the numbers of
// rows. HDF5 also clears the entries of removed chunks in chunk indexes, fills removed rows of the
// last chunk that stays with zeros, and makes the file smaller. None of this could be done in one
// step with the header. Without it the chunks stay where they are, as those do that a killed
// program has added to a chunk index but not yet to the number of rows, and are used again when
// the dataset grows.
void write_object_headers(DriverFile& file) {
  for (const DriverFile::Kept& kept : file.kept) {
    if (is_lost(file)) return;
    if (!is_object_header(kept)) continue;
    write_to_disk(file, kept.address, kept.bytes.data(), kept.bytes.size());
  }
  std::erase_if(file.kept, is_object_header);
}

// The superblock, at address 0, contains the size of the file. Readers refuse a file that is
// shorter, and metadata that point beyond it. Therefore the size of the file is set first, then the
// superblock is written, then the other metadata.
void write_kept(DriverFile& file) {
  if (file.mode == OutputMode::shortening) {
    write_object_headers(file);
    return;
  }
  set_size_on_disk(file, std::max(file.size_on_disk, file.end_of_allocation));
  if (file.mode == OutputMode::growing) reserve(file);
  std::stable_partition(file.kept.begin(), file.kept.end(),
                        [](const DriverFile::Kept& kept) { return kept.address == 0; });
  for (const DriverFile::Kept& kept : file.kept) {
    if (is_lost(file)) return;
    write_to_disk(file, kept.address, kept.bytes.data(), kept.bytes.size());
  }
  file.kept.clear();
}

herr_t driver_flush(H5FD_t* base, hid_t, hbool_t) {
  return guarded([&] { write_kept(driver_file(base)); });
}

herr_t driver_truncate(H5FD_t* base, hid_t, hbool_t) {
  DriverFile& file = driver_file(base);
  file.end_of_file = file.end_of_allocation;
  return 0;
}

herr_t driver_close(H5FD_t* base) {
  DriverFile& file = driver_file(base);
  if (file.mode == OutputMode::growing) file.mode = OutputMode::whole;
  guarded([&] { write_kept(file); });
  if (file.mode != OutputMode::shortening) set_size_on_disk(file, file.end_of_allocation);
  const int error = close_written(file.descriptor);
  if (*file.error == 0) *file.error = error;
  delete &file;
  return 0;
}

Handle register_driver(const std::string& place) {
  H5FD_class_t driver{};
#ifdef H5FD_CLASS_VERSION
  driver.version = H5FD_CLASS_VERSION;
  driver.value = 311;  // from the range reserved for testing and private drivers
#endif
  driver.name = "needlework";
  driver.maxaddr = (haddr_t{1} << 63) - 1;
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(DriverSettings);
  driver.open = driver_open;
  driver.close = driver_close;
  driver.query = driver_query;
  driver.get_eoa = driver_get_eoa;
  driver.set_eoa = driver_set_eoa;
  driver.get_eof = driver_get_eof;
  driver.get_handle = driver_get_handle;
  driver.read = driver_read;
  driver.write = driver_write;
  driver.flush = driver_flush;
  driver.truncate = driver_truncate;
  const H5FD_mem_t map[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(map), std::end(map), std::begin(driver.fl_map));
  return {H5FDregister(&driver), H5FDunregister, place};
}

// Makes HDF5 allocate space in pages, so that small metadata blocks do not cross page boundaries.
// The file then records this strategy together with the time of its creation.
void set_pages(hid_t creation, const std::string& place) {
  const bool keep_free_space = false;
  check(H5Pset_file_space_strategy(creation, H5F_FSPACE_STRATEGY_PAGE, keep_free_space, 1), place);
  check(H5Pset_file_space_page_size(creation, page_size), place);
}

}  // namespace

void require_process(pid_t opener, const std::string& place) {
  if (getpid() == opener) return;
  throw IoError(place +
                ": belongs to the process that opened it: expected a simulation without this file "
                "in a forked child");
}

OutputFile::OutputFile(std::string name, std::string place)
    : name_(std::move(name)),
      place_(std::move(place)),
      lock_(name_, place_),
      error_(std::make_unique<int>(0)),
      driver_(register_driver(place_)) {}

OutputFile::OutputFile(std::string name, std::string place, Use use)
    : OutputFile(std::move(name), std::move(place)) {
  const Handle creation = hdf5::without_times(H5P_FILE_CREATE, place_);
  if (use == Use::growing) set_pages(creation.get(), place_);
  const Handle access = make_access(OutputMode::whole);
  const hid_t file = H5Fcreate(name_.c_str(), H5F_ACC_TRUNC, creation.get(), access.get());
  if (file < 0) require_written();
  file_ = Handle(file, H5Fclose, place_);
}

OutputFile::~OutputFile() = default;

void OutputFile::require_written() const {
  require_process(process_, place_);
  if (*error_ == 0) return;
  throw IoError(fmt::format("{}: {}", place_, std::generic_category().message(*error_)));
}

Handle OutputFile::make_access(OutputMode mode) const {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, place_);
  // SWMR mode needs the file format of HDF5 1.10. Newer formats are excluded, so that HDF5 1.10 can
  // read the file.
  check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110), place_);
  const DriverSettings settings{error_.get(), mode};
  check(H5Pset_driver(access.get(), driver_.get(), &settings), place_);
  return access;
}

void OutputFile::open(OutputMode mode) {
  close();
  const Handle access = make_access(mode);
  const unsigned flags = mode == OutputMode::growing ? H5F_ACC_SWMR_WRITE : 0;
  const hid_t file = H5Fopen(name_.c_str(), H5F_ACC_RDWR | flags, access.get());
  if (file < 0) require_written();
  file_ = Handle(file, H5Fclose, place_);
}

void OutputFile::start_shortening() { open(OutputMode::shortening); }

// The file is reopened, because H5Fstart_swmr_write would mark it as open for writing. The flush
// makes it larger, before anybody reads it.
void OutputFile::start_swmr() {
  open(OutputMode::growing);
  flush();
}

void OutputFile::flush() {
  check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), place_);
  require_written();
}

void OutputFile::sync() {
  flush();
  lock_.sync();
}

void OutputFile::close() {
  file_.close(place_);
  require_written();
}

}  // namespace needlework::io
