// SPDX-License-Identifier: MIT
// Values of instances along axes.
#include "myriad/study/plan/axes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "myriad/host/core/error.hpp"
#include "myriad/host/threads/parallel.hpp"
#include "myriad/study/plan/kinds.hpp"

namespace myriad {

using studies::component;
using studies::component_kind;

axis_values::axis_values(axis_values::kind kind, double first, double last, std::int64_t size, std::vector<double> list)
    : kind_(kind), first_(first), last_(last), size_(size), list_(std::move(list)) {}

detail::axis_rule axis_values::rule() const {
    using enum detail::axis_kind;
    constexpr detail::axis_kind kinds[] = {linear, logarithmic, table, uniform, normal};  // in the order of `kind`
    detail::axis_rule made{.kind = kinds[static_cast<int>(kind_)],
                           .length = size_,
                           .first = first_,
                           .last = last_,
                           .first_log = first_log_,
                           .table = kind_ == kind::list ? list_.data() : nullptr};
    if (kind_ == kind::linear && size_ > 1) made.step = (last_ - first_) / static_cast<double>(size_ - 1);
    if (kind_ == kind::logarithmic) made.step = log_step_;
    return made;
}
double axis_values::operator[](std::int64_t i) const { return detail::value_on_axis(rule(), i); }

namespace {

void check_size(const char* function, std::int64_t size) {
    require(size > 0, host::named_option(function), " is given ", size, " values (must be positive)");
}
void check_finite(const char* function, double value) {
    require(std::isfinite(value), function, " is given ", value, ", and needs finite values");
}

}  // namespace

axis_values linspace(double first, double last, std::int64_t size) {
    check_finite("linspace", first);
    check_finite("linspace", last);
    require(std::isfinite(last - first), "linspace from ", first, " to ", last, " is longer than the largest number",
            host::cure, "bring the ends closer together");
    check_size("linspace", size);
    return {axis_values::kind::linear, first, last, size};
}
axis_values geomspace(double first, double last, std::int64_t size) {
    check_finite("geomspace", first);
    check_finite("geomspace", last);
    require(first != 0 && last != 0 && (first > 0) == (last > 0), "geomspace from ", first, " to ", last,
            " passes zero", host::cure, "give two values of one sign (they are the ends, not exponents)");
    check_size("geomspace", size);
    axis_values made(axis_values::kind::logarithmic, first, last, size);
    made.first_log_ = std::log(std::fabs(first));
    if (size > 1) made.log_step_ = (std::log(std::fabs(last)) - made.first_log_) / static_cast<double>(size - 1);
    return made;
}
axis_values values(std::vector<double> list) {
    check_size("values", static_cast<std::int64_t>(list.size()));
    for (const double value : list) check_finite("values", value);
    const auto size = static_cast<std::int64_t>(list.size());
    return {axis_values::kind::list, 0, 0, size, std::move(list)};
}
axis_values uniform(double from, double to) {
    check_finite("uniform", from);
    check_finite("uniform", to);
    check_finite("uniform", to - from);
    return {axis_values::kind::uniform, from, to, 1};
}
axis_values normal(double mean, double standard_deviation) {
    check_finite("normal", mean);
    check_finite("normal", standard_deviation);
    require(standard_deviation > 0, "normal is given a standard deviation of ", standard_deviation,
            " (must be positive)");
    return {axis_values::kind::normal, mean, standard_deviation, 1};
}

namespace {

/// Refuses what the component cannot have.
void check_values(const component& c, const axis_values& all) {
    if (!is_integer(c.kind)) return;
    require(!all.random(), c.full_name(), " is an integer, which random values are not", host::cure,
            "draw it in a hook");
    const auto check = [&](double value) {
        constexpr double least = std::numeric_limits<std::int32_t>::min(),
                         most = std::numeric_limits<std::int32_t>::max();
        require(value == std::floor(value) && value >= least && value <= most, c.full_name(),
                " is an integer of 32 bits, but is given ", value);
    };
    for (std::int64_t i = 0; i < all.size(); ++i) check(all[i]);
}

}  // namespace

const component& axes::find_free(std::string_view name) const {
    const component& c = names_.find(name, studies::settable_kinds);
    for (const entry& e : entries_)
        require(!(e.what == c), host::named_component(c.full_name()), " is given twice", host::cure,
                "give it one axis or one value");
    require(!is_shared(c.kind), c.full_name(), " is the same in all instances of a call, so it has no axis", host::cure,
            "make it a parameter of the model, or set it");
    return c;
}

void axes::add_dimension(std::string name, std::int64_t length) {
    constexpr std::int64_t most = std::int64_t{1} << 53;  // exact as a double
    require(length <= most / size_, "the axes have more than 2^53 instances: ", size_, " before \"", name,
            "\", which has ", length, " values");
    for (const axes::dimension& d : dimensions_)
        require(d.name != name, "two axes are called \"", name, "\"", host::cure, "give one of them another name");
    for (axes::dimension& d : dimensions_) d.stride *= length;
    size_ *= length;
    dimensions_.push_back({std::move(name), length});
}

void axes::add(std::string_view name, axis_values all) {
    const component& c = find_free(name);
    check_values(c, all);
    entry made{c, std::move(all)};
    if (!made.values.random()) {
        add_dimension(names_.initial_variable(c), made.values.size());
        made.dimension = static_cast<int>(dimensions_.size()) - 1;
    }
    entries_.push_back(std::move(made));
}

void axes::zip(const std::vector<std::pair<std::string, axis_values>>& paired) {
    require(!paired.empty(), "no axes are given to be paired");
    std::vector<entry> made;
    std::string joined;
    for (const auto& [name, all] : paired) {
        const component& c = find_free(name);
        check_values(c, all);
        require(!all.random(), host::named_component(c.full_name()), " is random, and so cannot be paired", host::cure,
                "give it by itself");
        const axis_values& first = paired.front().second;
        const component& before = made.empty() ? c : made[0].what;  // c is the subject
        require(all.size() == first.size(), "paired axes have different lengths: ", before.full_name(), " has ",
                first.size(), " values, ", host::named_component(c.full_name()), " has ", all.size());
        for (const entry& e : made)
            require(!(e.what == c), host::named_component(c.full_name()), " is given twice", host::cure,
                    "give it one axis");
        joined += message(joined.empty() ? "" : "_", names_.initial_variable(c));
        made.push_back({c, all, static_cast<int>(dimensions_.size())});
    }
    add_dimension(std::move(joined), paired.front().second.size());
    entries_.insert(entries_.end(), made.begin(), made.end());
}

void axes::repeat(std::int64_t count, std::string_view name) {
    check_size("repeat", count);
    require(!name.empty(), "a repetition needs a name");
    add_dimension(std::string(name), count);
}

void axes::set(std::string_view name, double value) {
    const component& c = names_.find(name, studies::settable_kinds);
    require(std::isfinite(value) || (c.kind == component_kind::t_end && std::isinf(value)), c.full_name(),
            " is set to ", value, ", and needs a finite value");
    axis_values one(axis_values::kind::linear, value, value, 1);
    check_values(c, one);
    for (entry& e : entries_) {
        if (!(e.what == c)) continue;
        require(!e.dimension && !e.values.random(), c.full_name(), " has an axis: it cannot have one value too");
        e.values = std::move(one);
        return;
    }
    entries_.push_back({c, std::move(one)});
}

detail::axis_rule axes::rule(const entry& e) const {
    detail::axis_rule made = e.values.rule();
    made.draw = static_cast<std::uint32_t>(e.what.kind) << 28 | static_cast<std::uint32_t>(e.what.number);
    if (e.dimension) made.stride = dimensions_[static_cast<std::size_t>(*e.dimension)].stride;
    return made;
}

template <class T>
void axes::fill_with(const entry& e, std::int64_t first, std::int64_t count, T* to) const {
    const detail::axis_rule axis = rule(e);
    host::in_parallel(count, 65'536, [&](std::int64_t begin, std::int64_t end) {
        if (e.values.random()) {
            for (std::int64_t i = begin; i < end; ++i)
                to[i] = static_cast<T>(detail::value_in_instance(axis, seed_, first + i));
            return;
        }
        if (axis.length == 1) {
            std::fill(to + begin, to + end, static_cast<T>(e.values[0]));
            return;
        }
        for (std::int64_t i = begin; i < end;) {  // runs of instances with the same value
            const std::int64_t instance = first + i;
            const std::int64_t last = std::min(end, i + axis.stride - instance % axis.stride);
            std::fill(to + i, to + last, static_cast<T>(detail::value_in_instance(axis, seed_, instance)));
            i = last;
        }
    });
}
void axes::fill(const entry& e, std::int64_t first, std::int64_t count, double* to) const {
    fill_with(e, first, count, to);
}
void axes::fill(const entry& e, std::int64_t first, std::int64_t count, float* to) const {
    fill_with(e, first, count, to);
}
void axes::fill(const entry& e, std::int64_t first, std::int64_t count, std::int32_t* to) const {
    fill_with(e, first, count, to);
}

}  // namespace myriad
