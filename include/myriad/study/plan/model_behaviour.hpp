// SPDX-License-Identifier: MIT
// What a study's model does, by which a store tells it from others: what its functions give for a few instances.
// Host code only.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "myriad/host/checks/shown_values.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/plan/component_names.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// Values of a model's functions by what they are, in a study's words, at a few places.
class model_behaviour {
public:
    /// One of them at all places: nothing where an action changes nothing, or a function has none.
    using values = std::vector<std::optional<double>>;

    /// Of what a store has.
    explicit model_behaviour(std::map<std::string, values> all = {}) : all_(std::move(all)) {}
    /// Calls `show(instance, place, to, take)` for some of `instances`. `epsilon`: of the real type.
    using shower = std::function<void(std::int64_t instance, const detail::shown_place& place, void* to,
                                      void (*take)(void* to, const detail::shown_value&))>;
    model_behaviour(const component_names& names, std::int64_t instances, double epsilon, const shower& show);

    bool empty() const { return all_.empty(); }
    const std::map<std::string, values>& all() const { return all_; }
    /// What differs by more than rounding between a model here and that of a store.
    std::vector<statement> differences_from(const model_behaviour& stored) const;

private:
    void add_places(const component_names& names, std::int64_t instance, const shower& show);

    std::map<std::string, values> all_;
    std::map<std::string, std::vector<double>> rounding_;  // what the values here may differ by
    std::map<std::string, statement> said_;
    std::size_t places_ = 0;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
