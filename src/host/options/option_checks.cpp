// SPDX-License-Identifier: MIT
// The checks of options that depend on no model.
#include "myriad/host/options/option_checks.hpp"

#include <cmath>
#include <vector>

#include "myriad/host/options/option_table.hpp"

namespace myriad::host::inline MYRIAD_ABI {

void check_count(const char* name, std::int64_t value, std::int64_t least, std::int64_t most) {
    require(value >= least && value <= most, named_option(name), " is ", value, " (must be from ", least, " to ", most,
            ")");
}

namespace {

void check_tolerance_count(const char* name, const per_component& t, std::size_t components) {
    require(t.size() == 1 || t.size() == components, named_option(name), " has ", t.size(),
            " values, but the model has ", components, " state components", cure,
            "give one value for all, or one for each");
}
/// "must be positive and finite": a range in words.
std::string words_of(const number_range& r) {
    const std::string least = text_of(r.least), most = text_of(r.most), zero = r.or_zero ? ", or 0" : "";
    if (std::isfinite(r.most))
        return message("must be ", r.without_least ? "between " : "from ", least, r.without_least ? " and " : " to ",
                       most, zero);
    const char* const finite = !r.without_most ? "" : r.without_least ? " and finite" : ", and finite";
    if (r.least != 0) return message("must be at least ", least, finite, zero);
    return message(r.without_least ? "must be positive" : "must not be negative", finite);
}
template <class E>
std::string names_of_choices() {
    std::string all;
    const auto known = choices(E{});
    for (std::size_t i = 0; i < known.size(); ++i)
        all += message(i == 0 ? "" : i + 1 == known.size() ? " or " : ", ", known[i].name);
    return all;
}
/// Checks the numbers and choices of a struct, each on its own. `what`: what messages say before the option's name.
template <class Group>
void check_each(const option_limits& limits, const Group& given, const char* what) {
    static const Group initial{};
    for_each_option<Group>([&](const auto& e) {
        using T = typename std::decay_t<decltype(e)>::value_type;
        const T& value = given.*e.member;
        const auto key = [&] {
            const std::string path = option_table<Group>::path;
            return path.empty() ? e.name : path + '.' + e.name;
        };
        const auto name = [&] { return message(what, e.name); };
        if constexpr (std::is_enum_v<T>) {
            if (name_of_choice(value) != nullptr) return;
            refuse({named_option(key(), name()), " is ", static_cast<int>(value), ", which is none", cure, "choose ",
                    names_of_choices<T>()});
        } else if constexpr (std::is_same_v<T, std::int64_t> || std::is_same_v<T, double>) {
            const auto number = static_cast<double>(value);
            if (std::isnan(number) && std::isnan(static_cast<double>(initial.*e.member))) return;  // not given
            if (!e.range.contains(number))
                refuse({named_option(key(), name()), " is ", value, " (", words_of(e.range), ")",
                        e.cure != nullptr ? statement_of(cure, e.cure) : statement()});
            if (e.is_real()) limits.check_kept(key().c_str(), number, name().c_str());
        }
    });
}

void check_samples(const sample_options& s, const options& o) {
    const int ways = (s.evenly != 0) + !s.times.empty() + !s.times_of_instances.empty() + (s.every != 0);
    require(ways == 1, named_option("samples"), " names ", ways, " of evenly, times, times_of_instances and every",
            cure, "choose exactly one");
    require(s.from_phase < o.phases, named_option("samples.from_phase"), " is ", s.from_phase, ", but the call has ",
            o.phases, " phases (counted from 0): nothing would be sampled");
    if (s.every != 0) return;
    require(s.evenly != 1, named_option("samples.evenly"), " is 1 (must be from 2, for both ends of the domain)");
    bool rising = true, falling = true;
    for (std::size_t k = 0; k < s.times.size(); ++k) {
        require(std::isfinite(s.times[k]), named_option("samples.times"), "[", k, "] is ", s.times[k],
                " (must be finite)");
        if (k == 0) continue;
        rising = rising && s.times[k] > s.times[k - 1];
        falling = falling && s.times[k] < s.times[k - 1];
        require(rising || falling, named_option("samples.times"), " are not in order at number ", k, " (", s.times[k],
                " after ", s.times[k - 1], ")", cure,
                "give each time once, in the order in which the integration reaches them");
    }
    if (!s.times_of_instances.empty()) return;  // checked where the ensemble's size is known
    const std::int64_t phases = o.phases - s.from_phase;
    // Phases that continue in time pass each given time once.
    const std::int64_t wanted = s.evenly != 0
                                    ? s.evenly * phases
                                    : static_cast<std::int64_t>(s.times.size()) * (o.phase_length > 0 ? 1 : phases);
    require(s.capacity >= wanted, named_option("samples.capacity"), " is ", s.capacity, ", but the chosen times give ",
            wanted, " samples per instance in this call", cure, "raise the capacity");
}

/// Refuses sample options without states: they would be ignored.
void check_no_samples(const sample_options& s) {
    const char* given = nullptr;
    if (s.capacity != 0) given = "capacity";
    if (s.evenly != 0) given = "evenly";
    if (!s.times.empty()) given = "times";
    if (!s.times_of_instances.empty()) given = "times_of_instances";
    if (s.every != 0) given = "every";
    if (!(s.minimum_spacing == 0)) given = "minimum_spacing";
    if (s.from_phase != 0) given = "from_phase";
    if (given == nullptr) return;
    const std::string key = message("samples.", given);
    refuse({named_option(key), " is given, but ", named_option("samples.states"),
            " names no state, so that nothing would be sampled", cure,
            "name the states to sample, or leave out all of samples"});
}

/// The same for records.
void check_no_records(const record_options& r) {
    require(r.from_phase == 0, named_option("record.from_phase"), " is ", r.from_phase,
            ", but record names nothing to record", cure,
            "name states, accessories or the time, or leave out all of record");
}

}  // namespace

void model_components::check(const char* what, const component_list& chosen, const listed_components& kind) const {
    std::vector<bool> seen(static_cast<std::size_t>(kind.count), false);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const int c = chosen[i];
        const std::string_view of = chosen.enumeration(i);
        // If components of this kind have no enumeration, enumerators of the other kinds are wrong nevertheless.
        bool of_another = false;
#define MYRIAD_COMPARE_KIND(other, ...) of_another = of_another || of == other.enumeration;
        MYRIAD_COMPONENT_KINDS(MYRIAD_COMPARE_KIND)
#undef MYRIAD_COMPARE_KIND
        const bool fits = of.empty() || of == kind.enumeration || (kind.enumeration.empty() && !of_another);
        require(fits, named_option(what), " names component ", c, " by an enumerator of ", of,
                ", which numbers other components",
                kind.enumeration.empty() ? std::string() : message(" than ", kind.enumeration), cure,
                "give enumerators of the components that are meant, or numbers");
        require(c >= 0 && c < kind.count, named_option(what), " names component ", c, ", but the model has ",
                kind.count, " (numbered from 0)", cure, "use the model's enumerators");
        require(!seen[static_cast<std::size_t>(c)], named_option(what), " names component ", c, " twice", cure,
                "name each component once");
        seen[static_cast<std::size_t>(c)] = true;
    }
}

