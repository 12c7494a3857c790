/* A run that does 10 units of time whenever this program is started. */
#include <needlework.h>
#include <stdio.h>

static const char* scene =
    "needles = { count = 1000, box = 10 }\n"
    "collisions = { epsilon = 0.9, tc_relative = 1e-3 }\n"
    "output.file = \"daily.h5\"\n";

int main(void) {
  needlework_error error;
  FILE* saved = fopen("daily.h5.checkpoint", "rb");
  if (saved) fclose(saved);
  needlework_simulation* gas =
      saved ? needlework_resume("daily.h5", &error) : needlework_create(scene, 0, &error);
  if (!gas) {
    fprintf(stderr, "%s\n", error.message);
    return error.code;
  }
  const needlework_limits limits = {.time = 10};
  needlework_totals totals;
  int code = needlework_advance(gas, &limits, NULL);
  if (code == NEEDLEWORK_OK) code = needlework_close(gas);
  if (code == NEEDLEWORK_OK) code = needlework_get_totals(gas, &totals);
  if (code == NEEDLEWORK_OK) printf("time %g, energy %.5f\n", totals.time, totals.energy);
  else fprintf(stderr, "%s\n", needlework_message(gas));
  needlework_destroy(gas);
  return code;
}
