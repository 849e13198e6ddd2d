// SPDX-License-Identifier: MIT
// Rates of devices, and who takes what.
#include "myriad/study/run/work_sharing.hpp"

#include <algorithm>
#include <thread>

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

constexpr std::int64_t per_thread = 64;                   // instances: a few for each lane of a core
constexpr std::int64_t busy_gpu = std::int64_t{1} << 16;  // fewer take as long
constexpr double shortest = 5e-3;                         // seconds of a part of the CPU that its rate is taken from
constexpr double loading = 20;                            // seconds that a kernel takes at the most
constexpr double part_of_time = 0.02;                     // that the others have left, for a part of the CPU
// A device with less of the others' rate costs more, as cores that serve GPUs, than it does.
constexpr double least_of_rate = 0.02;
constexpr double clearly = 1.25;  // rates differ between chunks

}  // namespace

work_sharing::work_sharing(const std::vector<device>& devices, std::int64_t chunk, double tried_after)
    : chunk_(chunk), tried_after_(tried_after) {
    const auto is_cpu = [](const device& d) { return d.which() == device::kind::cpu; };
    const auto first_gpu = std::find_if_not(devices.begin(), devices.end(), is_cpu);
    has_gpu_ = first_gpu != devices.end();
    // To grow with its parts costs a GPU milliseconds, which it has to spare where it may be the slow one of several.
    const bool gpus_differ = std::any_of(first_gpu, devices.end(), [&](const device& d) {
        return !is_cpu(d) && d.description() != first_gpu->description();
    });
    for (const device& d : devices) {
        pace p{.is_cpu = is_cpu(d), .first_part = chunk};
        const int threads = d.threads() > 0 ? d.threads() : static_cast<int>(std::thread::hardware_concurrency());
        if (p.is_cpu) p.first_part = per_thread * std::max(threads, 1);
        if (!p.is_cpu && gpus_differ) p.first_part = std::max(chunk / 8, busy_gpu);
        paces_.push_back(p);
        is_mixed_ = is_mixed_ || (devices.size() > 1 && (p.is_cpu || gpus_differ));
    }
}

work_sharing::others work_sharing::without(std::size_t number) const {
    others found;
    for (std::size_t i = 0; i < paces_.size(); ++i) {
        const pace& its = paces_[i];
        if (i == number || its.is_dropped) continue;
        const double rate = its.per_second > 0 ? its.per_second : its.at_least;
        found.together += rate;
        found.fastest = std::max(found.fastest, rate);
        found.are_known = found.are_known && its.per_second > 0;
        found.any = true;
    }
    return found;
}

std::int64_t work_sharing::part(std::size_t number, std::int64_t rest, std::int64_t left) const {
    const std::lock_guard lock(mutex_);
    const pace& mine = paces_[number];
    if (!is_mixed_ || (!mine.is_cpu && mine.per_second > 0)) return rest;
    if (mine.last_part == 0) return std::min(rest, mine.first_part);
    const auto [together, fastest, are_known, any] = without(number);
    if (mine.per_second <= 0 || together <= 0 || !are_known) return std::min(rest, 2 * mine.last_part);
    const double count = mine.per_second * part_of_time * static_cast<double>(left) / together;
    if (count >= static_cast<double>(rest)) return rest;
    return std::min(rest, std::max(static_cast<std::int64_t>(count), mine.first_part));
}

void work_sharing::measured(std::size_t number, std::int64_t instances, double seconds) {
    const std::lock_guard lock(mutex_);
    pace& mine = paces_[number];
    ++mine.calls;
    mine.last_part = std::max(mine.last_part, instances);
    if (seconds > 0) mine.at_least = static_cast<double>(instances) / seconds;
    // A GPU's first call may take long for its kernel to be loaded, but not as long as that.
    if (seconds > 0 && (mine.is_cpu ? seconds >= shortest || instances == chunk_ : mine.calls > 1 || seconds > loading))
        mine.per_second = mine.at_least;
}

void work_sharing::gave_back(std::size_t number, std::int64_t instances, double seconds) {
    const std::lock_guard lock(mutex_);
    pace& mine = paces_[number];
    if (mine.per_second <= 0 && seconds > 0) mine.per_second = static_cast<double>(instances + 1) / seconds;
}

void work_sharing::drop(std::size_t number) {
    const std::lock_guard lock(mutex_);
    paces_[number].is_dropped = true;
}

bool work_sharing::is_known(std::size_t number) const {
    const std::lock_guard lock(mutex_);
    return !is_mixed_ || paces_[number].per_second > 0;
}

bool work_sharing::is_worthwhile(std::size_t number, std::int64_t rest, std::int64_t left, double now) const {
    const std::lock_guard lock(mutex_);
    const double mine = paces_[number].per_second;
    const auto [together, fastest, are_known, any] = without(number);
    if (any && has_gpu_ && paces_[number].is_cpu && paces_[number].calls == 0 && now < tried_after_ &&
        !(are_known && static_cast<double>(left) / together >= tried_after_))
        return false;
    if (mine <= 0 || together <= 0 || mine >= fastest) return true;
    return mine >= least_of_rate * together && static_cast<double>(rest) / mine <= static_cast<double>(left) / together;
}

bool work_sharing::is_better_off_with(std::size_t idle, std::size_t other, std::int64_t rest, std::int64_t done,
                                      double seconds) const {
    const std::lock_guard lock(mutex_);
    const double mine = paces_[idle].at_least;
    double its = paces_[other].per_second;
    if (its <= 0 && seconds >= shortest) its = static_cast<double>(done + 1) / seconds;
    return is_mixed_ && idle != other && mine > 0 && its > 0 &&
           static_cast<double>(rest) / its > shortest + clearly * static_cast<double>(chunk_) / mine;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
