/* What calls through the C interface cost: a run in one call, in calls of 1000 collisions each, and
 * with a callback for every collision. Interleaved repetitions on one thread, CPU time.
 *
 *     bench_c_calls [REPETITIONS [COLLISIONS]] */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "needlework.h"

enum { ways = 5, most = 100 };

static const char* const names[ways] = {"one call", "calls of 1000", "callback, batches of 1000",
                                        "callback, batches of 100", "callback, one by one"};
static const size_t batches[ways] = {0, 0, 1000, 100, 1};

static int add_up(const needlework_collision* collisions, size_t count, void* user) {
  double* lost = user;
  for (size_t n = 0; n < count; ++n) *lost -= collisions[n].energy_change;
  return 0;
}

static double cpu_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* CPU time of a run this way, without making the simulation; writes the hash. */
static double measure(int way, uint64_t collisions, char hash[33]) {
  /* 0.05 needles per volume. */
  const char* scene =
      "needles = { count = 10000, box = 58.48 }\n"
      "collisions = { epsilon = 0.9, tc_relative = 1e-3 }\n"
      "engine.threads = 1\n";
  needlework_error error;
  needlework_simulation* gas = needlework_create(scene, 0, &error);
  if (!gas) {
    fprintf(stderr, "%s\n", error.message);
    exit(1);
  }
  const needlework_limits warm_up = {.collisions = 5000}, all = {.collisions = collisions},
                          piece = {.collisions = 1000};
  double lost = 0;
  int code = needlework_run_until(gas, &warm_up, NULL);
  if (batches[way]) code |= needlework_set_callback(gas, batches[way], add_up, &lost);
  const double begin = cpu_seconds();
  if (way == 1) {
    for (uint64_t done = 0; done < collisions; done += 1000) {
      code |= needlework_advance(gas, &piece, NULL);
    }
  } else {
    code |= needlework_advance(gas, &all, NULL);
  }
  const double seconds = cpu_seconds() - begin;
  code |= needlework_get_hash(gas, hash);
  if (code != NEEDLEWORK_OK) {
    fprintf(stderr, "%s\n", needlework_message(gas));
    exit(1);
  }
  needlework_destroy(gas);
  return seconds;
}

static int compare(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

int main(int count, char** arguments) {
  const int repetitions = count > 1 ? atoi(arguments[1]) : 9;
  const uint64_t collisions = count > 2 ? strtoull(arguments[2], NULL, 10) : 100000;
  static double seconds[ways][most], ratios[ways][most];
  char first[33], hash[33];
  if (repetitions < 1 || repetitions > most || collisions % 1000 != 0) {
    fprintf(stderr, "expected at most %d repetitions, and thousands of collisions\n", most);
    return 2;
  }
  measure(0, collisions, first);
  for (int n = 0; n < repetitions; ++n) {
    for (int way = 0; way < ways; ++way) {
      seconds[way][n] = measure(way, collisions, hash);
      ratios[way][n] = seconds[way][n] / seconds[0][n];
      if (strcmp(hash, first) != 0) {
        fprintf(stderr, "%s: another trajectory\n", names[way]);
        return 1;
      }
    }
  }
  printf("%d repetitions of %llu collisions\n", repetitions, (unsigned long long)collisions);
  printf("| | CPU time per collision, us | over one call |\n|---|---|---|\n");
  for (int way = 0; way < ways; ++way) {
    qsort(seconds[way], (size_t)repetitions, sizeof(double), compare);
    qsort(ratios[way], (size_t)repetitions, sizeof(double), compare);
    printf("| %s | %.2f | %+.1f %% (%+.1f to %+.1f) |\n", names[way],
           1e6 * seconds[way][repetitions / 2] / (double)collisions,
           100 * (ratios[way][repetitions / 2] - 1), 100 * (ratios[way][0] - 1),
           100 * (ratios[way][repetitions - 1] - 1));
  }
  return 0;
}
