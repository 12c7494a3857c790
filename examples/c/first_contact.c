/* The first contact of one pair: a sphere falls onto the side of a rod. */
#include <needlework.h>
#include <stdio.h>

int main(void) {
  const double r1[] = {0, 0, 0}, u1[] = {1, 0, 0}, rest[] = {0, 0, 0};
  const double r2[] = {0.25, 0, 2}, u2[] = {0, 1, 0}, v2[] = {0, 0, -1};
  const double horizon[] = {10}, length1[] = {5}, length2[] = {0}, diameter[] = {1};
  const needlework_pairs pairs = {.count = 1,
                                  .r1 = {r1, 0, 0},
                                  .u1 = {u1, 0, 0},
                                  .v1 = {rest, 0, 0},
                                  .w1 = {rest, 0, 0},
                                  .r2 = {r2, 0, 0},
                                  .u2 = {u2, 0, 0},
                                  .v2 = {v2, 0, 0},
                                  .w2 = {rest, 0, 0},
                                  .horizon = horizon};
  const needlework_pair_sizes sizes = {
      .length1 = length1, .length2 = length2, .diameter1 = diameter, .diameter2 = diameter};
  double time, s12, s21;
  needlework_error error;
  int code = needlework_predict_with_sizes(&pairs, &sizes, &time, &s12, &s21, &error);
  if (code == NEEDLEWORK_OK)
    printf("time %g, %g from the centre of the rod\n", time, s12);
  else
    fprintf(stderr, "%s\n", error.message);
  return code;
}
