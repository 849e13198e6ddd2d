// SPDX-License-Identifier: MIT
// The table of options: what checks, files, other languages and lists for readers know of each. An option that is added
// to it is read from TOML, checked, described in a study's folder, and set from Python.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

// ---------------------------------------------------------------------------------------------------------------------
// Choices
// ---------------------------------------------------------------------------------------------------------------------

/// A value of an enumeration by its name in the code.
template <class E>
struct choice {
    const char* name;
    E value;
};

constexpr std::array<choice<direction>, 4> choices(direction) {
    using enum direction;
    return {{{"falling", falling}, {"either", either}, {"rising", rising}, {"none", none}}};
}
constexpr std::array<choice<phase_time>, 2> choices(phase_time) {
    using enum phase_time;
    return {{{"restart", restart}, {"carry_on", carry_on}}};
}
constexpr std::array<choice<phase_step>, 2> choices(phase_step) {
    using enum phase_step;
    return {{{"restart", restart}, {"carry_on", carry_on}}};
}
constexpr std::array<choice<counting>, 2> choices(counting) {
    using enum counting;
    return {{{"off", off}, {"on", on}}};
}
constexpr std::array<choice<advice>, 2> choices(advice) {
    using enum advice;
    return {{{"off", off}, {"on", on}}};
}
constexpr std::array<choice<invalid_instances>, 2> choices(invalid_instances) {
    using enum invalid_instances;
    return {{{"refuse", refuse}, {"mark", mark}}};
}
template <class E>
requires(std::is_same_v<E, schedule> ||
         std::is_same_v<E, shared_placement>) constexpr std::array<choice<E>, 4> choices(E) {
    std::array<choice<E>, 4> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = {name_of(static_cast<E>(i)), static_cast<E>(i)};
    return all;
}

/// The name of a value; null if it is none of its enumeration.
template <class E>
constexpr const char* name_of_choice(E value) {
    for (const choice<E>& c : choices(E{}))
        if (c.value == value) return c.name;
    return nullptr;
}

// ---------------------------------------------------------------------------------------------------------------------
// Entries
// ---------------------------------------------------------------------------------------------------------------------

/// What an option has an effect on.
enum class option_effect {
    results,  ///< the results: it is part of a study's description
    run,      ///< the way to them, and what a report tells of it
    call,     ///< the same of a call of `solve`: studies, which go on where they were stopped, have none of these
};

/// The numbers that an option may be: from `least` to `most`. NaN is none of them.
struct number_range {
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
    bool without_least = false, without_most = false;
    bool or_zero = false;  ///< 0, too, which stands for no such choice

    constexpr bool contains(double value) const {
        if (value == 0 && or_zero) return true;
        return (without_least ? value > least : value >= least) && (without_most ? value < most : value <= most);
    }
};
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr number_range from_to(double least, double most) { return {least, most}; }
constexpr number_range zero_or(number_range r) {
    r.or_zero = true;
    return r;
}
constexpr number_range between(double below, double above) { return {below, above, true, true}; }
/// Finite ones of at least a number.
constexpr number_range at_least(double least) { return {least, infinite, false, true}; }
constexpr number_range positive{0, infinite, true, false};
constexpr number_range positive_and_finite = between(0, infinite);

/// An option: a member of `Group`, which is `options` or one of the structs in it.
template <class Group, class T>
struct option_entry {
    using value_type = T;

    const char* name;            ///< of the member
    T Group::*member;            ///< where its value is
    option_effect effect;        ///< what it has an effect on
    const char* unit;            ///< of numbers, such as "time"; of component lists their kind; else empty
    number_range range;          ///< of numbers
    const char* meaning;         ///< for readers: a sentence without a full stop
    const char* cure = nullptr;  ///< what to give instead of a number out of range

    constexpr option_entry(const char* option, T Group::*which, option_effect on, const char* of,
                           const number_range& allowed, const char* sentence, const char* remedy = nullptr)
        : name(option), member(which), effect(on), unit(of), range(allowed), meaning(sentence), cure(remedy) {}
    constexpr option_entry(const char* option, T Group::*which, option_effect on, const char* sentence)
        : option_entry(option, which, on, "", {}, sentence) {}
    constexpr option_entry(const char* option, T Group::*which, option_effect on, const char* of, const char* sentence)
        : option_entry(option, which, on, of, {}, sentence) {}

    /// Whether numbers are in the ensemble's real type while it is integrated.
    constexpr bool is_real() const {
        const std::string_view of = unit;
        return of == "time" || of == "event function";
    }
};

/// The entries of a struct of options, in the order of its members.
template <class Group>
struct option_table;

