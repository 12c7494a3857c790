// A program as someone else would write it: numbers of kinetic theory, without a run.
#include <needlework/boltzmann.h>
#include <needlework/theory.h>

#include <cstdio>

int main() {
  const double rate = needlework::theory::collision_rate(0.4, {1, 1}, 6);
  const double ratio = needlework::theory::asymptotic_ratio({6, 0.9, -1});
  std::printf("%.15g collisions per needle and time, T_tr/T_rot = %.15g\n", rate, ratio);
  return rate > 0 && ratio > 1 ? 0 : 1;
}
