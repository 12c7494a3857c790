/* Runs where files cannot grow beyond 300 KiB: full_disk FOLDER. Exits with 0 if all failures
 * are reported as they should be. */
#include <stdio.h>
#include <string.h>

#include "needlework.h"

#define EXPECT(condition)                                                \
  if (!(condition)) {                                                    \
    printf("line %d: expected %s; %s\n", __LINE__, #condition, message); \
    return 1;                                                            \
  }

int main(int count, char** arguments) {
  char scene[1024], old[512];
  const char* message = "";
  const char* folder = count > 1 ? arguments[1] : ".";
  const char* gas = "needles = { count = 60, box = 5 }\n";
  needlework_error error = {0};

  /* Small enough to be written. */
  snprintf(old, sizeof old, "%s/old.h5", folder);
  needlework_simulation* small = needlework_create(gas, 0, &error);
  message = error.message;
  EXPECT(small);
  message = needlework_message(small);
  EXPECT(needlework_write_state(small, old, 0) == NEEDLEWORK_OK);
  needlework_destroy(small);

  /* A larger one does not fit, and what is there stays. */
  needlework_simulation* large =
      needlework_create("needles = { count = 3000, box = 15 }\n", 0, &error);
  message = error.message;
  EXPECT(large);
  EXPECT(needlework_write_state(large, old, NEEDLEWORK_REPLACE) == NEEDLEWORK_IO);
  message = needlework_message(large);
  EXPECT(strncmp(message, old, strlen(old)) == 0);
  needlework_destroy(large);

  /* Collisions fill the file. */
  snprintf(scene, sizeof scene, "%soutput = { events = true, file = \"%s/events.h5\" }\n", gas,
           folder);
  needlework_simulation* simulation = needlework_create(scene, 0, &error);
  needlework_simulation* undisturbed = needlework_create(gas, 0, NULL);
  message = error.message;
  EXPECT(simulation && undisturbed);
  const needlework_limits limits = {.collisions = 30000};
  int stop = -1;
  EXPECT(needlework_run_until(simulation, &limits, &stop) == NEEDLEWORK_IO);
  message = needlework_message(simulation);
  EXPECT(strstr(message, "events.h5") && stop == -1);
  EXPECT(needlework_run_until(simulation, &limits, &stop) == NEEDLEWORK_IO);
  EXPECT(needlework_close(simulation) == NEEDLEWORK_IO);

  /* The run that was cut off can be looked at: it is the same as without a file. */
  needlework_totals totals;
  char hash[33], expected[33];
  EXPECT(needlework_get_totals(simulation, &totals) == NEEDLEWORK_OK && totals.collisions > 0);
  const needlework_limits as_far = {.collisions = totals.collisions};
  EXPECT(needlework_run_until(undisturbed, &as_far, NULL) == NEEDLEWORK_OK);
  EXPECT(needlework_get_hash(simulation, hash) == NEEDLEWORK_OK);
  EXPECT(needlework_get_hash(undisturbed, expected) == NEEDLEWORK_OK);
  EXPECT(strcmp(hash, expected) == 0);
  needlework_destroy(simulation);
  needlework_destroy(undisturbed);
  return 0;
}
