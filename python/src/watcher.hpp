// SPDX-License-Identifier: MIT
// What Python does while a call runs: its progress function, and signals.
#pragma once

#include <chrono>
#include <cstdint>

#include <nanobind/nanobind.h>

#include "run.hpp"

namespace myriad::python {

namespace nb = nanobind;

/// Calls Python's progress function, if there is one, and looks for signals, a few times a second, from threads that do
/// not hold Python's lock.
class watcher {
public:
    explicit watcher(nb::handle function) : function_(function) {}
    watcher(const watcher&) = delete;
    watcher& operator=(const watcher&) = delete;
    ~watcher() {
        if (!failure) return;
        const nb::gil_scoped_acquire locked;
        failure.reset();
    }

    /// Throws `interruption` once Python has raised an exception, which is kept.
    void operator()(std::int64_t done, std::int64_t total) {
        const auto now = std::chrono::steady_clock::now();
        if ((done < total || function_.is_none()) && now - last_ < std::chrono::milliseconds{50}) return;
        last_ = now;
        const nb::gil_scoped_acquire locked;
        try {
            if (PyErr_CheckSignals() != 0) throw nb::python_error();
            if (!function_.is_none()) function_(done, total);
        } catch (nb::python_error& raised) {
            failure = nb::borrow(raised.value());
            throw interruption{};
        }
    }

    nb::object failure;

private:
    nb::handle function_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace myriad::python
