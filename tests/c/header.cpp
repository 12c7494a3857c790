// The same as C++.
#include "tests/c/header.c"
