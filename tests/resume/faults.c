// A library that is loaded before the C library (LD_PRELOAD) and lets one system call that writes
// fail, whoever makes it: the program, HDF5 or the C++ library. Set by environment variables:
//
//   FAULT_FOLDER  calls on files below this folder count, from 0
//   FAULT_AT      the number of the call that fails first
//   FAULT_TIMES   how many calls fail from there on; 1 by default
//   FAULT_KIND    short: half of the bytes are written; full: those up to the end of a page are,
//                 then ENOSPC; kill: the same, then the process is killed, as the system writes the
//                 part of a page at once; otherwise the number of an errno
//   FAULT_LOG     a file to which the name of each call and that of its file are appended
//   FAULT_WATCH   a file that is copied, as it is before the first fault, to
//   FAULT_COPY    this one
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

// The function of the C library that `name` stands for.
#define SYSTEM(name)                                        \
  static __typeof__(&name) system_##name;                   \
  if (!system_##name) {                                     \
    system_##name = (__typeof__(&name))dlsym(RTLD_NEXT, #name); \
  }

static int calls;

// Calls of processes that it forks are made as if there were no faults: each would count its own.
static pid_t process;
__attribute__((constructor)) static void remember_process(void) { process = getpid(); }

static long number(const char* variable, long otherwise) {
  const char* text = getenv(variable);
  return text ? atol(text) : otherwise;
}

static void log_call(const char* name, const char* path) {
  const char* log = getenv("FAULT_LOG");
  if (!log) return;
  char line[PATH_MAX + 64];
  const int size = snprintf(line, sizeof line, "%s %s\n", name, path);
  const long file = syscall(SYS_open, log, O_WRONLY | O_APPEND | O_CREAT, 0666);
  if (syscall(SYS_write, file, line, (size_t)size) != size) abort();
  syscall(SYS_close, file);
}

