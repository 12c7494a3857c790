/* Data of your own, which checkpoints and the output file carry. */
#include <needlework.h>
#include <stdio.h>
#include <string.h>

int main(void) {
  needlework_error error;
  needlework_simulation* gas = needlework_create("needles = { count = 10, box = 5 }\n", 0, &error);
  if (!gas) return fprintf(stderr, "%s\n", error.message), error.code;
  const char notes[] = "{\"lid\": \"open\"}";
  char text[100];
  size_t size = 0;
  int code = needlework_set_data(gas, "notes", NEEDLEWORK_DATA_JSON, notes, strlen(notes));
  if (code == NEEDLEWORK_OK)
    code = needlework_get_data(gas, "notes", NULL, text, sizeof text, &size);
  if (code == NEEDLEWORK_OK)
    printf("%s: %.*s\n", needlework_data_name(gas, 0), (int)size, text);
  else
    fprintf(stderr, "%s\n", needlework_message(gas));
  needlework_destroy(gas);
  return code;
}
