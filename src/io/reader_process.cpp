#include "src/io/reader_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/hdf5.h"
#include "src/io/write_lock.h"
#include "src/machine/available_memory.h"
#include "src/machine/descriptors.h"
#include "src/machine/stop_request.h"

namespace needlework::io {
namespace {

std::atomic<bool> child_process_wanted = true;

// The first byte of an answer.
enum class Outcome : char { done, input_error, io_error, invalid_argument, no_memory, other };

constexpr std::uint64_t gibibyte = std::uint64_t{1} << 30;

// Sends all bytes; false if there is nobody to receive them.
bool send_all(int socket, const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t sent = send(socket, at, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

// Throws StoppedEarly where that is asked for meanwhile.
bool receive_all(int socket, void* bytes, std::size_t size) {
  char* at = static_cast<char*>(bytes);
  while (size > 0) {
    StopRequest::check();
    pollfd waiting{.fd = socket, .events = POLLIN, .revents = 0};
    constexpr int milliseconds = 50;
    const int ready = poll(&waiting, 1, milliseconds);
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    const ssize_t received = recv(socket, at, size, 0);
    if (received < 0 && errno == EINTR) continue;
    if (received <= 0) return false;
    at += received;
    size -= static_cast<std::size_t>(received);
  }
  return true;
}

// A message is its length and its bytes.
bool send_message(int socket, std::string_view head, std::string_view body = {}) {
  const std::uint64_t size = head.size() + body.size();
  return send_all(socket, &size, sizeof size) && send_all(socket, head.data(), head.size()) &&
         send_all(socket, body.data(), body.size());
}

std::optional<std::string> receive_message(int socket, std::uint64_t most) {
  std::uint64_t size = 0;
  if (!receive_all(socket, &size, sizeof size) || size > most) return std::nullopt;
  std::string bytes(size, '\0');
  if (!receive_all(socket, bytes.data(), bytes.size())) return std::nullopt;
  return bytes;
}

std::uint64_t virtual_memory_now() {
  std::uint64_t pages = 0;
  const StandardDescriptors occupied;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

// The limit may only become narrower.
void set_limit(int resource, rlim_t value) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min({value, limit.rlim_cur, limit.rlim_max});
  setrlimit(resource, &limit);
}

// Counts the time from now on. The limit of CPU time ends computing without end; the alarm, by the
// wall, ends waiting without end, and leaves time for slow disks.
void begin_to_count_time(unsigned cpu_seconds) {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec + 2);
  rlimit limit{};
  getrlimit(RLIMIT_CPU, &limit);
  limit.rlim_cur = std::min(seconds + cpu_seconds, limit.rlim_max);
  setrlimit(RLIMIT_CPU, &limit);
  alarm(60 + 4 * cpu_seconds);
}

// Handlers of this process must not run in the child: a crash there is to end it at once, and what
// interrupts this process is not meant for it.
void use_own_signals() {
  sigset_t blocked;
  sigfillset(&blocked);
  for (const int signal :
       {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP, SIGXCPU, SIGALRM}) {
    std::signal(signal, SIG_DFL);
    sigdelset(&blocked, signal);
  }
  sigprocmask(SIG_SETMASK, &blocked, nullptr);
}

// What the C library says of a crash would confuse the terminal.
void be_silent() {
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nothing < 0) return;
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, standard);
  ::close(nothing);
}

class Child {
 public:
  Child(int socket, ReadingLimits limits) : socket_(socket), limits_(limits) {}

  void run(const std::function<ReaderProcess::Service()>& start) {
    use_own_signals();
    be_silent();
    StopRequest::forget();
    WriteLock::leave_to_parent();
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_AS, virtual_memory_now() + limits_.memory);
    ReaderProcess::Service service;
    const bool started = answer([&] {
      service = start();
      return std::string();
    });
    if (!started) return;
    constexpr std::uint64_t longest_request = std::uint64_t{1} << 24;
    while (const auto request = receive_message(socket_, longest_request)) {
      if (!answer([&] { return service(*request); })) return;
    }
  }

 private:
  template <class Action>
  bool answer(Action action) {
    begin_to_count_time(limits_.cpu_seconds);
    const bool sent = send_outcome(action);
    alarm(0);
    return sent;
  }

  template <class Action>
  bool send_outcome(Action& action) {
    try {
      return send(Outcome::done, action());
    } catch (const InputError& error) {
      return send(Outcome::input_error, error.what());
    } catch (const IoError& error) {
      return send(Outcome::io_error, error.what());
    } catch (const std::invalid_argument& error) {
      return send(Outcome::invalid_argument, error.what());
    } catch (const std::bad_alloc&) {
      return send(Outcome::no_memory, {});
    } catch (const std::length_error&) {
      return send(Outcome::no_memory, {});
    } catch (const std::exception& error) {
      return send(Outcome::other, error.what());
    }
  }

