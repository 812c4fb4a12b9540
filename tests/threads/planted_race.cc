// Two threads add to one number without order: the thread sanitizer must see it, or its silence elsewhere says nothing.
#include <cstdio>

int main() {
  double sum = 0;
#pragma omp parallel for num_threads(2)
  for (int k = 0; k < 100000; ++k) sum += k;
  std::printf("%g\n", sum);
}
