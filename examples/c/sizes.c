/* Needles of different lengths, and how warm the shorter ones are beside the longer ones. */
#include <needlework.h>
#include <stdio.h>

enum { count = 400 };
static const char* scene =
    "needles.box = 8\n"
    "collisions = { epsilon = 0.8, tc_relative = 1e-3 }\n"
    "until.collisions_per_needle = 40\n"
    "[[species]]\nname = \"needles\"\ncount = 400\nmass.density = 1\n"
    "length = { distribution = \"lognormal\", mean = 1, width = 0.4 }\n";

int main(void) {
  static double length[count], mass[count], velocity[count][3];
  needlework_error error;
  needlework_simulation* gas = needlework_create(scene, 0, &error);
  if (!gas) return fprintf(stderr, "%s\n", error.message), error.code;
  const needlework_state into = {.velocity = {.data = velocity[0]}};
  int code = needlework_run_until(gas, NULL, NULL);
  if (code == NEEDLEWORK_OK) code = needlework_get_state(gas, &into);
  if (code == NEEDLEWORK_OK) code = needlework_get_bodies(gas, length, NULL, mass, NULL);
  if (code == NEEDLEWORK_OK) {
    double energy[2] = {0, 0}, needles[2] = {0, 0};
    for (int n = 0; n < count; ++n) {
      const double* v = velocity[n];
      energy[length[n] > 1] += mass[n] * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / 2;
      ++needles[length[n] > 1];
    }
    for (int n = 0; n < 2; ++n)
      printf("%s than 1: %.0f, T_tr %.3f\n", n ? "longer" : "shorter", needles[n],
             energy[n] / needles[n] * 2 / 3);
  } else {
    fprintf(stderr, "%s\n", needlework_message(gas));
  }
  needlework_destroy(gas);
  return code;
}
