#include <cstdio>

int main() {
  std::puts("eigengrain");
  return 0;
}
