// SPDX-License-Identifier: MIT
// Shows a model's functions at some places, and compares what they give.
#include "myriad/study/plan/model_behaviour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

using detail::model_function;
using detail::shown_kind;
using detail::shown_value;

constexpr int places_of_instance = 3, roundings = 2;
constexpr std::size_t many = 2000;  // values at a place: fewer places, as a store has them as text

/// A component; nothing for those that an interpreter has besides.
const component* find(const component_names& names, const shown_value& v) {
    component_kind kind{};
    switch (v.kind) {
        case shown_kind::state:
            kind = component_kind::state;
            break;
        case shown_kind::parameter:
            kind = component_kind::parameter;
            break;
        case shown_kind::accessory:
            kind = component_kind::accessory;
            break;
        case shown_kind::integer_accessory:
            kind = component_kind::integer_accessory;
            break;
        default:
            return nullptr;
    }
    for (const component& c : names.all())
        if (c.kind == kind && c.number == v.component) return &c;
    return nullptr;
}

/// What a value is.
std::optional<statement> name_of(const component_names& names, const shown_value& v) {
    const bool is_component = v.kind == shown_kind::state || v.kind == shown_kind::parameter ||
                              v.kind == shown_kind::accessory || v.kind == shown_kind::integer_accessory;
    const component* const c = find(names, v);
    if (is_component && c == nullptr) return std::nullopt;
    const std::string full = c != nullptr ? c->full_name() : "";
    const auto event = [&] {
        return statement_of(host::message_part(part_kind::event, message("event ", v.number), {}, v.number));
    };
    statement subject;
    switch (v.kind) {
        case shown_kind::t_begin:
            subject = statement("t_begin");
            break;
        case shown_kind::t_end:
            subject = statement("t_end");
            break;
        case shown_kind::next_step:
            subject = statement("the next step");
            break;
        case shown_kind::wish:
            subject = statement("what is to end");
            break;
        case shown_kind::result:
            break;
        default:
            subject = statement_of(host::named_component(full));
    }
    switch (v.function) {
        case model_function::start:
            return statement_of("the start of ", subject);
        case model_function::rhs:
            return statement_of("the right-hand side of ", subject);
        case model_function::mass_matrix:
            return statement_of("the mass matrix in the row of ", subject, ", column ", v.number);
        case model_function::events:
            return statement_of("the function of ",
                                host::message_part(part_kind::event, message("event ", v.component), {}, v.component));
        case model_function::observe:
            return statement_of("the observed quantity ", v.component);
        case model_function::summary:
            return statement_of("the summary ", v.number);
        case model_function::stop_time:
            return statement_of("the time of stop ", v.number);
        case model_function::condition:
            return statement_of("the condition of trigger ", v.number);
        case model_function::initialise:
            return statement_of(subject, " after initialise");
        case model_function::after_step:
            return statement_of(subject, " after a step");
        case model_function::after_event:
            return statement_of(subject, " after the action of ", event());
        case model_function::after_stop:
            return statement_of(subject, " after the action of stop ", v.number);
        case model_function::after_trigger:
            return statement_of(subject, " after the action of trigger ", v.number);
        case model_function::finalise:
            return statement_of(subject, " after finalise");
    }
    return std::nullopt;
}

struct collected {
    std::vector<shown_value> values;
    static void take(void* to, const shown_value& v) { static_cast<collected*>(to)->values.push_back(v); }
};

using key = std::tuple<model_function, std::int32_t, shown_kind, std::int32_t>;
key key_of(const shown_value& v) { return {v.function, v.number, v.kind, v.component}; }

bool is_same(const std::optional<double>& a, const std::optional<double>& b, double rounding) {
    if (a.has_value() != b.has_value()) return false;
    if (!a || *a == *b || (std::isnan(*a) && std::isnan(*b)) || std::isinf(rounding)) return true;
    return std::abs(*a - *b) <= rounding;  // not if one is no number
}

}  // namespace