template <>
struct option_table<event_options> {
    using o = event_options;
    using enum option_effect;
    static constexpr const char* path = "events";
    static constexpr auto all = std::tuple{
        option_entry{"direction", &o::direction, results, "which sign changes count, in the direction of integration"},
        option_entry{
            "tolerance", &o::tolerance, results, "event function", at_least(0),
            "value of the event function up to which an event is located; 0: as closely as t and the state resolve",
            "give the |g| at which an event counts as located, such as 1e-6, or 0 for as close as t and the "
            "state resolve"},
        option_entry{"stop_after", &o::stop_after, results, "", from_to(0, 2e9),
                     "detections in a phase that end it, as `stopped_by_event`; 0: never"},
    };
};

template <>
struct option_table<record_options> {
    using o = record_options;
    using enum option_effect;
    static constexpr const char* path = "record";
    static constexpr auto all = std::tuple{
        option_entry{"from_phase", &o::from_phase, results, "", from_to(0, infinite),
                     "first phase of the call that is kept"},
        option_entry{"states", &o::states, results, "state", "states to keep at the end of each phase"},
        option_entry{"accessories", &o::accessories, results, "accessory", "accessories to keep"},
        option_entry{"integer_accessories", &o::integer_accessories, results, "integer_accessory",
                     "integer accessories to keep"},
        option_entry{"time", &o::time, results, "whether the time is kept"},
    };
};

template <>
struct option_table<sample_options> {
    using o = sample_options;
    using enum option_effect;
    static constexpr const char* path = "samples";
    static constexpr auto all = std::tuple{
        option_entry{"states", &o::states, results, "state", "states to sample along every trajectory"},
        option_entry{"capacity", &o::capacity, results, "", from_to(1, 2e9),
                     "samples kept per instance, over all phases and calls",
                     "give the number of samples to keep per instance"},
        option_entry{"evenly", &o::evenly, results, "", zero_or(from_to(2, 2e9)),
                     "number of evenly spaced times in each phase, ends included"},
        option_entry{"times", &o::times, results, "time", "or these times in each phase"},
        option_entry{"times_of_instances", &o::times_of_instances, call, "time", "or times of each instance"},
        option_entry{"every", &o::every, results, "", zero_or(from_to(1, 2e9)),
                     "or the ends of every n-th accepted step"},
        option_entry{"minimum_spacing", &o::minimum_spacing, results, "time", at_least(0),
                     "least time between samples by steps"},
        option_entry{"from_phase", &o::from_phase, results, "", from_to(0, infinite),
                     "first phase of the call that is sampled"},
    };
};

