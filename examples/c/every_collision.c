/* Adds up what collisions cost. Ctrl-C ends it early with all that it knows. */
#include <needlework.h>
#include <signal.h>
#include <stdio.h>

static needlework_simulation* gas;

static void on_ctrl_c(int number) {
  (void)number;
  needlework_interrupt(gas);
}

static int add_up(const needlework_collision* collisions, size_t count, void* user) {
  double* lost = user;
  for (size_t n = 0; n < count; ++n) *lost -= collisions[n].energy_change;
  return 0;
}

int main(void) {
  double lost = 0;
  int stop = 0;
  needlework_error error;
  gas = needlework_create("needles = { count = 1000, box = 10 }\ncollisions.epsilon = 0.9\n"
                          "collisions.tc_relative = 1e-3\nuntil.collisions_per_needle = 20\n",
                          0, &error);
  if (!gas) return fprintf(stderr, "%s\n", error.message), error.code;
  signal(SIGINT, on_ctrl_c);
  int code = needlework_set_callback(gas, 1000, add_up, &lost);
  if (code == NEEDLEWORK_OK) code = needlework_run_until(gas, NULL, &stop); /* as [until] says */
  if (code != NEEDLEWORK_OK) fprintf(stderr, "%s\n", needlework_message(gas));
  if (stop == NEEDLEWORK_STOP_INTERRUPTED) printf("stopped early\n");
  printf("energy lost per needle: %.4f\n", lost / (double)needlework_count(gas));
  signal(SIGINT, SIG_DFL);
  needlework_destroy(gas);
  return code;
}
