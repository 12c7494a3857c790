#include "tests/io/disk.h"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>

#include "needlework/error.h"

namespace needlework::io {

Disk disk;

namespace {

constexpr std::size_t page = 4096;

bool is_on_disk(int descriptor) {
  if (disk.folder.empty()) return false;
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t size = readlink(link.c_str(), path, sizeof path);
  return size >= 0 && std::string(path, static_cast<std::size_t>(size)).starts_with(disk.folder);
}

// Counts a write, and says whether the event of the disk is due.
bool is_due(int descriptor) {
  if (!is_on_disk(descriptor)) return false;
  disk.operations += 'w';
  const int number = disk.writes++;
  if (disk.at < 0) return false;
  return disk.event == Disk::Event::full ? number >= disk.at : number == disk.at;
}

int fail_or_die() {
  if (disk.event == Disk::Event::kill) std::raise(SIGKILL);
  errno = ENOSPC;
  return -1;
}

template <class Function>
Function* system_function(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

std::string message_in_child(const std::function<void()>& prepare,
                             const std::function<void()>& action) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(ends[1], STDERR_FILENO);  // HDF5 must stay silent
    prepare();
    std::string text = "no exception";
    try {
      action();
    } catch (const IoError& error) {
      text = error.what();
    } catch (const std::exception& error) {
      text = std::string("another exception: ") + error.what();
    }
    if (write(ends[1], text.data(), text.size()) < 0) _exit(2);
    // Another user's process may not be looked into, which LeakSanitizer does at the end.
    if (geteuid() != getuid() && seteuid(getuid()) == 0) prctl(PR_SET_DUMPABLE, 1);
    std::exit(0);  // HDF5 cleans up on exit and must survive that
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;) {
    text.append(buffer, static_cast<std::size_t>(n));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) return text + "killed";
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  return text;
}

void become_nobody() {
  if (geteuid() == 0 && seteuid(65534) != 0) _exit(3);
}

}  // namespace needlework::io

// The calls by which the library and HDF5 write to files, in place of the system's.

using needlework::io::disk;
using needlework::io::fail_or_die;
using needlework::io::is_due;
using needlework::io::is_on_disk;
using needlework::io::page;
using needlework::io::system_function;

extern "C" ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t offset) {
  static const auto system = system_function<decltype(pwrite)>("pwrite");
  const std::size_t to_boundary = page - static_cast<std::size_t>(offset) % page;
  if (count <= page && count > to_boundary) disk.torn += is_on_disk(descriptor);
  if (!is_due(descriptor)) return system(descriptor, bytes, count, offset);
  if (disk.event == needlework::io::Disk::Event::kill && count > to_boundary) {
    system(descriptor, bytes, to_boundary, offset);
  }
  return fail_or_die();
}

extern "C" ssize_t write(int descriptor, const void* bytes, size_t count) {
  static const auto system = system_function<decltype(write)>("write");
  return is_due(descriptor) ? fail_or_die() : system(descriptor, bytes, count);
}

extern "C" int ftruncate(int descriptor, off_t size) {
  static const auto system = system_function<decltype(ftruncate)>("ftruncate");
  return is_due(descriptor) ? fail_or_die() : system(descriptor, size);
}

extern "C" int fsync(int descriptor) {
  static const auto system = system_function<decltype(fsync)>("fsync");
  if (!is_on_disk(descriptor)) return system(descriptor);
  struct stat status;
  disk.operations += fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode) ? 'd' : 'f';
  if (!disk.sync_fails) return system(descriptor);
  errno = EIO;
  return -1;
}