template <>
struct option_table<options> {
    using o = options;
    using enum option_effect;
    static constexpr const char* path = "";
    static constexpr auto all = std::tuple{
        option_entry{"phases", &o::phases, results, "", from_to(1, 1e9), "integration phases in this call"},
        option_entry{"relative_tolerance", &o::relative_tolerance, results, "", at_least(0),
                     "error per step over the magnitude of a state: one value, or one per state"},
        option_entry{"absolute_tolerance", &o::absolute_tolerance, results, "state", at_least(0),
                     "error per step: one value, or one per state"},
        option_entry{"step", &o::step, results, "time", positive_and_finite,
                     "first step of a phase, which else follows from slope, tolerances and domain; for fixed steps "
                     "their length, which must be given",
                     "give the length of the first step to try, or that of the fixed step; the direction follows from "
                     "t_end"},
        option_entry{"minimum_step", &o::minimum_step, results, "time", at_least(0),
                     "smallest step size; 0: the resolution of t", "give 0 for the resolution of t"},
        option_entry{"maximum_step", &o::maximum_step, results, "time", positive, "largest step size"},
        option_entry{"growth_limit", &o::growth_limit, results, "", at_least(1),
                     "largest factor from one step to the next",
                     "give the largest factor from one step to the next, such as 5"},
        option_entry{"shrink_limit", &o::shrink_limit, results, "", between(0, 1),
                     "smallest factor from one step to the next",
                     "give the smallest factor from one step to the next, such as 0.1"},
        option_entry{"max_steps", &o::max_steps, results, "", zero_or(from_to(1, 2e9)),
                     "trial steps per phase; an instance that needs more ends as `max_steps`; 0: 200 000 adaptive "
                     "steps, or 2e9 fixed ones (in single precision 1.6e7)"},
        option_entry{"time_limit", &o::time_limit, call, "seconds", from_to(0, infinite),
                     "time from the beginning of the call after which what is left ends as `interrupted`: instances "
                     "under way where they are, the others as they were; 0: no limit",
                     "give the seconds that the call may take, or 0 for no limit"},
        option_entry{"phase_time", &o::phase_time, results,
                     "a phase starts at t_begin, or where the last one ended (`carry_on`), for phases that events or "
                     "hooks end"},
        option_entry{"phase_length", &o::phase_length, results, "time", at_least(0),
                     "time continues from phase to phase, and phases end at t_begin + length, + 2 length, ...; 0: "
                     "phases go to t_end",
                     "give the length of a phase, whose direction follows from t_end, or 0 for phases that go to "
                     "t_end"},
        option_entry{"phase_step", &o::phase_step, results,
                     "a phase starts with `step`, or with the last step size (`carry_on`)"},
        option_entry{"seed", &o::seed, results, "", from_to(0, 4294967295.0),
                     "seed of the paths of a stochastic equation", "give a whole number from 0 on"},
        option_entry{"noise_step", &o::noise_step, results, "time", at_least(0),
                     "cells of these paths: steps that are a multiple of one, or a number of 65536ths of one, follow "
                     "the same path; the longest adaptive step; 0: the step, or for adaptive ones a 64th of the domain "
                     "or phase",
                     "give the longest of the steps that are to follow one path, or 0 for the step"},
        option_entry{"history_steps", &o::history_steps, results, "steps", from_to(0, 1048576),
                     "steps of the past that are kept of each instance of a model with delays; 0: 256 adaptive steps, "
                     "1024 fixed ones, or in Python those of the longest constant lag",
                     "give the steps over the longest delay and a few more, or 0"},
        option_entry{"events", &o::events, results,
                     "how events are detected: one entry for each; none: defaults for all"},
        option_entry{"sub_samples", &o::sub_samples, results, "", from_to(1, 1e4),
                     "points per step at which event functions are evaluated, and with two or more also where they "
                     "turn: what crosses zero and comes back within a step is found"},
        option_entry{"accumulation_limit", &o::accumulation_limit, results, "", from_to(1, 65535),
                     "repeated actions of one event without leaving its surface, after which the instance ends as "
                     "`event_accumulation`"},
        option_entry{"record", &o::record, results, "what to keep at the end of each phase"},
        option_entry{"samples", &o::samples, results, "dense output, in C++ of a method `dense<method>`"},
        option_entry{"counting", &o::counting, run, "whether steps and evaluations are counted per instance"},
        option_entry{"advice", &o::advice, run,
                     "whether to check after the call, if it took many steps, for stiffness (with some evaluations of "
                     "`rhs` on the host) and for phases too long for Lyapunov exponents"},
        option_entry{"invalid_instances", &o::invalid_instances, call,
                     "for inputs that are not finite, or new states or parameters of instances that have ended: refuse "
                     "the call, or mark the former, skip the latter, and run the rest"},
        option_entry{"schedule", &o::schedule, run,
                     "order in which instances are integrated; changes no bit of the results"},
        option_entry{"block_size", &o::block_size, run, "", zero_or(from_to(32, 1024)),
                     "CUDA threads per block; 0: the size with the best occupancy",
                     "give a multiple of 32, or 0 for an automatic choice"},
        option_entry{"chunk_size", &o::chunk_size, run, "instances", from_to(0, infinite),
                     "instances on a GPU at a time; 0: chosen so that transfers and kernels overlap",
                     "give 0 for what the memory allows"},
        option_entry{"shared_placement", &o::shared_placement, run, "where a GPU keeps shared parameters"},
        option_entry{"progress", &o::progress, call,
                     "a function `(done, total)` that `solve` calls from time to time, in its own thread, with the "
                     "numbers of instances done and of all; an exception that it throws ends the call"},
    };
};

/// Calls `function(entry)` for every option of a struct.
template <class Group, class Function>
constexpr void for_each_option(Function&& function) {
    std::apply([&](const auto&... entry) { (function(entry), ...); }, option_table<Group>::all);
}

// ---------------------------------------------------------------------------------------------------------------------
// The table for readers
// ---------------------------------------------------------------------------------------------------------------------

/// A number as text, whole ones without an exponent.
std::string text_of(double number);

/// A row for readers, as text.
struct option_row {
    std::string name;                  ///< "phases", "record.states"
    std::string type;                  ///< "number", "whole number", "choice", "tolerances", "components", ...
    std::vector<std::string> choices;  ///< of type "choice"
    std::string initial;               ///< the default: a number or a choice; empty for nothing
    std::string range;                 ///< as an interval, [0, inf); empty for other types
    std::string unit;                  ///< "time", "seconds"; empty for none
    option_effect effect;              ///< what it has an effect on
    std::string meaning;               ///< a sentence without a full stop
};
/// All options. Nested structs' options follow the member that has them.
std::vector<option_row> option_rows();

}  // namespace myriad::host::inline MYRIAD_ABI
