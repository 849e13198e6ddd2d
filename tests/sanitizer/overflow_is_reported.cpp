// SPDX-License-Identifier: MIT
// Reads past the end of an array: the address sanitizer must report it.
#include <cstdio>
#include <vector>

int main(int argc, char*[]) {
    std::vector<int> values(4, 1);
    const int* data = values.data();
    std::printf("%d\n", data[3 + argc]);
}
