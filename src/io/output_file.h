// HDF5 files to write, for which a full disk is an ordinary error.
#pragma once

#include <memory>
#include <string>

#include "src/io/hdf5.h"

namespace needlework::io {

/// A new HDF5 file, which HDF5 writes through a file driver of this library. The driver solves
/// three problems.
///
/// 1. A failed write must be an ordinary error. When a driver reports a failed write, HDF5 cannot
///    close the file any more, and the program ends in a segmentation fault (observed with HDF5
///    1.10.8). Therefore the driver does not report failures to HDF5. It stores the first failure,
///    which the members of this class throw, and ignores all later writes. The file on disk is then
///    as if the program had been killed at the first failure, and HDF5 can close it.
///
/// 2. The file must be readable at any moment. In SWMR mode (single writer, multiple readers) HDF5
///    orders its writes such that the metadata on disk are always consistent, but it writes some of
///    them between flushes, and it extends the file before it records the new size. The driver
///    holds metadata in memory until a flush, and sets the size of the file first.
///
/// 3. A file that a killed program left must open without special options. HDF5 marks files that
///    are open for writing, and refuses to open a file that still has the mark, unless the driver
///    does not support file locks. This driver does not. It holds a shared lock of the operating
///    system instead, with which other programs cannot open the file for writing.
class OutputFile {
 public:
  /// A `growing` file may be read at any moment, and contains the time of its creation. A file
  /// written `in_one_go` has the same bytes whenever it is written.
  enum class Use { growing, in_one_go };

  /// Replaces the file `name` by an empty HDF5 file. `place` begins the messages of errors.
  OutputFile(std::string name, std::string place, Use use);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  hid_t get() const { return file_.get(); }

  /// Throws IoError with the reason of the operating system if a write has failed so far.
  void require_written() const;
  /// Starts SWMR mode. No object of the file may be open, and none can be created afterwards.
  void start_swmr();
  /// Writes everything that HDF5 holds in memory to the file.
  void flush();
  /// Closes the file. No object of it may be open.
  void close();

 private:
  hdf5::Handle make_access() const;

  std::string name_;
  std::string place_;
  std::unique_ptr<int> error_;  // errno of the first failed write, or 0; set by the driver
  hdf5::Handle driver_;  // must outlive the file: H5FD_close frees a driver that nothing else
                         // holds, and then reads it (HDF5 1.10.8)
  hdf5::Handle file_;
};

}  // namespace needlework::io
