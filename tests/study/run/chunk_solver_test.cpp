// SPDX-License-Identifier: MIT
// Instances of studies that are set and reduced where they are integrated: on the device under test, a GPU or a
// simulated one, with the bits of those that the host sets and reduces.
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <myriad/myriad.hpp>
#include <myriad/study.hpp>

#include "tests/catch.hpp"
#include "tests/study/models.hpp"
#include "tests/study/store/content.hpp"
#include "tests/support/device.hpp"

namespace {

using namespace myriad;
using duffing_study = study<studied::duffing, dense<tsitouras_5>>;
using lorenz_study = study<studied::lorenz, runge_kutta_4, float>;
using tests::content;
using tests::content_of;
using tests::difference;
using wave_study = study<studied::wave, cash_karp>;

/// A generator on the host, so that the host sets and reduces all instances.
template <class Study>
void set_on_host(Study& s) {
    s.generate("nothing", [](std::int64_t, auto&) {});
}
/// What a study gives whose instances are set and reduced on the device, and on the host.
template <class Study, class Describe>
content check_where(Describe&& describe) {
    const auto run = [&](auto&& prepare) {
        Study s;
        describe(s);
        s.devices = {tests::test_device()};
        prepare(s);
        const study_result r = s.run();
        CHECK(r.warnings.empty());
        REQUIRE(r.complete);
        return content_of(r);
    };
    const content on_device = run([](Study&) {});
    CHECK(difference(on_device, run([](Study& s) { set_on_host(s); })) == "");
    CHECK(difference(on_device, run([](Study& s) { s.chunk = 13; })) == "");
    return on_device;
}
void reduce_all(any_study& s, const std::string& name, const axis_values& edges) {
    s.reduce(histogram_of(name, edges));
    s.reduce(histograms_of(name, edges));
    s.reduce(quantiles_of(name, {0.05, 0.5, 0.95}, edges));
    s.reduce(minimum_of(name));
    s.reduce(maximum_of(name));
    s.reduce(mean_of(name));
    s.reduce(variance_of(name));
}

}  // namespace

