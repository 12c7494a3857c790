// Runs a command and prints the CPU time that it took, with its children, to standard error:
//   with_cpu_time COMMAND ARGUMENT...
// ctest runs every test through it, and tests/cpu_times.py reads its log. Other load on the machine
// changes CPU time far less than wall time.
#define _POSIX_C_SOURCE 200809L
#define _DEFAULT_SOURCE
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static double seconds(struct timeval time) { return (double)time.tv_sec + 1e-6 * (double)time.tv_usec; }

int main(int argc, char** argv) {
  if (argc < 2) {
    fprintf(stderr, "with_cpu_time: expected a command\n");
    return 2;
  }
  const pid_t child = fork();
  if (child == 0) {
    execvp(argv[1], argv + 1);
    perror(argv[1]);
    _exit(127);
  }
  int status = 0;
  struct rusage used;
  while (wait4(child, &status, 0, &used) < 0) {
    if (errno == EINTR) continue;
    perror("with_cpu_time");
    return 127;
  }
  fprintf(stderr, "\nCPU time %.2f s\n", seconds(used.ru_utime) + seconds(used.ru_stime));
  if (WIFSIGNALED(status)) {
    signal(WTERMSIG(status), SIG_DFL);
    raise(WTERMSIG(status));
  }
  return WEXITSTATUS(status);
}
