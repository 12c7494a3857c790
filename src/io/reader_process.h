// A child process that reads a file, so that a file on which HDF5 crashes, hangs or takes all
// memory is an error and no more: HDF5 was not made for untrusted files.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace needlework::io {

/// Whether files are read in a child process: yes, unless set_reads_in_child_process(false) has
/// been called or the environment variable NEEDLEWORK_FORK is 0.
bool reads_in_child_process();

/// What one request may take.
struct ReadingLimits {
  std::uint64_t memory = 0;  ///< beyond what the process held at the fork [bytes]
  unsigned cpu_seconds = 0;
};

/// Enough for any file of this size whose content is as large as can be, and not more than this
/// machine can give.
ReadingLimits limits_for(std::uint64_t file_bytes);

/// A child process that answers requests about one file, one after the other.
///
/// It is a fork of this process rather than another program, because a library does not know where
/// the program is, and ends without running any handler of this process. It uses the thread that
/// forks alone, no OpenMP and no MPI, has HDF5 to itself (hdf5::fork_process), holds no locks of
/// files that are being written, and writes nothing, not even to the terminal. It ends when this
/// process ends. Interruptions (SIGINT and the like) do not reach it.
///
/// Used by one thread at a time.
class ReaderProcess {
 public:
  /// Bytes for bytes; an InputError, IoError, std::invalid_argument or std::bad_alloc that it
  /// throws becomes one of this process.
  using Service = std::function<std::string(std::string_view)>;

  /// `start` is called in the child, and may throw the same. Messages begin with `path`. Throws
  /// IoError if there can be no child.
  ReaderProcess(std::string path, ReadingLimits limits, const std::function<Service()>& start);
  ~ReaderProcess();
  ReaderProcess(const ReaderProcess&) = delete;
  ReaderProcess& operator=(const ReaderProcess&) = delete;

  /// What the service answers. Throws what it throws; InputError if that takes more memory than the
  /// limit, and IoError if the child crashes or exceeds its time, then and in all later calls.
  std::string ask(std::string_view request);

 private:
  void close();
  std::string receive_answer();
  [[noreturn]] void report_end();

  std::string path_;
  ReadingLimits limits_;
  int socket_ = -1;
  pid_t child_ = -1;
  std::string end_;  ///< how the child has ended; empty while it lives
};

}  // namespace needlework::io
