/* A state in the caller's own structures, and every collision in batches: a slow cloud of needles,
 * into which one fast needle flies.
 *
 *     cc own_arrays.c $(pkg-config --cflags --libs needlework) && ./a.out */
#include <needlework.h>
#include <stdio.h>

enum { side = 10, count = side * side * side };

struct needle {
  double mass; /* of the caller, not read */
  double position[3], velocity[3], director[3], spin[3];
};

/* What the callback gathers. */
struct seen {
  size_t batches, collisions, of_fast_one;
  double energy_lost;
};

static int look(const needlework_collision* collisions, size_t number, void* user) {
  struct seen* seen = user;
  ++seen->batches;
  seen->collisions += number;
  for (size_t n = 0; n < number; ++n) {
    seen->energy_lost -= collisions[n].energy_change;
    if (collisions[n].first == 0) ++seen->of_fast_one; /* `first` has the lower id */
  }
  return 0; /* anything else stops the run */
}

int main(void) {
  static struct needle needles[count];
  for (int n = 0; n < count; ++n) {
    const int place[3] = {n % side, n / side % side, n / side / side};
    for (int axis = 0; axis < 3; ++axis) needles[n].position[axis] = 1.5 * place[axis];
    needles[n].director[n % 3] = 1;
    needles[n].spin[(n + 1) % 3] = 0.01; /* normal to the director */
  }
  needles[0].velocity[0] = 100;
  needles[0].velocity[1] = 10;

  /* Rows are one structure apart, counted in numbers; the three components lie side by side. */
  const ptrdiff_t row = sizeof(struct needle) / sizeof(double);
  const needlework_initial initial = {.count = count,
                                      .box = {15, 15, 15},
                                      .position = {needles->position, row, 1},
                                      .velocity = {needles->velocity, row, 1},
                                      .orientation = {needles->director, row, 1},
                                      .angular_velocity = {needles->spin, row, 1}};
  needlework_error error;
  needlework_simulation* gas = needlework_create_from(
      "collisions = { epsilon = 0.8, tc_relative = 1e-3 }\n", &initial, 0, &error);
  if (!gas) {
    fprintf(stderr, "%s\n", error.message);
    return error.code;
  }
  struct seen seen = {0};
  const needlework_limits limits = {.collisions = 20000, .energy_ratio = 0.1};
  const needlework_state into = {.position = {needles->position, row, 1},
                                 .velocity = {needles->velocity, row, 1}};
  int stop = 0, code = needlework_set_callback(gas, 1000, look, &seen);
  if (code == NEEDLEWORK_OK) code = needlework_run_until(gas, &limits, &stop);
  if (code == NEEDLEWORK_OK) code = needlework_get_state(gas, &into);
  if (code == NEEDLEWORK_OK) {
    printf("%s after %zu collisions in %zu batches, %zu of them of the fast needle\n",
           stop == NEEDLEWORK_STOP_ENERGY ? "9/10 of the energy lost" : "stopped", seen.collisions,
           seen.batches, seen.of_fast_one);
    printf("energy lost %.6g, speed of the fast needle now %.3g along x\n", seen.energy_lost,
           needles[0].velocity[0]);
  } else {
    fprintf(stderr, "%s\n", needlework_message(gas));
  }
  needlework_destroy(gas);
  return code;
}
