// SPDX-License-Identifier: MIT
// How many threads of a GPU integrate an instance, as decided when a kernel is compiled.
#include "myriad/kernel/integrator/team_choice.hpp"

#include <myriad/coupled_units.hpp>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/delayed_teams.hpp"
#include "tests/kernel/model/teams.hpp"

namespace {

using myriad::detail::threads_per_instance;

template <int units, class R>
constexpr int chosen = threads_per_instance<myriad::coupled_units<teams::place, units>, myriad::tsitouras_5, R>();

template <int n>
struct large_unit {
    enum unit_state { n_unit_state = n };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n> rhs(int, auto, const auto&, const auto&) {
        return {};
    }
};
}  // namespace

TEST_CASE("a team has at most four states in each thread, is a warp up to 96 bytes in each, and else a block") {
    CHECK(chosen<4, double> == 1);
    CHECK(chosen<16, double> == 1);
    CHECK(chosen<17, double> == 8);
    CHECK(chosen<32, double> == 8);
    CHECK(chosen<33, double> == 16);
    CHECK(chosen<64, double> == 16);
    CHECK(chosen<128, double> == 32);
    CHECK(chosen<256, double> == 32);
    CHECK(chosen<384, double> == 32);
    CHECK(chosen<385, double> == 128);
    CHECK(chosen<512, double> == 128);
    CHECK(chosen<4096, double> == 256);
    CHECK(chosen<24, float> == 1);
    CHECK(chosen<25, float> == 8);
    CHECK(chosen<32, float> == 8);
    CHECK(chosen<64, float> == 16);
    CHECK(chosen<128, float> == 32);
    CHECK(chosen<256, float> == 32);
    CHECK(chosen<768, float> == 32);
    CHECK(chosen<769, float> == 128);
    CHECK(chosen<1024, float> == 128);
}

TEST_CASE("a team has no threads without a unit beyond the next power of two") {
    const auto threads_of = [](auto model) {
        return threads_per_instance<decltype(model), myriad::tsitouras_5, double>();
    };
    CHECK(threads_of(myriad::coupled_units<large_unit<40>, 1>{}) == 1);
    CHECK(threads_of(myriad::coupled_units<large_unit<20>, 2>{}) == 2);
    CHECK(threads_of(myriad::coupled_units<large_unit<20>, 5>{}) == 8);
}

TEST_CASE("units say how many threads integrate them, and what teams do not have is integrated by one") {
    using ring = teams::places<4>;
    CHECK(threads_per_instance<ring, myriad::tsitouras_5, double>() == 4);
    CHECK(threads_per_instance<teams::places<1>, myriad::tsitouras_5, double>() == 1);
    CHECK(threads_per_instance<ring, myriad::rodas_5p, double>() == 1);
    CHECK(threads_per_instance<ring, teams::averaged, double>() == 4);
    CHECK(threads_per_instance<ring, myriad::dense<myriad::tsitouras_5>, double>() == 4);
    CHECK(threads_per_instance<teams::hoppers<4>, myriad::tsitouras_5, double>() == 4);
    CHECK(threads_per_instance<teams::watched_ring<4>, myriad::tsitouras_5, double>() == 4);
    CHECK(threads_per_instance<teams::adapting_cells<4>, myriad::tsitouras_5, double>() == 4);
    CHECK(threads_per_instance<delayed_units::phases<20>, myriad::tsitouras_5, double>() == 16);
    CHECK(threads_per_instance<delayed_units::phases<5>, myriad::tsitouras_5, double>() == 1);
    CHECK(threads_per_instance<delayed_units::phases<20>, myriad::rodas_5p, double>() == 1);
    CHECK(threads_per_instance<delayed_units::changing_units, myriad::tsitouras_5, double>() == 1);
    // A value of the past for each pair, in shared memory: 100^2 have room there, 170^2 have none.
    CHECK(threads_per_instance<delayed_teams::pairs_of<100>, myriad::tsitouras_5, double>() == 32);
    CHECK(threads_per_instance<delayed_teams::pairs_of<170>, myriad::tsitouras_5, double>() == 1);
    CHECK(threads_per_instance<myriad::with_tangents<ring, 1>, myriad::tsitouras_5, double>() == 1);
}