  bool send(Outcome outcome, std::string_view bytes) {
    const char head = static_cast<char>(outcome);
    return send_message(socket_, {&head, 1}, bytes);
  }

  int socket_;
  ReadingLimits limits_;
};

std::string how_it_ended(int status, ReadingLimits limits) {
  if (!WIFSIGNALED(status)) return "the process that read it ended before it was done";
  const int signal = WTERMSIG(status);
  if (signal == SIGXCPU || signal == SIGALRM) {
    return fmt::format("damaged: reading it took more than {} s", limits.cpu_seconds);
  }
  return fmt::format("damaged: HDF5 crashed while it read the file (signal {}, {})", signal,
                     strsignal(signal));
}

}  // namespace

void set_reads_in_child_process(bool wanted) { child_process_wanted = wanted; }

bool reads_in_child_process() {
  const char* fork = std::getenv("NEEDLEWORK_FORK");
  return child_process_wanted && !(fork && std::string_view(fork) == "0");
}

ReadingLimits limits_for(std::uint64_t file_bytes) {
  // A byte of a file holds about 1000 bytes of content at most (deflate), of which some copies are
  // needed. The time is that of reading such content on a slow machine.
  const double wanted = static_cast<double>(gibibyte) + 4000 * static_cast<double>(file_bytes);
  const double memory = std::min({wanted, available_memory(), 1e18});
  const std::uint64_t seconds = std::min<std::uint64_t>(10 + file_bytes / 1000000, 600);
  return {static_cast<std::uint64_t>(memory), static_cast<unsigned>(seconds)};
}

ReaderProcess::ReaderProcess(std::string path, ReadingLimits limits,
                             const std::function<Service()>& start)
    : path_(std::move(path)), limits_(limits) {
  const auto fail = [&](int error) {
    throw IoError(
        fmt::format("{}: there is no process to read it: {} (NEEDLEWORK_FORK=0 reads "
                    "files without)",
                    path_, std::generic_category().message(error)));
  };
  const StandardDescriptors occupied;
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail(errno);
  child_ = hdf5::fork_process([&] {
    ::close(ends[0]);
    Child(ends[1], limits).run(start);
  });
  const int error = errno;
  ::close(ends[1]);
  socket_ = ends[0];
  if (child_ < 0) {
    ::close(socket_);
    fail(error);
  }
  try {
    receive_answer();
  } catch (...) {
    close();
    throw;
  }
}

ReaderProcess::~ReaderProcess() { close(); }

void ReaderProcess::close() {
  // Also where another child of this process still holds a copy of the descriptor.
  shutdown(socket_, SHUT_RDWR);
  ::close(socket_);
  while (end_.empty() && waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

std::string ReaderProcess::ask(std::string_view request) {
  if (!end_.empty()) throw IoError(end_);
  if (!send_message(socket_, request)) report_end();
  return receive_answer();
}

std::string ReaderProcess::receive_answer() {
  std::optional<std::string> answer;
  try {
    answer = receive_message(socket_, limits_.memory);
  } catch (const StoppedEarly&) {
    kill(child_, SIGKILL);  // it would go on until it has something to say
    throw;
  }
  if (!answer || answer->empty()) report_end();
  const auto outcome = static_cast<Outcome>(answer->front());
  answer->erase(0, 1);
  switch (outcome) {
    case Outcome::done:
      return std::move(*answer);
    case Outcome::input_error:
      throw InputError(*answer);
    case Outcome::io_error:
      throw IoError(*answer);
    case Outcome::invalid_argument:
      throw std::invalid_argument(*answer);
    case Outcome::no_memory:
      throw InputError(fmt::format(
          "{}: reading it takes more than {:.1f} GB of memory: expected less, for its size and on "
          "this machine",
          path_, static_cast<double>(limits_.memory) * 1e-9));
    default:
      throw std::runtime_error(*answer);
  }
}

void ReaderProcess::report_end() {
  int status = 0;
  pid_t ended = -1;
  do {
    ended = waitpid(child_, &status, 0);
  } while (ended < 0 && errno == EINTR);
  // A program that waits for all of its children, or wants to know of none, has its status.
  if (ended < 0) status = 0;
  end_ = path_ + ": " + how_it_ended(status, limits_);
  throw IoError(end_);
}

}  // namespace needlework::io
