// SPDX-License-Identifier: MIT
// Studies of real models: the same bits as by `solve`, however they are divided, stopped and started again.
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <fcntl.h>
#include <myriad/myriad.hpp>
#include <myriad/study.hpp>
#include <myriad/study/store/sealed_text.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catch.hpp"
#include "tests/kernel/model/delay_models.hpp"
#include "tests/study/models.hpp"
#include "tests/study/store/content.hpp"
#include "tests/support/message_of.hpp"

namespace {

using namespace myriad;
using studied::duffing;
using studied::lorenz;
using tests::content;
using tests::content_of;
using tests::difference;
using tests::message_of;
using method = dense<tsitouras_5>;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

/// A folder that is removed.
struct folder {
    fs::path path;
    folder() {
        const fs::path memory = "/dev/shm";  // where nothing waits for a disk
        std::string name =
            ((fs::is_directory(memory) ? memory : fs::temp_directory_path()) / "study_test.XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw error("no folder for the test");
        path = name;
    }
    folder(const folder&) = delete;
    ~folder() { fs::remove_all(path); }
    std::string store() const { return (path / "store").string(); }
};

constexpr std::int64_t ks = 25, omegas = 4;

/// 100 instances with every kind of result.
void describe(study<duffing, method>& s) {
    s.axis("k", linspace(0.2, 0.3, ks));
    s.axis("omega", values({1, 1.1, 1.3, 0.7}));
    s.axis("v", normal(0, 0.1));
    s.set("x", -0.5);
    s.set("B", 0.3);
    s.set("power", 3);
    s.time_domain(0, 3);
    s.seed(5);
    s.options.phases = 3;
    s.options.record = {.from_phase = 1,
                        .states = {duffing::x},
                        .accessories = {duffing::highest},
                        .integer_accessories = {duffing::phases},
                        .time = true};
    s.options.samples = {.states = {duffing::v}, .capacity = 6, .evenly = 2};
    s.keep.end = {"x", "v", "my_number", "phases", "t"};
    s.keep.work = true;
    s.devices = {device::cpu(1)};
}

std::vector<device> cpus(std::initializer_list<int> threads) {
    std::vector<device> all;
    for (const int t : threads) all.push_back(device::cpu(t));
    return all;
}

}  // namespace

TEST_CASE("A study has the bits of an ensemble that was laid out and solved by hand", "[study]") {
    study<duffing, method> s;
    describe(s);
    s.chunk = 7;
    const study_result r = s.run();
    REQUIRE(r.complete);
    CHECK(r.instances == 100);
    CHECK(r.count(status::success) == 100);

    ensemble<duffing> e(ks * omegas);
    const double omega[] = {1, 1.1, 1.3, 0.7};
    const auto v = r.values("v_start");
    for (std::int64_t i = 0; i < e.size(); ++i) {
        e.parameter(duffing::k)[i] = Eigen::ArrayXd::LinSpaced(ks, 0.2, 0.3)[i / omegas];
        e.parameter(duffing::omega)[i] = omega[i % omegas];
        e.state(duffing::v)[i] = v[static_cast<std::size_t>(i)];
    }
    e.state(duffing::x) = -0.5;
    e.shared(duffing::B) = 0.3;
    e.shared_integer(duffing::power) = 3;
    e.time_domain(0, 3);
    const auto report = solve<method>(device::cpu(1), e, s.options);

    const auto check = [&](const char* name, const auto& expected) {  // one row for each instance
        INFO(name);
        const auto found = r.values(name);
        REQUIRE(static_cast<std::int64_t>(found.size()) == expected.size());
        for (int i = 0; i < expected.rows(); ++i)
            for (int j = 0; j < expected.cols(); ++j)
                REQUIRE(found[static_cast<std::size_t>(i * expected.cols() + j)] ==
                        static_cast<double>(expected(i, j)));
    };
    check("x", report.records.state(duffing::x));
    check("highest", report.records.accessory(duffing::highest));
    check("phases", report.records.integer_accessory(duffing::phases));
    check("t", report.records.time());
    check("v_sample", e.samples().state(duffing::v));
    check("t_sample", e.samples().time());
    check("stored_samples", e.samples().stored());
    check("x_end", e.state(duffing::x));
    check("my_number_end", e.accessory(duffing::my_number));
    check("phases_end", e.integer_accessory(duffing::phases));
    check("t_last", e.t());
    check("phases_done", e.phases_done());
    check("accepted_steps", e.accepted_steps());
    check("rejected_steps", e.rejected_steps());
    check("rhs_evaluations", e.rhs_evaluations());
    CHECK(r.values("status") == std::vector<double>(100, static_cast<double>(status::success)));
    CHECK(r.values("my_number_end")[99] == 99);  // hooks see the number in the study
}
TEST_CASE("The bits of a study depend neither on chunks nor on devices", "[study]") {
    const auto run = [](std::int64_t chunk, std::vector<device> devices) {
        study<duffing, method> s;
        describe(s);
        s.reduce(mean_of("x"));
        s.reduce(histogram_of("v_sample", linspace(-2, 2, 9)));
        s.reduce(minimum_of("highest_end"));
        s.chunk = chunk;
        s.devices = std::move(devices);
        return content_of(s.run());
    };
    const auto expected = run(0, cpus({1}));
    CHECK(expected.size() == 23);
    CHECK(difference(run(1, cpus({1})), expected) == "");
    CHECK(difference(run(7, cpus({2, 1, 1})), expected) == "");
    CHECK(difference(run(64, cpus({1, 1})), expected) == "");
    CHECK(difference(run(100, cpus({2})), expected) == "");
}
TEST_CASE("Reductions are those of what is kept", "[study]") {
    study<duffing, method> s;
    describe(s);
    s.reduce(mean_of("x"));
    s.reduce(maximum_of("x"));
    s.reduce(histogram_of("x", linspace(-2, 2, 9)));
    s.reduce(sum_of("positive", {"v_end"}, 1, [](const chunk_columns& c, std::span<double> sums) {
        for (const double v : c.values<double>("v_end")) sums[0] += v > 0;
    }));
    s.chunk = 9;
    const study_result r = s.run();
    const auto x = r.values("x"), v_end = r.values("v_end");
    double sum[2] = {}, largest = -10, positive = 0;
    std::vector<double> histogram(8);
    for (std::size_t i = 0; i < x.size(); ++i) {
        sum[i % 2] += x[i];
        if (i % 2 == 0) largest = std::max(largest, x[i]);
        ++histogram[static_cast<std::size_t>((x[i] + 2) / 0.5)];
    }
    for (const double last : v_end) positive += last > 0;
    CHECK(r.values("x_mean")[0] == Approx(sum[0] / 100).epsilon(1e-13));  // a hundred roundings
    CHECK(r.values("x_mean")[1] == Approx(sum[1] / 100).epsilon(1e-13));
    CHECK(r.values("x_maximum")[0] == largest);
    CHECK(r.values("x_histogram") == histogram);
    CHECK(r.values("positive") == std::vector<double>{positive});
    CHECK(positive > 0);
    CHECK(positive < 100);
}
TEST_CASE("A reduction over an axis is that of each point of the other axes, whatever the chunks", "[study]") {
    const auto run = [](std::int64_t chunk, const ensemble_reduction& reduction) {
        study<lorenz, runge_kutta_4, float> s;
        s.axis("r", values({28, 10}));
        s.axis("x", linspace(0, 1, 3));
        s.axis("y", linspace(0.5, 2, 4));
        s.set("z", 0.25);
        s.time_domain(0, 1);
        s.options.step = 0.01;
        s.keep.end = {"z"};
        s.devices = {device::cpu(1)};
        s.chunk = chunk;
        s.reduce(reduction);
        return s.run();
    };
    const std::vector<std::vector<std::string>> all{{"x_start"}, {"y_start"}, {"r", "y_start"}, {"r", "x_start"}};
    for (const auto& over : all) {
        const auto named = [&](const char* name) { return std::find(over.begin(), over.end(), name) != over.end(); };
        const std::int64_t r_stride = named("r") ? 0 : 1, x_stride = named("x_start") ? 0 : 1,
                           y_stride = named("y_start") ? 0 : 1;
        std::vector<double> expected;
        for (const std::int64_t chunk : {24, 1, 7}) {
            const study_result found = run(chunk, maximum_of("z_end").over(over));
            if (expected.empty()) {
                const auto z = found.values("z_end");
                const std::int64_t x_length = x_stride == 0 ? 1 : 3, y_length = y_stride == 0 ? 1 : 4;
                expected.assign(static_cast<std::size_t>((r_stride == 0 ? 1 : 2) * x_length * y_length), -100);
                for (std::int64_t i = 0; i < 24; ++i) {
                    const std::int64_t set =
                        (i / 12 * r_stride * x_length + i / 4 % 3 * x_stride) * y_length + i % 4 * y_stride;
                    double& most = expected[static_cast<std::size_t>(set)];
                    most = std::max(most, z[static_cast<std::size_t>(i)]);
                }
            }
            CHECK(found.values("z_end_maximum") == expected);
        }
    }
    CHECK(run(5, mean_of("z_end").over({"r", "y_start", "x_start"})).values("z_end_mean") ==
          run(24, mean_of("z_end")).values("z_end_mean"));
    CHECK_THAT(message_of([&] { run(1, mean_of("z_end").over({"path"})); }),
               Contains("z_end_mean is over \"path\", and the study has no such axis: there are r, x_start, y_start"));
    CHECK_THAT(message_of([&] { run(1, mean_of("z_end").over({"r", "r"})); }), Contains("over \"r\" twice"));
    CHECK_THAT(message_of([] { (void)mean_of("z_end").over({}); }), Contains("over no axis: name one"));
}
TEST_CASE("Single precision, and instances that fail", "[study]") {
    study<lorenz, runge_kutta_4, float> s;
    s.axis("r", values({28, -1, 20}));
    s.axis("x", linspace(0, 1, 4));
    s.set("y", 0.5);
    s.set("z", 0.25);
    s.time_domain(0, 1);
    s.options.step = 0.01;
    s.keep.end = {"z"};
    s.reduce(minimum_of("z_end"));
    s.devices = {device::cpu(1)};
    s.chunk = 5;
    const study_result r = s.run();
    CHECK(r.complete);
    CHECK(r.failed() == 4);
    CHECK(r.count(status::not_finite) == 4);
    const auto state = r.values_of<std::uint8_t>("status", 0, 12);
    const auto z = r.values_of<float>("z_end", 0, 12);
    float least = 1000;
    for (std::size_t i = 0; i < 12; ++i) {
        CHECK(is_failure(static_cast<status>(state[i])) == (i / 4 == 1));
        if (i / 4 != 1) least = std::min(least, z[i]);
    }
    CHECK(r.values("z_end_minimum")[0] == static_cast<double>(least));
    CHECK_THAT(message_of([&] { r.values_of<double>("z_end", 0, 1); }), Contains("float32, not float64"));
}
TEST_CASE("Instances that never ran have neither a last time nor recorded integers", "[study]") {
    study<duffing, method> s;
    describe(s);
    s.chunk = 1;
    s.generate("every second one is invalid", [](std::int64_t first, ensemble<duffing>& e) {
        if (first % 2 == 1) e.parameter(duffing::k) = std::nan("");
    });
    const study_result r = s.run();
    CHECK(r.count(status::invalid_input) == 50);
    const auto t = r.values("t_last"), phases = r.values("phases");
    for (std::size_t i = 0; i < 100; ++i) {
        CHECK(std::isnan(t[i]) == (i % 2 == 1));
        for (std::size_t j = 2 * i; j < 2 * i + 2; ++j) CHECK(std::isnan(phases[j]) == (i % 2 == 1));
    }
}
TEST_CASE("Results are asked for within their bounds, and axes by their names", "[study]") {
    study<duffing, method> s;
    describe(s);
    const study_result r = s.run();
    CHECK(r.values("omega") == std::vector<double>{1, 1.1, 1.3, 0.7});
    CHECK(r.values("B") == std::vector<double>{0.3});
    CHECK(r.values("phase") == std::vector<double>{1, 2});
    CHECK(r.values_of<double>("x_end", 100, 0).empty());
    const std::int64_t most = std::numeric_limits<std::int64_t>::max();
    const std::int64_t outside[][2] = {{most, 1}, {1, most}, {-1, 1}, {0, 1'000'000'000'000'000}, {101, 0}};
    for (const auto& [first, count] : outside) {
        CHECK_THAT(message_of([&, f = first, n = count] { r.values_of<double>("x_end", f, n); }),
                   Contains("there are 100"));
        double value = 0;
        CHECK_THAT(message_of([&, f = first, n = count] { r.results().read("x_end", f, n, &value); }),
                   Contains("there are 100"));
    }
}
TEST_CASE("Chunks are large where little is kept of many instances", "[study]") {
    study<duffing, method> s;
    describe(s);
    s.options.record = {};
    s.options.samples = {};
    s.keep = {.random = false, .status = false};
    s.reduce(mean_of("x_end"));
    s.repeat(20'000'000);  // of 100: their values would take more memory than there is
    s.stop();              // before the run, which it ends too
    const study_result r = s.run();
    CHECK(!r.complete);
    CHECK(r.instances == 0);
    CHECK(r.content().chunk >= 1024);
}
TEST_CASE("A function may generate instances instead of axes", "[study]") {
    study<duffing, method> with_axes, generated, both;
    const auto set_rest = [](any_study& s) {
        s.set("v", 0.1);
        s.set("B", 0.3);
        s.set("power", 1);
        s.set("omega", 1);
        s.time_domain(0, 2);
        s.keep.end = {"x", "highest"};
        s.devices = {device::cpu(1)};
        s.chunk = 8;
    };
    set_rest(with_axes);
    with_axes.set("k", 0.25);
    with_axes.axis("x", linspace(-1, 1, 21));
    generated.repeat(21);
    set_rest(generated);
    generated.generate("version 1", [](std::int64_t first, ensemble<duffing>& e) {
        e.parameter(duffing::k) = 0.25;
        for (std::int64_t i = 0; i < e.size(); ++i) e.state(duffing::x)[i] = linspace(-1, 1, 21)[first + i];
    });
    set_rest(both);
    both.axis("k", linspace(0.2, 0.4, 21));
    both.generate("version 2", [](std::int64_t, ensemble<duffing>& e) {
        e.state(duffing::x) = 10 * (e.parameter(duffing::k) - 0.2) - 1;
        e.parameter(duffing::k) = 0.25;
    });
    const auto expected = with_axes.run().values("highest_end");
    CHECK(generated.run().values("highest_end") == expected);
    CHECK(both.run().values("highest_end")[20] == Approx(expected[20]).epsilon(1e-12));  // of x up to a rounding
    CHECK(generated.run().content().axes[0].name == "draw");
}

TEST_CASE("A study in a folder is not gone on with by a model that does something else", "[study]") {
    const folder here;
    const auto run = [&] {
        study<duffing, method> s;
        describe(s);
        s.store(here.store());
        return message_of([&] { s.run(); });
    };
    const auto text_of = [](const std::string& path) {
        std::ifstream file(path);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    CHECK(run() == "nothing was thrown");
    // As if the model had been edited since.
    const std::string path = here.store() + "/myriad/model.json";
    const std::string kept = text_of(path);
    std::string edited = kept;
    const std::size_t value = edited.find('[', edited.find("the right-hand side of state.v")) + 1;
    edited.replace(value, edited.find(',', value) - value, "12345");
    const std::string checksum = studies::seal_of(edited).stored;
    edited.replace(edited.rfind(checksum), checksum.size(), studies::unsealed);
    std::ofstream(path) << studies::sealed(edited);
    CHECK_THAT(run(), Contains("another study") && Contains("right-hand side of state.v: 12345 in the store, "));
    std::ofstream(path) << "damaged";
    CHECK(run() == "nothing was thrown");  // and it is written again
    CHECK(text_of(path) == kept);
}

namespace {

/// A study in a folder that calls a function before each chunk.
void describe_in_folder(study<duffing, method>& s, const std::string& path, std::function<void()> before_chunk) {
    describe(s);
    s.reduce(mean_of("x"));
    s.chunk = 4;
    s.store(path);
    s.generate("none", [=](std::int64_t, ensemble<duffing>&) { before_chunk(); });
}
content undisturbed() {
    study<duffing, method> s;
    describe(s);
    s.reduce(mean_of("x"));
    return content_of(s.run());
}

}  // namespace

TEST_CASE("A study in a folder is stopped, goes on, and has the same bits", "[study]") {
    const folder here;
    study<duffing, method> s;
    std::atomic<int> begun{0};
    describe_in_folder(s, here.store(), [&] {
        if (++begun % 9 == 0) s.stop();
    });
    int runs = 1;
    study_result r = s.run();
    for (std::int64_t done = r.instances; !r.complete; done += r.instances, ++runs) {
        CHECK(done < 100);
        REQUIRE(runs < 10);
        r = s.run();
    }
    CHECK(runs == 3);  // 25 chunks, 9 to 11 in each run, as two threads prepare them
    CHECK(difference(content_of(r), undisturbed()) == "");
    const study_result again = s.run();
    CHECK(again.complete);
    CHECK(again.instances == 0);
    CHECK(begun == 25);
    CHECK(difference(content_of(again), content_of(r)) == "");

    s.unit("k", "1/s");  // which would be that of some files alone
    CHECK_THAT(message_of([&] { s.run(); }), Contains("units"));
    s.options.relative_tolerance = 1e-6;
    CHECK_THAT(message_of([&] { s.run(); }), Contains("relative_tolerance"));
}
TEST_CASE("A study of delays that is stopped where rings are full goes on, and has the bits of a call", "[study]") {
    using delays::echo;
    constexpr std::int64_t lags = 30;
    options o;
    o.phases = 24;
    o.phase_length = 0.25;
    o.maximum_step = 1.0 / 64;
    o.history_steps = 128;  // those of t = 2
    const folder here;
    study<echo, cash_karp> s;
    s.axis("tau", linspace(0.2, 1.5, lags));
    for (const char* name : {"x", "z", "seen", "time"}) s.set(name, 0);
    s.set("period", 1.3);
    s.time_domain(0, std::numeric_limits<double>::infinity());
    s.options = o;
    s.keep.end = {"x", "z", "seen", "time"};
    s.devices = {device::cpu(2)};
    s.chunk = 4;
    s.store(here.store());
    std::atomic<int> begun{0};
    s.generate("none", [&](std::int64_t, ensemble<echo>&) {
        if (++begun == 3) s.stop();
    });
    CHECK(!s.run().complete);
    const study_result r = s.run();
    REQUIRE(r.complete);
    CHECK(r.instances < lags);

    ensemble<echo> e(lags);
    for (std::int64_t i = 0; i < lags; ++i) e.parameter(echo::tau)[i] = linspace(0.2, 1.5, lags)[i];
    e.parameter(echo::period) = 1.3;
    e.state(echo::x) = 0;
    e.state(echo::z) = 0;
    e.accessory(echo::seen) = 0;
    e.accessory(echo::time) = 0;
    e.time_domain(0, std::numeric_limits<double>::infinity());
    for (const int phases : {7, 17}) {  // in calls that go on, as well
        o.phases = phases;
        solve<cash_karp>(device::cpu(1), e, o);
    }
    const auto x = r.values("x_end"), z = r.values("z_end"), seen = r.values("seen_end"), time = r.values("time_end");
    for (std::size_t i = 0; i < lags; ++i) {
        const auto at = static_cast<std::int64_t>(i);
        REQUIRE(e.status(at) == status::success);
        CHECK(x[i] == e.state(echo::x)[at]);
        CHECK(z[i] == e.state(echo::z)[at]);
        CHECK(seen[i] == e.accessory(echo::seen)[at]);
        CHECK(time[i] == e.accessory(echo::time)[at]);
    }
}
TEST_CASE("SIGINT and SIGTERM end a study after the chunks under way, if it was asked for", "[study]") {
    for (const int signal : {SIGINT, SIGTERM}) {
        const folder here;
        study<duffing, method> s;
        std::atomic<int> begun{0};
        describe_in_folder(s, here.store(), [&] {
            if (++begun == 5) std::raise(signal);
        });
        s.stop_on_signals = true;
        const study_result r = s.run();
        CHECK(!r.complete);
        CHECK(r.instances >= 20);  // the five that were begun
        CHECK(r.instances == 4 * begun);
        CHECK(s.run().complete);
    }
}

// What the next case kills: the program with this case alone.
TEST_CASE("A study that is to be killed", "[.child]") {
    study<duffing, method> s;
    describe_in_folder(s, std::getenv("STUDY_TEST_FOLDER"), [] { usleep(30'000); });
    CHECK(s.run().complete);
}
TEST_CASE("A study that is killed at any time goes on and has the same bits", "[study]") {
    const auto expected = undisturbed();
    std::random_device random;
    for (int round = 0; round < 5; ++round) {
        const folder here;
        setenv("STUDY_TEST_FOLDER", here.store().c_str(), 1);
        const int processes = 1 + round % 2;
        std::vector<pid_t> children;
        for (int p = 0; p < processes; ++p) {
            const pid_t child = fork();
            if (child == 0) {
                const int nowhere = open("/dev/null", O_WRONLY);
                dup2(nowhere, STDOUT_FILENO);
                execl("/proc/self/exe", "study_test", "A study that is to be killed", nullptr);
                _exit(1);
            }
            children.push_back(child);
        }
        usleep(random() % 100'000);  // undisturbed two processes take 180 ms
        for (const pid_t child : children) kill(child, SIGKILL);
        for (const pid_t child : children) {
            int status = 0;
            waitpid(child, &status, 0);
            CHECK(WIFSIGNALED(status));
        }
        study<duffing, method> s;
        describe_in_folder(s, here.store(), [] {});
        const study_result r = s.run();
        CHECK(r.complete);
        CHECK(difference(content_of(r), expected) == "");
    }
}
TEST_CASE("Progress of a study never falls, and ends with all that is done", "[study]") {
    study<duffing, method> s;
    describe(s);
    s.chunk = 10;
    s.generate("slow", [](std::int64_t, ensemble<duffing>&) { usleep(30'000); });
    std::vector<work_progress> told;
    s.progress = [&](const work_progress& p) { told.push_back(p); };
    const study_result r = s.run();
    REQUIRE(told.size() >= 2);
    for (std::size_t i = 0; i < told.size(); ++i) {
        CHECK(told[i].total == 100);
        CHECK((i == 0 || told[i].done >= told[i - 1].done));
    }
    CHECK(told.back().done == 100);
    CHECK(told.back().by_status == r.by_status);

    s.progress = [](const work_progress&) { throw std::runtime_error("enough"); };
    CHECK_THROWS_WITH(s.run(), "enough");
}
TEST_CASE("Studies that cannot be run are refused before any work", "[study]") {
    const auto refusal = [](auto change) {
        study<duffing, method> s;
        describe(s);
        s.generate("counts", [](std::int64_t, ensemble<duffing>&) { FAIL("work was begun"); });
        change(s);
        return message_of([&] { s.run(); });
    };
    using any = study<duffing, method>;
    CHECK_THAT(refusal([](any& s) { s.options.relative_tolerance = -1; }), Contains("relative_tolerance is -1"));
    CHECK_THAT(refusal([](any& s) { s.options.progress = [](auto, auto) {}; }), Contains("options.progress"));
    CHECK_THAT(refusal([](any& s) { s.chunk = -1; }), Contains("chunk is -1"));
    CHECK_THAT(refusal([](any& s) { s.keep.end = {"y"}; }), Contains("\"y\" is no component of studied::duffing"));
    CHECK_THAT(refusal([](any& s) { s.repeat(std::int64_t{1} << 33); }),
               Contains("out of memory") && Contains("give it a folder"));
    CHECK_THAT(refusal([](any& s) {
                   s.repeat(std::int64_t{1} << 33);
                   s.chunk = s.size();
               }),
               Contains("out of memory") && Contains("make chunk smaller"));
    const folder here;
    CHECK_THAT(refusal([&](any& s) {
                   s.repeat(std::int64_t{1} << 33);
                   s.store(here.store());
               }),
               Contains("free"));
    study<duffing, runge_kutta_4> no_kernel;
    no_kernel.options.step = 0.1;
    no_kernel.devices = {device::cpu(1)};
    CHECK_THAT(message_of([&] { no_kernel.run(); }), Contains("not instantiated for this method"));
    study<duffing, method> s;
    s.reduce(mean_of("x"));
    CHECK_THAT(message_of([&] { s.reduce(mean_of("x")); }), Contains("x_mean is given twice"));
    CHECK_THAT(message_of([&] { s.unit("y", "m"); }), Contains("\"y\" is no component"));
}
