// SPDX-License-Identifier: MIT
// Where an ensemble is integrated: a choice made at run time, by name or by default.
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/core/error.hpp"

namespace myriad {

/// A device: the CPU with at most so many threads (0 stands for OMP_NUM_THREADS or all cores), or a CUDA GPU by its
/// number.
class device {
public:
    /// The kinds of devices.
    enum class kind {
        cpu,   ///< the cores of this machine
        cuda,  ///< a GPU
    };

    /// The CPU with at most `threads` threads; 0: as many as OMP_NUM_THREADS says, or all cores. Throws `error` if
    /// `threads` is negative or above 4096.
    static device cpu(int threads = 0) {
        require(threads >= 0 && threads <= 4096, "the device has ", threads,
                " threads (must be from 1 to 4096, or 0 for all cores)");
        return device(kind::cpu, threads);
    }
    /// Throws `error` if there is no such GPU, or if the program was built without the CUDA backend.
    static device cuda(int number = 0) { return found_gpu(number, message("cuda:", number)); }
    /// The first GPU, if the program was built with CUDA and the machine has one, otherwise the CPU.
    static device best() { return no_gpu().empty() ? cuda(0) : cpu(); }
    /// Why there is no GPU to compute on, or an empty string if there is one.
    static std::string no_gpu() {
        std::string why_none;
        return gpus(why_none).empty() ? why_none : std::string();
    }
    /// "auto", "cpu", "cpu:4" (threads), "cuda" or "cuda:1" (number). Throws `error` for anything else, and for a
    /// device that does not exist.
    static device parse(std::string_view name) {
        if (name == "auto") return best();
        if (name == "cpu") return cpu();
        if (name == "cuda") return found_gpu(0, name);
        if (name.substr(0, 4) == "cpu:") {
            const int threads = number_after(name, 4);
            require(threads > 0, "device \"", name, "\" has no valid number of threads: write cpu:4 for four");
            return cpu(threads);
        }
        if (name.substr(0, 5) == "cuda:") {
            const int number = number_after(name, 5);
            require(number >= 0, "device \"", name, "\" has no valid number: write cuda:0 for the first GPU");
            return found_gpu(number, name);
        }
        throw error(message("device \"", name, "\" is unknown: use auto, cpu, cpu:THREADS, cuda or cuda:NUMBER"));
    }

    /// Whether it is the CPU or a GPU.
    device::kind which() const { return kind_; }
    /// The largest number of threads of a CPU, 0 if none was given; 0 for a GPU.
    int threads() const { return kind_ == kind::cpu ? number_ : 0; }
    /// The number of a GPU, as in `cuda:1`; 0 for the CPU.
    int number() const { return kind_ == kind::cuda ? number_ : 0; }
    /// The name that `parse` understands.
    std::string name() const {
        if (kind_ == kind::cuda) return message("cuda:", number_);
        return number_ == 0 ? "cpu" : message("cpu:", number_);
    }
    /// A human-readable name: a GPU's as its driver gives it.
    std::string description() const {
        if (kind_ == kind::cpu) return "CPU";
        std::string why_none;
        const auto all = gpus(why_none);
        const auto number = static_cast<std::size_t>(number_);
        return number < all.size() ? all[number].name : "GPU that is no longer there";
    }

private:
    friend std::vector<device> devices();
    device(device::kind k, int number) : kind_(k), number_(number) {}

    static std::vector<myriad::cuda::device_facts> gpus(std::string& why_none) {
        auto* const list = host::if_defined(&myriad::cuda::list_devices);
        if (list != nullptr) return list(why_none);
        why_none = "this program was built without the CUDA backend";
        return {};
    }
    static device found_gpu(int number, std::string_view name) {
        std::string why_none;
        const auto count = static_cast<int>(gpus(why_none).size());
        require(count > 0, "device \"", name, "\" is not available: ", why_none, "; use \"cpu\" or \"auto\"");
        require(number >= 0 && number < count, "device \"", name, "\" does not exist: this machine has ", count,
                count == 1 ? " GPU" : " GPUs", ", numbered from 0");
        return device(kind::cuda, number);
    }
    /// The number that the rest of the name consists of, or -1.
    static int number_after(std::string_view name, std::size_t from) {
        int number = 0;
        const char* const end = name.data() + name.size();
        const auto [parsed, failure] = std::from_chars(name.data() + from, end, number);
        return failure == std::errc() && parsed == end ? number : -1;
    }

    device::kind kind_;
    int number_;
};

/// All devices that the program can use, the best first.
[[nodiscard]] inline std::vector<device> devices() {
    std::vector<device> found;
    std::string why_none;
    const auto count = static_cast<int>(device::gpus(why_none).size());
    for (int i = 0; i < count; ++i) found.push_back(device(device::kind::cuda, i));
    found.push_back(device::cpu());
    return found;
}

}  // namespace myriad
