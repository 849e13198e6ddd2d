// SPDX-License-Identifier: MIT
// Memory that hooks and right-hand sides write to for a test: the host's own on the CPU, and on a GPU one managed
// variable per file of kernels, which the host finds through a list.
#pragma once

#include <vector>

#include <myriad/gpu/runtime.hpp>

#include "tests/support/device.hpp"

namespace tests {

/// The variables of type T that kernels write to. They are only read if the tests run on a GPU: without a driver they
/// have no memory.
template <class T>
std::vector<T& (*)()>& kernel_variables() {
    static std::vector<T& (*)()> list;
    return list;
}

/// Calls `visit` for each of them.
template <class T, class Visit>
void for_each_kernel_variable(Visit&& visit) {
    if (tests_cpu()) return;
    for (auto* const variable : kernel_variables<T>()) visit(variable());
}

}  // namespace tests

#if MYRIAD_FOR_GPU
/// A managed variable of this file, and its entry in the list.
#define MYRIAD_TEST_KERNEL_VARIABLE(T, name)             \
    static __managed__ T name;                           \
    static const bool name##_is_listed = [] {            \
        T& (*const get)() = []() -> T& { return name; }; \
        tests::kernel_variables<T>().push_back(get);     \
        return true;                                     \
    }();
#endif