TEST_CASE("Axes of every kind give the same instances and results on the device as on the host", "[chunk_solver]") {
    check_where<duffing_study>([](duffing_study& s) {
        s.axis("k", geomspace(0.1, 0.4, 7));
        s.zip({{"omega", values({1, 1.25, 0.75})}, {"my_number", linspace(3, 4, 3)}});
        s.repeat(5);
        s.axis("phases", linspace(-1, 1, 3));
        s.axis("x", uniform(-1, 1));
        s.axis("v", normal(0, 0.1));
        s.set("B", 0.3);
        s.set("power", 3);
        s.time_domain(0, 3);
        s.seed(11);
        s.options.phases = 3;
        s.options.record = {.from_phase = 1,
                            .states = {studied::duffing::x},
                            .accessories = {studied::duffing::highest},
                            .integer_accessories = {studied::duffing::phases},
                            .time = true};
        s.options.samples = {.states = {studied::duffing::v}, .capacity = 6, .evenly = 2};
        s.keep.end = {"x", "v", "k", "my_number", "highest", "phases", "t"};
        s.keep.work = true;
        for (const char* name :
             {"x", "phases", "v_sample", "t_last", "x_start", "v_start", "status", "rhs_evaluations"})
            reduce_all(s, name, linspace(-1, 2, 20));
    });
}
TEST_CASE("So they do in single precision, with instances that fail and time domains of their own", "[chunk_solver]") {
    const content all = check_where<lorenz_study>([](lorenz_study& s) {
        s.axis("r", linspace(-3, 28, 21));
        s.axis("t_end", linspace(0.1, 0.2, 2));
        s.axis("x", normal(0, 1));
        s.axis("y", values({1, -1, 1e39}));  // the last is infinite as a float
        s.set("z", 1);
        s.set("t_begin", 0);
        s.options.step = 0.01;
        s.options.phases = 2;
        s.options.record = {.states = {studied::lorenz::z}};
        s.keep.end = {"x"};
        for (const char* name : {"x_end", "z", "status"}) reduce_all(s, name, values({-1e30, -1, 0, 1, 30}));
    });
    const auto& status = all.at("status");
    const auto count = [&](myriad::status which) {
        return std::count(status.begin(), status.end(), static_cast<std::byte>(which));
    };
    CHECK(count(status::invalid_input) > 0);
    CHECK(count(status::not_finite) > 0);
    CHECK(count(status::success) > 0);
}
TEST_CASE("Only what is kept leaves the device, and reductions are those of all values", "[chunk_solver]") {
    lorenz_study s;
    s.axis("x", linspace(-10, 10, 1000));
    s.set("y", 1);
    s.set("z", 1);
    s.set("r", 28);
    s.time_domain(0, 0.1);
    s.options.step = 0.01;
    s.keep.end = {"x"};
    s.keep.status = false;
    s.devices = {tests::test_device()};
    reduce_all(s, "y_end", linspace(-20, 20, 11));
    s.reduce(sum_of("first_x", {"x_end"}, 1, [](const chunk_columns& chunk, std::span<double> sums) {
        if (chunk.first() == 0) sums[0] = static_cast<double>(chunk.values<float>("x_end")[0]);
        if (!tests::tests_cpu()) CHECK_THROWS_AS(chunk.find("y_end"), error);
    }));
    const study_result r = s.run();
    CHECK(r.values("first_x")[0] == r.values("x_end")[0]);
    double inside = 0;
    for (const double count : r.values("y_end_histogram")) inside += count;
    for (const double count : r.values("y_end_outside")) inside += count;
    CHECK(inside == 1000);
    CHECK(r.values("y_end_minimum")[0] < r.values("y_end_mean")[0]);
}
TEST_CASE("A CPU beside a GPU does not make chunks smaller", "[chunk_solver]") {
    const auto chunk_on = [](std::vector<device> devices) {
        lorenz_study s;
        for (const char* name : {"x", "y", "z", "r"}) s.set(name, 1);
        s.time_domain(0, 1);
        s.options.step = 0.01;
        s.repeat(1'000'000'000);
        s.keep = {.random = false, .status = false};
        s.reduce(mean_of("x_end"));
        s.devices = std::move(devices);
        s.stop();  // before the run, which it ends too
        return s.run().content().chunk;
    };
    const device where = tests::test_device();
    CHECK(chunk_on({where, device::cpu(1)}) >= chunk_on({where}) / 2);  // of the memory, half is another device's
}
TEST_CASE("A model sets instances by its own function, the same on every device", "[chunk_solver]") {
    const auto run = [](auto&& prepare) {
        wave_study s;
        s.repeat(500);
        s.axis("omega", linspace(1, 2, 2));
        s.set("size", 0.5);
        s.time_domain(0, 10);
        s.seed(3);
        s.options.phases = 2;
        s.options.events = {{.tolerance = 1e-9, .stop_after = 2}};
        s.options.record = {.states = {studied::wave::x}, .time = true};
        s.keep.end = {"x", "v", "omega", "start", "rank"};
        reduce_all(s, "t", linspace(0, 10, 33));
        s.devices = {tests::test_device()};
        prepare(s);
        const study_result r = s.run();
        REQUIRE(r.complete);
        return content_of(r);
    };
    const content on_device = run([](wave_study& s) { s.generate("by itself"); });
    const content in_chunks = run([](wave_study& s) {
        s.generate("by itself");
        s.chunk = 17;
    });
    CHECK(difference(on_device, in_chunks) == "");
    const content by_host = run([](wave_study& s) {
        s.generate("by the host", [](std::int64_t first, ensemble<studied::wave>& all) {
            for (std::int64_t i = 0; i < all.size(); ++i) {
                random_numbers<double> random(3, first + i, -2);
                all.state(studied::wave::x)[i] = random.uniform(1, 2) * 0.5;
                all.state(studied::wave::v)[i] = random.normal();
                if ((first + i) % 7 == 6) all.state(studied::wave::v)[i] = INFINITY;
                all.accessory(studied::wave::start)[i] = all.parameter(studied::wave::omega)[i];
                all.integer_accessory(studied::wave::rank)[i] = static_cast<int>((first + i) % 3);
                all.parameter(studied::wave::omega)[i] *= 2;
            }
        });
    });
    CHECK(difference(on_device, by_host) == "");
    if (tests::tests_cpu()) return;
    const content on_cpu = run([](wave_study& s) {
        s.generate("by itself");
        s.devices = {device::cpu(2)};
    });
    for (const char* name : {"omega_end", "start_end", "rank_end", "status"}) {
        INFO(name);
        CHECK((on_cpu.at(name) == on_device.at(name)));
    }
}
TEST_CASE("What solve refuses is refused of instances on a device too", "[chunk_solver]") {
    wave_study s;
    s.axis("x", linspace(1, 2, 100));
    s.set("v", 0);
    s.set("omega", 1);
    s.set("size", 1);
    s.time_domain(0, 10);
    s.options.events = {{.tolerance = 1e-300}};
    s.devices = {tests::test_device()};
    s.warning = {};
    CHECK_THROWS_WITH(s.run(), Catch::Matchers::Contains("the tolerance of event 0 is 1e-300"));
}
