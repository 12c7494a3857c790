// HDF5 files to write to, with a full disk as an ordinary error.
#pragma once

#include <memory>
#include <string>

#include "src/io/hdf5.h"

namespace needlework::io {

/// A new HDF5 file, written through a driver of its own, which does three things.
///
/// A failed write is an error, no more. HDF5 does not survive one: it keeps what it could not
/// write, can then no longer close the file, and the program ends in a segmentation fault (seen
/// with 1.10.8). So it is not told. The first failure is remembered and throws from here; from then
/// on nothing more reaches the disk, as if the program had been killed at that moment, while HDF5
/// goes on and closes the file.
///
/// Between two flushes the file keeps its state. HDF5 in SWMR mode (single writer, multiple
/// readers) orders what it writes such that the metadata on disk are consistent at any moment, but
/// spreads it over time, and grows the file before it says so. The driver keeps metadata back until
/// a flush, and writes the size of the file first.
///
/// The file is not marked as open. HDF5 has no marks where a driver cannot lock files, and with a
/// mark no ordinary reader would open a file that a killed program left. A shared lock of the
/// system keeps other writers away while this one lives.
class OutputFile {
 public:
  /// A file that grows may be read at any moment, and says when it was made; one written in one go
  /// has the same bytes whenever it is written.
  enum class Use { growing, in_one_go };

  /// Makes the file `name` an empty HDF5 file. `place` begins the messages of errors.
  OutputFile(std::string name, std::string place, Use use);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  hid_t get() const { return file_.get(); }

  /// Throws IoError with the system's reason if any write failed so far.
  void require_written() const;
  /// Begins single writing, multiple reading, for which no object may be open. None can be made
  /// after this.
  void start_swmr();
  /// Hands all that is in HDF5's memory to the system.
  void flush();
  /// Closes the file, in which nothing may be open.
  void close();

 private:
  hdf5::Handle make_access() const;

  std::string name_;
  std::string place_;
  std::unique_ptr<int> error_;  // errno of the write that failed, or 0; the driver has its address
  hdf5::Handle file_;
};

}  // namespace needlework::io
