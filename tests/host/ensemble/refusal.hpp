// SPDX-License-Identifier: MIT
// The library's messages about bad input, and ensembles to provoke them.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/host/ensemble/models.hpp"

/// Checks that the call is refused, and that the message has all the given words: the problem, why it is one, what to
/// do.
template <class Call>
void refused(Call&& call, std::initializer_list<const char*> words) {
    std::string said = "(not refused)";
    try {
        call();
    } catch (const myriad::error& e) {
        said = e.what();
    }
    INFO("the message: " << said);
    for (const char* word : words) {
        INFO("expected in it: " << word);
        CHECK(said.find(word) != std::string::npos);
    }
}

/// Decays that can be integrated over [0, 1], each instance with another rate.
template <class R = double>
myriad::ensemble<ensemble_models::bare, R> good_decays(std::int64_t size = 5) {
    using ensemble_models::bare;
    myriad::ensemble<bare, R> e(size);
    e.state(bare::x) = R(1);
    e.state(bare::w) = R(0);
    for (std::int64_t i = 0; i < size; ++i) e.parameter(bare::rate)[i] = R(0.5) + R(0.125) * static_cast<R>(i % 16);
    e.time_domain(0, 1);
    return e;
}

/// Oscillators with everything set.
inline myriad::ensemble<ensemble_models::complete> good_oscillators(std::int64_t size = 5) {
    using ensemble_models::complete;
    myriad::ensemble<complete> e(size);
    e.state(complete::x) = 1.0;
    e.state(complete::v) = 0.5;
    for (std::int64_t i = 0; i < size; ++i) e.parameter(complete::rate)[i] = 1.0 + 0.25 * static_cast<double>(i % 16);
    e.parameter(complete::force) = 0.0;
    e.shared(complete::scale) = 1.0;
    e.shared_integer(complete::sign) = 1;
    e.time_domain(0, 10);
    return e;
}

/// Points that travel to x = 1 from 0, each at another speed.
inline myriad::ensemble<ensemble_models::watched> good_travellers(std::int64_t size = 5) {
    using ensemble_models::watched;
    myriad::ensemble<watched> e(size);
    e.state(watched::x) = 0.0;
    for (std::int64_t i = 0; i < size; ++i) e.parameter(watched::rate)[i] = 1.0 + static_cast<double>(i);
    e.time_domain(0, 10);
    return e;
}