static void copy_watched(void) {
  const char *from = getenv("FAULT_WATCH"), *to = getenv("FAULT_COPY");
  if (!from || !to) return;
  const long in = syscall(SYS_open, from, O_RDONLY, 0);
  if (in < 0) return;
  const long out = syscall(SYS_open, to, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  static char bytes[1 << 16];
  for (long size; (size = syscall(SYS_read, in, bytes, sizeof bytes)) > 0;) {
    if (syscall(SYS_write, out, bytes, (size_t)size) != size) abort();
  }
  syscall(SYS_close, in);
  syscall(SYS_close, out);
}

enum Fate { passes, fails, is_short, fills_page, dies };

// Counts a call and says what happens to it; sets errno if it fails.
static enum Fate fate_of(const char* name, const char* path) {
  const char* folder = getenv("FAULT_FOLDER");
  if (getpid() != process || !folder || strncmp(path, folder, strlen(folder)) != 0) return passes;
  const long call = calls++;
  log_call(name, path);
  const long first = number("FAULT_AT", -1);
  if (first < 0 || call < first || call >= first + number("FAULT_TIMES", 1)) return passes;
  if (call == first) copy_watched();
  const char* kind = getenv("FAULT_KIND");
  if (strcmp(kind, "kill") == 0) return dies;
  if (strcmp(kind, "short") == 0) return is_short;
  errno = strcmp(kind, "full") == 0 ? ENOSPC : atoi(kind);
  if (strcmp(kind, "full") == 0 && call == first) return fills_page;
  return fails;
}

// The same for a call on an open file.
static enum Fate fate_of_open(const char* name, int file) {
  char link[64], path[PATH_MAX];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t size = readlink(link, path, sizeof path - 1);
  if (size < 0) return passes;
  path[size] = 0;
  return fate_of(name, path);
}

static void die(void) { kill(getpid(), SIGKILL); }

// A call that writes all or nothing.
#define WHOLE(name, fate, ...)           \
  SYSTEM(name)                           \
  switch (fate) {                        \
    case fails:                          \
    case fills_page:                     \
      return -1;                         \
    case dies:                           \
      die();                             \
    default:                             \
      return system_##name(__VA_ARGS__); \
  }

// The bytes of a write that are in the page in which it begins, unless these are all.
static size_t in_first_page(size_t count, off64_t at) {
  const size_t page = 4096, most = page - (size_t)at % page;
  return count > most ? most : 0;
}

// A call that writes `count` bytes or some of them, from `at` on; `part(n)` is the same call for n
// of them.
#define PARTIAL(name, part, count, at)                   \
  SYSTEM(name)                                           \
  const size_t first = in_first_page(count, at);         \
  switch (fate_of_open(#name, file)) {                   \
    case fails:                                          \
      return -1;                                         \
    case fills_page:                                     \
      return first ? part(first) : -1;                   \
    case dies:                                           \
      if (first && part(first) < 0) abort();             \
      die();                                             \
    case is_short:                                       \
      return part(count > 1 ? count / 2 : count);        \
    default:                                             \
      return part(count);                                \
  }

ssize_t write(int file, const void* bytes, size_t count) {
#define PART(n) system_write(file, bytes, n)
  PARTIAL(write, PART, count, lseek64(file, 0, SEEK_CUR))
#undef PART
}
ssize_t pwrite(int file, const void* bytes, size_t count, off_t at) {
#define PART(n) system_pwrite(file, bytes, n, at)
  PARTIAL(pwrite, PART, count, at)
#undef PART
}
ssize_t pwrite64(int file, const void* bytes, size_t count, off64_t at) {
#define PART(n) system_pwrite64(file, bytes, n, at)
  PARTIAL(pwrite64, PART, count, at)
#undef PART
}
ssize_t writev(int file, const struct iovec* parts, int count) {
#define PART(n) system_writev(file, parts, (int)(n))
  PARTIAL(writev, PART, (size_t)count, 0)
#undef PART
}
int ftruncate(int file, off_t size) {
  WHOLE(ftruncate, fate_of_open("ftruncate", file), file, size)
}
int ftruncate64(int file, off64_t size) {
  WHOLE(ftruncate64, fate_of_open("ftruncate", file), file, size)
}
int fsync(int file) { WHOLE(fsync, fate_of_open("fsync", file), file) }
int fdatasync(int file) { WHOLE(fdatasync, fate_of_open("fdatasync", file), file) }
int rename(const char* from, const char* to) { WHOLE(rename, fate_of("rename", to), from, to) }
int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  WHOLE(renameat2, fate_of("renameat2", to), from_folder, from, to_folder, to, flags)
}
int link(const char* from, const char* to) { WHOLE(link, fate_of("link", to), from, to) }
int unlink(const char* path) { WHOLE(unlink, fate_of("unlink", path), path) }
int remove(const char* path) { WHOLE(remove, fate_of("remove", path), path) }

// Closes the file whatever happens, as Linux does.
int close(int file) {
  SYSTEM(close)
  const int flags = fcntl(file, F_GETFL);
  const int writes = flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
  const enum Fate fate = writes ? fate_of_open("close", file) : passes;
  if (fate == dies) die();
  const int error = errno, result = system_close(file);
  if (fate != fails) return result;
  errno = error;
  return -1;
}

// Only calls that may make a file or empty it.
static mode_t mode_of(int flags, va_list rest) {
  return flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0;
}
static enum Fate fate_of_new(const char* path, int flags) {
  return flags & (O_CREAT | O_TRUNC) ? fate_of("open", path) : passes;
}

#define OPEN(name, fate, ...)   \
  va_list rest;                 \
  va_start(rest, flags);        \
  const mode_t mode = mode_of(flags, rest); \
  va_end(rest);                 \
  WHOLE(name, fate, __VA_ARGS__, flags, mode)

int open(const char* path, int flags, ...) { OPEN(open, fate_of_new(path, flags), path) }
int open64(const char* path, int flags, ...) { OPEN(open64, fate_of_new(path, flags), path) }
int openat(int folder, const char* path, int flags, ...) {
  OPEN(openat, fate_of_new(path, flags), folder, path)
}
int openat64(int folder, const char* path, int flags, ...) {
  OPEN(openat64, fate_of_new(path, flags), folder, path)
}
