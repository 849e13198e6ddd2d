// SPDX-License-Identifier: MIT
// Where an ensemble is integrated: a choice made at run time, by name or by default.
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "myriad/core/error.hpp"

namespace myriad {

/// A device. The CPU takes a number of threads; 0 stands for OMP_NUM_THREADS or all cores.
class device {
public:
    enum class kind { cpu };

    static device cpu(int threads = 0) {
        require(threads >= 0 && threads <= 4096, "the device has ", threads,
                " threads (must be from 1 to 4096, or 0 for all cores)");
        return device(kind::cpu, threads);
    }
    /// The fastest device of this machine that the program was built for.
    static device best() { return cpu(); }
    /// "auto", "cpu" or "cpu:4" (threads). Throws `error` for anything else.
    static device parse(std::string_view name) {
        if (name == "auto") return best();
        if (name == "cpu") return cpu();
        if (name.substr(0, 4) == "cpu:") {
            int threads = 0;
            const char* const end = name.data() + name.size();
            const auto [parsed, failure] = std::from_chars(name.data() + 4, end, threads);
            require(failure == std::errc() && parsed == end && threads > 0, "device \"", name,
                    "\" has no valid number of threads: write cpu:4 for four");
            return cpu(threads);
        }
        require(name.substr(0, 4) != "cuda", "device \"", name,
                "\" is not available: this program was built without the CUDA backend; use \"cpu\" or \"auto\"");
        throw error(message("device \"", name, "\" is unknown: use auto, cpu or cpu:THREADS"));
    }

    device::kind which() const { return kind_; }
    int threads() const { return threads_; }
    /// The name that `parse` understands.
    std::string name() const { return threads_ == 0 ? "cpu" : message("cpu:", threads_); }

private:
    device(device::kind k, int threads) : kind_(k), threads_(threads) {}

    device::kind kind_;
    int threads_;
};

/// All devices that the program can use, the best first.
inline std::vector<device> devices() { return {device::cpu()}; }

}  // namespace myriad