model_behaviour::model_behaviour(const component_names& names, std::int64_t instances, double epsilon,
                                 const shower& show) {
    // The first, the last, and two that are at no round part of the others.
    std::vector<std::int64_t> chosen{0};
    for (const double part : {0.236, 0.618, 1.0})
        chosen.push_back(static_cast<std::int64_t>(part * static_cast<double>(instances - 1)));
    for (std::size_t i = 0; i < chosen.size() && (i == 0 || all_.size() < many); ++i)
        add_places(names, std::min(chosen[i], instances - 1), show);
    for (auto& [name, at] : all_) {
        at.resize(places_);
        std::vector<double>& rounding = rounding_[name];
        rounding.resize(places_, 0.0);
        // Twelve digits, and what rounding leaves where numbers cancel that are as large elsewhere in the instance.
        for (std::size_t p = 0; p < places_; ++p) {
            double largest = 0;
            const std::size_t first = p - p % places_of_instance;
            for (std::size_t q = first; q < first + places_of_instance; ++q)
                if (at[q] && std::isfinite(*at[q])) largest = std::max(largest, std::abs(*at[q]));
            rounding[p] = 64 * rounding[p] + 64 * epsilon * largest + 4096 * epsilon * std::abs(at[p].value_or(0));
        }
    }
}

void model_behaviour::add_places(const component_names& names, std::int64_t instance, const shower& show) {
    for (int at = 0; at < places_of_instance; ++at, ++places_) {
        const auto shown = [&](int rounding) {
            collected made;
            try {
                show(instance, {at, rounding}, &made, &collected::take);
            } catch (...) {  // what models throw says nothing of others
                made.values.clear();
            }
            return made.values;
        };
        std::map<key, std::pair<double, double>> spread;
        for (int rounding = 1; rounding <= roundings; ++rounding)
            for (const shown_value& v : shown(rounding)) {
                const auto [found, is_new] = spread.try_emplace(key_of(v), v.value, v.value);
                auto& [least, most] = found->second;
                least = is_new ? v.value : std::fmin(least, v.value);
                most = is_new ? v.value : std::fmax(most, v.value);
                if (std::isnan(v.value)) most = HUGE_VAL;
            }
        for (const shown_value& v : shown(0)) {
            const std::optional<statement> said = name_of(names, v);
            if (!said) continue;
            const std::string name = *said;
            said_.try_emplace(name, *said);
            values& all = all_[name];
            all.resize(places_ + 1);
            all.back() = v.value;
            std::vector<double>& rounding = rounding_[name];
            rounding.resize(places_ + 1, 0.0);
            if (const auto found = spread.find(key_of(v)); found != spread.end() && !std::isnan(v.value)) {
                const auto [least, most] = found->second;
                if (std::isfinite(v.value))
                    rounding.back() = std::max(std::abs(most - v.value), std::abs(v.value - least));
            }
        }
    }
}

std::vector<statement> model_behaviour::differences_from(const model_behaviour& stored) const {
    std::vector<statement> found;
    std::set<std::string> names;
    for (const auto& [name, at] : all_) names.insert(name);
    for (const auto& [name, at] : stored.all_) names.insert(name);
    const auto in = [](const std::map<std::string, values>& all, const std::string& name, std::size_t place) {
        const auto of = all.find(name);
        return of == all.end() || place >= of->second.size() ? std::optional<double>() : of->second[place];
    };
    const auto text = [](const std::optional<double>& v) { return v ? exact_text(*v) : std::string("nothing"); };
    for (const std::string& name : names) {
        for (std::size_t p = 0; p < places_; ++p) {
            const std::optional<double> here = in(all_, name, p), there = in(stored.all_, name, p);
            const auto rounding = rounding_.find(name);
            if (is_same(here, there, rounding != rounding_.end() ? rounding->second[p] : 0.0)) continue;
            const auto said = said_.find(name);
            found.push_back(statement_of(said != said_.end() ? said->second : statement(name), ": ", text(there),
                                         " in the store, ", text(here), " here"));
            break;
        }
    }
    return found;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
