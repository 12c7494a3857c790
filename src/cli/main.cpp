// The program: a client of the library.
int main() { return 0; }
