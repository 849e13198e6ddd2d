// SPDX-License-Identifier: MIT
// Threads add to one number without synchronisation: the thread sanitizer must report it.
#include <cstdio>

int main() {
    long sum = 0;
#pragma omp parallel for num_threads(4) default(none) shared(sum)
    for (int i = 0; i < 20000; ++i) sum += 1;
    std::printf("%ld\n", sum);
}
