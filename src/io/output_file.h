// HDF5 files to write, for which a full disk is an ordinary error.
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <memory>
#include <string>

#include "src/io/hdf5.h"
#include "src/io/write_lock.h"

namespace needlework::io {

/// What may be written to a file that is open, and who may read it meanwhile.
enum class OutputMode {
  whole,       ///< anything; nobody
  growing,     ///< rows at the ends of datasets; anybody
  shortening,  ///< the numbers of rows of datasets; anybody
};

/// Throws IoError, "PLACE: ...", unless this process is the one that opened the file: a child that
/// was forked since must not write it.
void require_process(pid_t opener, const std::string& place);

/// An HDF5 file, which HDF5 writes through a file driver of this library. The driver solves three
/// problems.
///
/// 1. A failed write must be an ordinary error. When a driver reports a failed write, HDF5 cannot
///    close the file any more, and the program ends in a segmentation fault (observed with HDF5
///    1.10.8). Therefore the driver does not report failures to HDF5. It stores the first failure,
///    which the members of this class throw, and ignores all later writes. The file on disk is then
///    as if the program had been killed at the first failure, and HDF5 can close it.
///
/// 2. The file must be readable at any moment. In SWMR mode (single writer, multiple readers) HDF5
///    orders its writes such that the metadata on disk are always consistent, but it writes some of
///    them between flushes, and it extends the file before it records the new size. A reader asks
///    for the size of the file before it reads what the file says of its size. The driver holds
///    metadata in memory until a flush, sets the size of the file first, and keeps it larger than
///    the file says, by 16 MiB or more, until it is closed. What was never written takes no space
///    on most file systems.
///
/// 3. A file that a killed program left must open without special options. HDF5 marks files that
///    are open for writing, and refuses to open a file that still has the mark, unless the driver
///    does not support file locks. This driver does not. A WriteLock excludes other writers.
class OutputFile {
 public:
  /// A `growing` file may be read at any moment, and contains the time of its creation. A file
  /// written `in_one_go` has the same bytes whenever it is written.
  enum class Use { growing, in_one_go };

  /// Takes hold of the file `name`, which must exist, and leaves it as it is. `place` begins the
  /// messages of errors. Throws IoError if another program has the file open for writing.
  OutputFile(std::string name, std::string place);
  /// The same, and makes it an empty HDF5 file.
  OutputFile(std::string name, std::string place, Use use);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  hid_t get() const { return file_.get(); }

  /// Throws IoError with the reason of the operating system if a write has failed so far, and in a
  /// child that was forked since the file was opened: nothing of it is written there.
  void require_written() const;
  /// Opens the file, or opens it again, such that rows can be removed from the ends of datasets,
  /// and nothing else changed. At any moment, also between the writes of a flush, a dataset on disk
  /// has its old or its new number of rows, and these rows are unharmed. A flush changes the
  /// datasets on disk in any order. The file keeps its size, and the space of the removed rows is
  /// for later rows of the same dataset. The file has to be closed before rows are written.
  void start_shortening();
  /// Opens the file, or opens it again, in SWMR mode. No object of the file may be open. Datasets
  /// can grow then, but neither can they shrink nor objects be created.
  void start_swmr();
  /// Writes everything that HDF5 holds in memory to the file.
  void flush();
  /// Flushes, and returns when the file is on the disk.
  void sync();
  /// Throws IoError unless `name` leads to this file, which another program may have removed,
  /// renamed or replaced in the meantime.
  void require_named(const std::string& name) const { lock_.require_named(name); }
  /// Closes the file. No object of it may be open.
  void close();

 private:
  hdf5::Handle make_access(OutputMode mode) const;
  void open(OutputMode mode);

  std::string name_;
  std::string place_;
  const pid_t process_ = getpid();
  WriteLock lock_;
  std::unique_ptr<int> error_;  // errno of the first failed write, or 0; set by the driver
  hdf5::Handle driver_;  // must outlive the file: H5FD_close frees a driver that nothing else
                         // holds, and then reads it (HDF5 1.10.8)
  hdf5::Handle file_;
};

}  // namespace needlework::io
