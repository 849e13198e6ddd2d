// SPDX-License-Identifier: MIT
// Where an ensemble is integrated: a choice made at run time, by name or by default.
#pragma once

#include <string>
#include <string_view>
#include <vector>

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
    static device cpu(int threads = 0);
    /// Throws `error` if there is no such GPU, or if the program was built without the CUDA backend.
    static device cuda(int number = 0);
    /// The first GPU, if the program was built with CUDA and the machine has one, otherwise the CPU.
    static device best();
    /// Why there is no GPU to compute on, or an empty string if there is one.
    static std::string no_gpu();
    /// "auto", "cpu", "cpu:4" (threads), "cuda" or "cuda:1" (number). Throws `error` for anything else, and for a
    /// device that does not exist.
    static device parse(std::string_view name);

    /// Whether it is the CPU or a GPU.
    device::kind which() const { return kind_; }
    /// The largest number of threads of a CPU, 0 if none was given; 0 for a GPU.
    int threads() const { return kind_ == kind::cpu ? number_ : 0; }
    /// The number of a GPU, as in `cuda:1`; 0 for the CPU.
    int number() const { return kind_ == kind::cuda ? number_ : 0; }
    /// The name that `parse` understands.
    std::string name() const;
    /// A human-readable name: a GPU's as its driver gives it.
    std::string description() const;

private:
    friend std::vector<device> devices();
    device(device::kind k, int number) : kind_(k), number_(number) {}

    static device found_gpu(int number, std::string_view name);

    device::kind kind_;
    int number_;
};

/// All devices that the program can use, the best first.
[[nodiscard]] std::vector<device> devices();

}  // namespace myriad