void option_limits::check_kept(const char* key, double value, const char* name) const {
    if (name == nullptr) name = key;
    require(value == 0 || rounded(value) != 0, named_option(key, name), " is ", value,
            ", which is zero in single precision", cure, "give a larger value or ", cures::use_doubles);
    require(std::isinf(value) || std::isfinite(rounded(value)), named_option(key, name), " is ", value,
            ", which is infinite in single precision", cure, "give a smaller value or ", cures::use_doubles);
}
std::int64_t most_steps(int digits) { return digits > 31 ? 2'000'000'000 : 16'000'000; }

std::int64_t step_limit(const options& o, bool adaptive, int digits) {
    // One that a few instances of a large ensemble may reach without holding up the call for minutes.
    constexpr std::int64_t adaptive_steps = 200'000;
    return o.max_steps > 0 ? o.max_steps : adaptive ? adaptive_steps : most_steps(digits);
}

namespace {

/// Options of paths, and steps that a path has a place for.
void check_path(const options& o, bool has_diffusion, bool adaptive) {
    require(has_diffusion || o.seed == 0, named_option("seed"), " is ", o.seed,
            ", but the model has no diffusion, whose paths it seeds", cure,
            "leave it out; random numbers of hooks have seeds of their own");
    require(has_diffusion || o.noise_step == 0, named_option("noise_step"), " is ", o.noise_step,
            ", but the model has no diffusion, whose paths have such steps", cure, "leave it out");
    require(!has_diffusion || o.sub_samples == 1, named_option("sub_samples"), " is ", o.sub_samples,
            ", but the model has a diffusion, and the law of its paths says what happens within a step", cure,
            "leave it out");
    if (!has_diffusion || o.noise_step == 0) return;
    if (adaptive) {
        require(o.maximum_step * detail::parts_of_cell >= o.noise_step, named_option("maximum_step"), " is ",
                o.maximum_step, ", less than a 65536th of ", named_option("noise_step"), ", ", o.noise_step,
                ", which is the shortest step that a path has a place for", cure, "give a smaller noise_step");
        return;
    }
    const double cells = o.step / o.noise_step, parts = cells * detail::parts_of_cell;
    require(parts > 0.5 && std::fabs(parts - std::rint(parts)) <= 1e-6 * parts, named_option("step"), " is ", o.step,
            ", which is neither a multiple of ", named_option("noise_step"), ", ", o.noise_step,
            ", nor a number of 65536ths of it", cure,
            "give a noise_step that is the longest of the steps to compare, each half of the one before");
}

}  // namespace

void option_limits::check(const options& o) const {
    require(computes_as_written(), "the library ", not_as_written);
    check_each(*this, o, "");
    for (const event_options& e : o.events) check_each(*this, e, "event ");
    const auto n_state = static_cast<std::size_t>(components.state.count);
    check_tolerance_count("relative_tolerance", o.relative_tolerance, n_state);
    check_tolerance_count("absolute_tolerance", o.absolute_tolerance, n_state);
    bool controls = false;
    for (std::size_t c = 0; c < o.relative_tolerance.size(); ++c) {
        require(o.relative_tolerance[c] >= 0 && std::isfinite(o.relative_tolerance[c]),
                named_option("relative_tolerance"), " is ", o.relative_tolerance[c],
                " (must be at least 0, and finite)", cure,
                "give the error you accept per step, such as 1e-9, or 0 for that of ",
                named_option("absolute_tolerance"), " alone");
        controls = controls || o.relative_tolerance[c] < 1;
    }
    // Components may be left out of the error test, as by `without_tangents`, but not all of them.
    require(controls, named_option("relative_tolerance"), " is ", o.relative_tolerance[0],
            " (must be less than 1, an error as large as the solution)", cure,
            "give the error you accept per step, such as 1e-9, or a large ", named_option("absolute_tolerance"));
    for (std::size_t c = 0; c < o.absolute_tolerance.size(); ++c)
        require(o.absolute_tolerance[c] >= 0 && std::isfinite(o.absolute_tolerance[c]),
                named_option("absolute_tolerance"), " is ", o.absolute_tolerance[c],
                " (must not be negative, and finite)", cure,
                "give the error you accept per step, such as 1e-9, or 0 for that of ",
                named_option("relative_tolerance"), " alone");
    for (std::size_t c = 0; c < n_state; ++c)
        require(o.relative_tolerance[c] > 0 || o.absolute_tolerance[c] > 0, named_option("relative_tolerance"), " and ",
                named_option("absolute_tolerance"), " are 0", cure, "give the error you accept per step, such as 1e-9");
    require(adaptive || !std::isnan(o.step), named_option("step"), " is not set, but the method takes fixed steps",
            cure, cures::give_step);
    check_path(o, has_diffusion, adaptive);
    // Fixed steps do not use tolerances.
    for (std::size_t c = 0; adaptive && c < o.relative_tolerance.size(); ++c)
        check_kept("relative_tolerance", o.relative_tolerance[c]);
    for (std::size_t c = 0; adaptive && c < o.absolute_tolerance.size(); ++c) {
        check_kept("absolute_tolerance", o.absolute_tolerance[c]);
        const double least = std::ldexp(1.0, digits > 24 ? -1022 : -126);
        require(o.absolute_tolerance[c] == 0 || rounded(o.absolute_tolerance[c]) >= least,
                named_option("absolute_tolerance"), " is ", o.absolute_tolerance[c],
                ", below the smallest normal number, ", least, ", where a ratio of error to tolerance has no meaning",
                cure, "give at least that, or 0 for that of ", named_option("relative_tolerance"), " alone");
    }
    require(o.minimum_step <= o.maximum_step, named_option("minimum_step"), " ", o.minimum_step, " is above ",
            named_option("maximum_step"), " ", o.maximum_step, ": no step size is left; exchange them");
    require(static_cast<float>(o.shrink_limit) < 1, named_option("shrink_limit"), " is ", o.shrink_limit,
            ", which is 1 in single precision, that of step-size control", cure, "give a smaller value, such as 0.1");
    if (o.max_steps != 0) check_count("max_steps", o.max_steps, 1, most_steps(digits));
    require(o.events.empty() || o.events.size() == static_cast<std::size_t>(n_event), named_option("events"), " has ",
            o.events.size(), " entries, but the model has ", n_event, " event functions", cure,
            "give one entry for each, or none for defaults");
    require(o.phase_length == 0 || !writes_times, named_option("phase_length"), " is ", o.phase_length,
            ", but the model declares writes_time_domain, so that its hooks say where phases end", cure,
            "leave out phase_length, and set t_end in initialise");
    require(o.block_size % 32 == 0, named_option("block_size"), " is ", o.block_size, " (must be a multiple of 32)");
    if (!o.samples.empty()) {
        require(samples_trajectory, named_option("samples"), " are requested, but the method has no dense output", cure,
                "use dense<Method>, in solve and in MYRIAD_INSTANTIATE");
        components.check("samples.states", o.samples.states, components.state);
        check_each(*this, o.samples, "samples.");
        check_samples(o.samples, o);
        const std::vector<double>& times = o.samples.times;
        for (std::size_t k = 1; k < times.size(); ++k)
            require(rounded(times[k]) != rounded(times[k - 1]), named_option("samples.times"), "[", k, "] is ",
                    times[k], ", which is the same as the time before it in single precision", cure,
                    "give times further apart or ", cures::use_doubles);
    } else {
        check_no_samples(o.samples);
    }
    if (!o.record.empty()) {
        check_each(*this, o.record, "record.");
        require(o.record.from_phase < o.phases, named_option("record.from_phase"), " is ", o.record.from_phase,
                ", but the call has ", o.phases, " phases (counted from 0): nothing would be recorded");
#define MYRIAD_CHECK_KIND(kind, plural, ...) components.check("record." #plural, o.record.plural, components.kind);
        MYRIAD_RECORDED_KINDS(MYRIAD_CHECK_KIND)
#undef MYRIAD_CHECK_KIND
    } else {
        check_no_records(o.record);
    }
}

}  // namespace myriad::host::inline MYRIAD_ABI
