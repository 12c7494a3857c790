/* A gas of needles, some collisions, the hash of the trajectory.
 *
 *     cc smallest.c $(pkg-config --cflags --libs needlework) && ./a.out */
#include <needlework.h>
#include <stdio.h>

int main(void) {
  const char* scene =
      "needles = { count = 2000, box = 58 }\n" /* dilute: 0.01 needles per volume */
      "collisions = { epsilon = 0.9, tc_relative = 1e-3 }\n";
  needlework_error error;
  needlework_simulation* gas = needlework_create(scene, 0, &error);
  if (!gas) {
    fprintf(stderr, "%s\n", error.message);
    return error.code;
  }
  const needlework_limits limits = {.collisions_per_needle = 10};
  int code = needlework_run_until(gas, &limits, NULL);
  needlework_totals totals;
  char hash[33];
  if (code == NEEDLEWORK_OK) code = needlework_get_totals(gas, &totals);
  if (code == NEEDLEWORK_OK) code = needlework_get_hash(gas, hash);
  if (code == NEEDLEWORK_OK) {
    printf("time %.6g, %llu collisions, energy %.6g of %.6g\n", totals.time,
           (unsigned long long)totals.collisions, totals.energy, totals.initial_energy);
    printf("hash %s\n", hash);
  } else {
    fprintf(stderr, "%s\n", needlework_message(gas));
  }
  needlework_destroy(gas);
  return code;
}
