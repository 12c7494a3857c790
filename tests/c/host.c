/* A host program with its own settings of HDF5, OpenMP, signals and floating-point arithmetic finds
 * them untouched after runs and after failures, and they change no result: host FOLDER. */
#include <fenv.h>
#include <hdf5.h>
#include <math.h>
#include <omp.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "needlework.h"

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

static int failures = 0;
static const char* part = "";

#define EXPECT(condition)                                             \
  if (!(condition)) {                                                 \
    printf("%s: line %d: expected %s\n", part, __LINE__, #condition); \
    ++failures;                                                       \
  }

static int hdf5_errors = 0;
static herr_t count_error(hid_t stack, void* data) {
  (void)stack, (void)data;
  ++hdf5_errors;
  return 0;
}
static void on_interrupt(int number) { (void)number; }

/* What the host has set, read back. */
static void expect_untouched(void) {
  H5E_auto2_t handler = NULL;
  void* data = NULL;
  struct sigaction action;
  EXPECT(H5Eget_auto2(H5E_DEFAULT, &handler, &data) >= 0 && handler == count_error);
  EXPECT(data == &failures && hdf5_errors == 0);
  EXPECT(omp_get_max_threads() == 3 && omp_get_dynamic() == 1 && omp_get_max_active_levels() == 2);
  EXPECT(sigaction(SIGINT, NULL, &action) == 0 && action.sa_handler == on_interrupt);
  EXPECT(sigaction(SIGTERM, NULL, &action) == 0 && action.sa_handler == SIG_DFL);
  EXPECT(fegetround() == FE_UPWARD);
  EXPECT(fetestexcept(FE_DIVBYZERO | FE_INVALID | FE_UNDERFLOW) == FE_DIVBYZERO);
#if defined(__SSE__)
  EXPECT((_mm_getcsr() & 0x8040) == 0x8040); /* numbers near 0 are 0 */
#endif
}

static void set_arithmetic(void) {
  fesetround(FE_UPWARD);
#if defined(__SSE__)
  _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
}

static void set_up(void) {
  H5Eset_auto2(H5E_DEFAULT, count_error, &failures);
  omp_set_num_threads(3);
  omp_set_dynamic(1);
  omp_set_max_active_levels(2);
  signal(SIGINT, on_interrupt);
  set_arithmetic();
  feclearexcept(FE_ALL_EXCEPT);
  feraiseexcept(FE_DIVBYZERO);
}

static int stop_at_once(const needlework_collision* collisions, size_t count, void* user) {
  (void)collisions, (void)count, (void)user;
  return 1;
}

/* Runs a gas to so many collisions and writes the hash. */
static void run(const char* scene, uint64_t collisions, char hash[33]) {
  const needlework_limits limits = {.collisions = collisions};
  needlework_error error;
  needlework_simulation* simulation = needlework_create(scene, NEEDLEWORK_REPLACE, &error);
  if (!simulation) printf("%s: %s\n", part, error.message);
  EXPECT(simulation);
  EXPECT(needlework_run_until(simulation, &limits, NULL) == NEEDLEWORK_OK);
  EXPECT(needlework_get_hash(simulation, hash) == NEEDLEWORK_OK);
  EXPECT(needlework_close(simulation) == NEEDLEWORK_OK);
  needlework_destroy(simulation);
}

static void fail(const char* folder) {
  const needlework_limits limits = {.collisions_per_needle = 1000};
  char scene[600];
  needlework_error error;
  EXPECT(!needlework_create("nonsense", 0, &error) && error.code == NEEDLEWORK_INPUT);
  EXPECT(!needlework_open("/no/such/scene", 0, &error) && error.code == NEEDLEWORK_IO);
  snprintf(scene, sizeof scene, "initial.file = \"%s/no.h5\"\n", folder);
  EXPECT(!needlework_create(scene, 0, &error) && error.code == NEEDLEWORK_IO);
  snprintf(scene, sizeof scene, "needles = { count = 2, box = 5 }\noutput.file = \"%s/no/a.h5\"\n",
           folder);
  EXPECT(!needlework_create(scene, 0, &error) && error.code == NEEDLEWORK_IO);

  needlework_simulation* collapsing =
      needlework_create("needles = { count = 60, box = 5 }\ncollisions.epsilon = 0.1\n", 0, &error);
  EXPECT(needlework_run_until(collapsing, &limits, NULL) == NEEDLEWORK_INVALID_STATE);
  EXPECT(needlework_write_state(collapsing, "/no/such/state.h5", 0) == NEEDLEWORK_IO);
  EXPECT(needlework_set_callback(collapsing, 1, stop_at_once, NULL) == NEEDLEWORK_OK);
  needlework_destroy(collapsing);
}

int main(int count, char** arguments) {
  const char* folder = count > 1 ? arguments[1] : ".";
  const char* small =
      "needles = { count = 60, box = 5 }\ncollisions = { epsilon = 0.9, tc = 1e-4 }\n";
  const char* large = "needles = { count = 3000, box = 15 }\nengine.threads = 2\n";
  char with_file[600], plain[33], threads[33], hash[33];
  double rate = 0, hosts_rate = 0;
  snprintf(with_file, sizeof with_file, "%soutput = { file = \"%s/gas.h5\", events = true }\n",
           small, folder);
  const int offers_threads = omp_get_thread_limit() >= 2;

  /* Before the host has set anything. */
  part = "plain";
  run(small, 500, plain);
  if (offers_threads) run(large, 3000, threads);
  EXPECT(needlework_collision_rate(6, 0.3, 1, 1, &rate, NULL) == NEEDLEWORK_OK);

  set_up();
  part = "own threads"; /* they have the host's arithmetic, and are used again by the library */
  int own = 0;
#pragma omp parallel reduction(+ : own)
  {
    set_arithmetic();
    own += fegetround() == FE_UPWARD;
  }
  EXPECT(own >= 1);
  expect_untouched();

  part = "runs";
  run(with_file, 500, hash);
  EXPECT(strcmp(hash, plain) == 0);
  expect_untouched();
  if (offers_threads) {
    run(large, 3000, hash);
    EXPECT(strcmp(hash, threads) == 0);
    expect_untouched();
  } else {
    printf("OpenMP offers one thread only: nothing was run on two\n");
  }
  EXPECT(needlework_collision_rate(6, 0.3, 1, 1, &hosts_rate, NULL) == NEEDLEWORK_OK);
  EXPECT(hosts_rate == rate);
  expect_untouched();

  part = "failures";
  fail(folder);
  expect_untouched();

  part = "the host's own HDF5";
  snprintf(with_file, sizeof with_file, "%s/gas.h5", folder);
  const hid_t file = H5Fopen(with_file, H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT(file >= 0);
  H5Fclose(file);
  EXPECT(H5Fopen("/no/such/file.h5", H5F_ACC_RDONLY, H5P_DEFAULT) < 0 && hdf5_errors == 1);
  if (failures == 0) printf("untouched\n");
  return failures != 0;
}
