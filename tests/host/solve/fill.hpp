// SPDX-License-Identifier: MIT
// Ensembles of the test models, the same on every device, and comparisons of all that a kernel writes.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include <myriad/myriad.hpp>

#include "tests/host/solve/models.hpp"
#include "tests/support/device.hpp"

namespace solving {

/// Sets slot `at` to swing number i of an endless family.
template <class R>
void set_swing(myriad::ensemble<swing, R>& e, std::int64_t at, std::int64_t i) {
    const auto spread = [i](std::int64_t k) { return static_cast<R>(((i + k) * 7919) % 10007) / R(10007); };
    e.state(swing::x)(at) = spread(1);
    e.state(swing::v)(at) = spread(2) - R(0.5);
    e.parameter(swing::damping)(at) = R(0.05) + R(0.1) * spread(3);
    e.parameter(swing::drive)(at) = R(0.5) + spread(4);
    e.accessory(swing::highest)(at) = R(0);
    e.accessory(swing::my_number)(at) = R(-1);
    e.integer_accessory(swing::impacts)(at) = 0;
    e.t_begin()(at) = R(0);
    e.t_end()(at) = R(3) + R(4) * spread(5);
}

template <class R>
void fill(myriad::ensemble<swing, R>& e, std::int64_t from = 0) {
    for (std::int64_t i = 0; i < e.size(); ++i) set_swing(e, i, from + i);
    e.shared(swing::stiffness) = R(1.5);
    e.shared(swing::bounce) = R(0.7);
    e.shared_integer(swing::weight) = 2;
}

template <class Map>
bool same_bits(const Map& a, const Map& b) {
    return a.size() == b.size() &&
           std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(typename Map::Scalar)) == 0;
}

/// Whether all results of the first `count` instances (by default all) are the same bits.
template <class Model, class R>
bool same_results(const myriad::ensemble<Model, R>& a, const myriad::ensemble<Model, R>& b) {
    bool same = same_bits(a.t(), b.t()) && same_bits(a.next_step(), b.next_step()) &&
                same_bits(a.phases_done(), b.phases_done());
    for (int c = 0; c < myriad::detail::n_state<Model>; ++c) same = same && same_bits(a.state(c), b.state(c));
    for (int c = 0; c < myriad::detail::n_parameter<Model>; ++c)
        same = same && same_bits(a.parameter(c), b.parameter(c));
    for (int c = 0; c < myriad::detail::n_accessory<Model>; ++c)
        if (c != swing::my_number) same = same && same_bits(a.accessory(c), b.accessory(c));
    for (int c = 0; c < myriad::detail::n_integer_accessory<Model>; ++c)
        same = same && same_bits(a.integer_accessory(c), b.integer_accessory(c));
    for (std::int64_t i = 0; i < a.size(); ++i) same = same && a.status(i) == b.status(i);
    return same && same_bits(a.accepted_steps(), b.accepted_steps()) &&
           same_bits(a.rhs_evaluations(), b.rhs_evaluations());
}

inline myriad::options usual() {
    myriad::options o;
    o.phases = 3;
    o.relative_tolerance = 1e-8;
    o.absolute_tolerance = 1e-8;
    o.events = {{.direction = myriad::direction::falling, .tolerance = 1e-8}};
    return o;
}

inline myriad::options usual_float() {
    myriad::options o = usual();
    o.relative_tolerance = 1e-4;
    o.absolute_tolerance = 1e-4;
    o.events[0].tolerance = 1e-4;
    return o;
}

}  // namespace solving
