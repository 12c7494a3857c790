/* needlework.h is clean C11, and C++, and every function can be called from both. Compiled with
 * -Wall -Wextra -Wpedantic -Werror as either. */
#include "needlework.h"
#include "needlework.h" /* may be included twice */

static int ignore(const needlework_collision* collisions, size_t count, void* user) {
  (void)collisions, (void)count, (void)user;
  return 0;
}

int main(void) {
  needlework_error error;
  needlework_limits limits = {0, 10, 0, 0, 0};
  needlework_state none = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0, 0};
  needlework_totals totals;
  double box[3], ratio;
  char hash[33];
  uint64_t events;
  int stop, code = 0;
  needlework_gas gas = {6, 0.5, -1};
  needlework_simulation* simulation =
      needlework_create("needles = { count = 20, box = 4 }", 0, &error);
  if (!simulation) return error.code;
  code |= needlework_set_callback(simulation, 4, ignore, 0);
  code |= needlework_run_until(simulation, &limits, &stop);
  code |= needlework_advance(simulation, &limits, &stop);
  code |= needlework_get_box(simulation, box);
  code |= needlework_get_state(simulation, &none);
  code |= needlework_get_totals(simulation, &totals);
  code |= needlework_get_hash(simulation, hash);
  code |= needlework_get_counter(simulation, needlework_counter_name(0), &events);
  code |= needlework_ratio(&gas, &ratio, &error);
  if (needlework_checkpoint(simulation) != NEEDLEWORK_USAGE) code |= 1; /* it has no file */
  if (needlework_resume("", &error)) code |= 1;
  code |= needlework_close(simulation);
  if (stop != NEEDLEWORK_STOP_COLLISIONS || needlework_count(simulation) != 20) code |= 1;
  needlework_destroy(simulation);
  return code;
}
