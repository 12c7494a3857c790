/* Preloaded into a program, makes it believe that it is on a file system without locks: asking for
 * one fails with the errno of the variable NO_LOCKS. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>

static int refuse(void) {
  errno = atoi(getenv("NO_LOCKS"));
  return -1;
}

static int asks_for_a_lock(int command) {
  return command == F_SETLK || command == F_SETLKW || command == F_OFD_SETLK ||
         command == F_OFD_SETLKW;
}

int flock(int descriptor, int operation) {
  (void)descriptor;
  (void)operation;
  return refuse();
}

#define DEFINE(name)                                                    \
  int name(int descriptor, int command, ...) {                          \
    va_list arguments;                                                  \
    va_start(arguments, command);                                       \
    void* argument = va_arg(arguments, void*);                          \
    va_end(arguments);                                                  \
    if (asks_for_a_lock(command)) return refuse();                      \
    int (*original)(int, int, ...);                                     \
    *(void**)&original = dlsym(RTLD_NEXT, #name);                       \
    return original(descriptor, command, argument);                     \
  }
DEFINE(fcntl)
DEFINE(fcntl64)
