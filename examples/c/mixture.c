/* Two species: names, temperatures, and collisions of each pair. */
#include <needlework.h>
#include <stdio.h>

static const char* scene =
    "needles.box = 8\n"
    "collisions = { epsilon = 0.9, tc_relative = 1e-3 }\n"
    "until.collisions_per_needle = 20\n"
    "[[species]]\nname = \"light\"\ncount = 400\n"
    "[[species]]\nname = \"heavy\"\ncount = 100\nmass = 8\nlength = 2\n";

int main(void) {
  needlework_error error;
  needlework_simulation* gas = needlework_create(scene, 0, &error);
  if (!gas) return fprintf(stderr, "%s\n", error.message), error.code;
  int code = needlework_run_until(gas, NULL, NULL);
  const char* name;
  for (size_t n = 0; code == NEEDLEWORK_OK && (name = needlework_species_name(gas, n)); ++n) {
    needlework_species species;
    code = needlework_get_species(gas, n, &species);
    if (code == NEEDLEWORK_OK)
      printf("%s: T_tr %.3f, T_rot %.3f\n", name, species.t_tr, species.t_rot);
  }
  needlework_species_pair pair;
  if (code == NEEDLEWORK_OK) code = needlework_get_species_pair(gas, 0, 1, &pair);
  if (code == NEEDLEWORK_OK)
    printf("light with heavy: %llu\n", (unsigned long long)pair.collisions);
  else
    fprintf(stderr, "%s\n", needlework_message(gas));
  needlework_destroy(gas);
  return code;
}
