// SPDX-License-Identifier: MIT
// Finds devices, and understands their names.
#include "myriad/host/backend/device.hpp"

#include <charconv>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/core/error.hpp"

namespace myriad {

namespace {

std::vector<myriad::cuda::device_facts> gpus(std::string& why_none) {
    auto* const list = host::if_defined(&myriad::cuda::list_devices);
    if (list != nullptr) return list(why_none);
    why_none = "this program was built without the CUDA backend";
    return {};
}
/// The number that the rest of the name consists of, or -1.
int number_after(std::string_view name, std::size_t from) {
    int number = 0;
    const char* const end = name.data() + name.size();
    const auto [parsed, failure] = std::from_chars(name.data() + from, end, number);
    return failure == std::errc() && parsed == end ? number : -1;
}

}  // namespace

device device::cpu(int threads) {
    require(threads >= 0 && threads <= 4096, "device \"cpu:", threads, "\" has ", threads,
            " threads (must be from 1 to 4096, or 0 for all cores)");
    return device(kind::cpu, threads);
}
device device::cuda(int number) { return found_gpu(number, message("cuda:", number)); }
device device::best() { return no_gpu().empty() ? cuda(0) : cpu(); }
std::string device::no_gpu() {
    std::string why_none;
    return gpus(why_none).empty() ? why_none : std::string();
}
device device::parse(std::string_view name) {
    if (name == "auto") return best();
    if (name == "cpu") return cpu();
    if (name == "cuda") return found_gpu(0, name);
    if (name.substr(0, 4) == "cpu:") {
        const int threads = number_after(name, 4);
        require(threads > 0, "device \"", name, "\" has no valid number of threads", host::cure,
                "write cpu:4 for four");
        return cpu(threads);
    }
    if (name.substr(0, 5) == "cuda:") {
        const int number = number_after(name, 5);
        require(number >= 0, "device \"", name, "\" has no valid number", host::cure, "write cuda:0 for the first GPU");
        return found_gpu(number, name);
    }
    host::refuse({"device \"", name, "\" is unknown", host::cure, "use auto, cpu, cpu:THREADS, cuda or cuda:NUMBER"});
}

std::string device::name() const {
    if (kind_ == kind::cuda) return message("cuda:", number_);
    return number_ == 0 ? "cpu" : message("cpu:", number_);
}
std::string device::description() const {
    if (kind_ == kind::cpu) return "CPU";
    std::string why_none;
    const auto all = gpus(why_none);
    const auto number = static_cast<std::size_t>(number_);
    return number < all.size() ? all[number].name : "GPU that is no longer there";
}

device device::found_gpu(int number, std::string_view name) {
    std::string why_none;
    const auto count = static_cast<int>(gpus(why_none).size());
    require(count > 0, "device \"", name, "\" is not available: ", why_none, "; use \"cpu\" or \"auto\"");
    require(number >= 0 && number < count, "device \"", name, "\" does not exist: this machine has ", count,
            count == 1 ? " GPU" : " GPUs", ", numbered from 0");
    return device(kind::cuda, number);
}

std::vector<device> devices() {
    std::vector<device> found;
    std::string why_none;
    const auto count = static_cast<int>(gpus(why_none).size());
    for (int i = 0; i < count; ++i) found.push_back(device(device::kind::cuda, i));
    found.push_back(device::cpu());
    return found;
}

}  // namespace myriad
