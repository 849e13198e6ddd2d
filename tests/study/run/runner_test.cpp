// SPDX-License-Identifier: MIT
// The run of a study whose model costs nothing: devices that fail, memory that is short, results that cannot be kept.
// GPUs are simulated.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <functional>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include <myriad/myriad.hpp>
#include <myriad/study.hpp>
#include <myriad/study/run/runner.hpp>

#include "tests/catch.hpp"
#include "tests/host/solve/simulated_gpu.hpp"
#include "tests/study/models.hpp"

namespace {

using namespace myriad;
using namespace myriad::studies;
using Catch::Matchers::Contains;

/// What happens when instances are integrated.
using event = std::function<void(const device& where, std::int64_t first, std::int64_t count)>;

/// x = 2 k.
class doubling final : public any_model {
public:
    explicit doubling(event integrate, std::function<void()> reduce = {})
        : integrate_(std::move(integrate)), reduce_(std::move(reduce)) {}
    const component_names& names() const override { return names_; }
    std::string method() const override { return "none"; }
    element real() const override { return element::f64; }
    void check(const device&, const options&) const override {}
    double bytes_per_instance(const options&) const override { return 16; }
    arithmetic arithmetic_on(const device&) const override { return {}; }
    std::string generator() const override { return {}; }
    std::unique_ptr<chunk_solver> make_solver(const study_plan& plan, const device& on) const override {
        struct solver final : chunk_solver {
            solver(const study_plan& p, const event& e, const std::function<void()>& r)
                : plan(p), integrated(e), reduced(r) {}
            bool on_device() const override { return reduced != nullptr; }
            bool reduce(std::size_t number, reduction_state& to) override {
                if (!reduced) return false;
                reduced();
                const auto& of = plan.asked.reductions[number].definition().inputs.front();
                for (const quantity& q : plan.quantities) {
                    if (q.as.name != of) continue;
                    std::vector<std::byte> values(k.size() * sizeof(double)), how(k.size());
                    copy(q, values.data());
                    std::fill(how.begin(), how.end(), static_cast<std::byte>(status::success));
                    const variable statuses{.name = "status", .type = element::u8, .attributes = {}};
                    const std::vector<chunk_columns::column> columns{{&q.as, values}, {&statuses, how}};
                    to.add(chunk_columns(first, static_cast<std::int64_t>(k.size()), columns));
                }
                return true;
            }
            void prepare(std::int64_t from, std::int64_t count) override {
                first = from;
                k.resize(static_cast<std::size_t>(count));
                plan.asked.axes.fill(plan.asked.axes.entries()[0], first, count, k.data());
            }
            solved integrate(const device& where, const std::function<void(std::int64_t)>& progress) override {
                const auto count = static_cast<std::int64_t>(k.size());
                integrated(where, first, count);
                progress(count - 1);
                progress(count);
                solved how;
                how.by_status[static_cast<std::size_t>(status::success)] = count;
                return how;
            }
            void copy(const quantity& what, std::byte* to) const override {
                if (what.from == origin::status) {
                    std::memset(to, static_cast<int>(status::success), k.size());
                    return;
                }
                std::vector<double> x(k);
                for (double& value : x) value *= 2;
                std::memcpy(to, x.data(), x.size() * sizeof(double));
            }
            void clear() override { k = {}; }

            const study_plan& plan;
            const event& integrated;
            const std::function<void()> reduced;
            std::int64_t first = 0;
            std::vector<double> k;
        };
        const bool reduces = on.which() == device::kind::cuda && reduce_;
        return std::make_unique<solver>(plan, integrate_, reduces ? reduce_ : std::function<void()>());
    }

private:
    component_names names_{"doubling", {{component_kind::state, 0, "x"}, {component_kind::parameter, 0, "k"}}};
    event integrate_;
    std::function<void()> reduce_;  // on a GPU, before it does so
};

/// A run of 1000 instances.
struct test_run {
    std::vector<device> devices{device::cpu()};
    event integrate = [](auto&&...) {};
    std::int64_t chunk = 30;
    std::function<void(result_keeper&)> before = [](result_keeper&) {};
    std::function<void()> reduce = {};  // on a GPU
    std::function<void()> start = {};   // of the second reduction
    std::vector<std::string> warnings = {};
    std::function<bool()> stops = {};
    std::chrono::milliseconds patience = std::chrono::seconds(10);

    run_outcome run() {
        const doubling model(integrate, reduce);
        axes a(model.names());
        a.add("k", linspace(0, 999, 1000));
        for (const char* name : {"x", "t_begin", "t_end"}) a.set(name, 0);
        study_request asked{"none", element::f64, a, {}, {}, {}, {}, {}, {}, {}};
        asked.keep.end = {"x"};
        asked.reductions = {histogram_of("x_end", linspace(0, 2000, 2)), mean_of("x_end")};
        study_plan plan = plan_study(asked);
        if (start)
            plan.reductions[1].start = [call = start, make = plan.reductions[1].start] {
                call();
                return make();
            };
        plan.content.chunk = chunk;
        const auto keeper = keep_in_memory(plan.content);
        before(*keeper);
        const run_outcome outcome =
            run_study(model, plan, *keeper,
                      {.devices = devices,
                       .tried_after = 0,
                       .stops = stops,
                       .patience = patience,
                       .warning = [this](const std::string& text) { warnings.push_back(text); }});
        if (outcome.complete) {
            std::vector<double> x(1000);
            keeper->kept()->read("x_end", 0, 1000, x.data());
            for (std::size_t i = 0; i < x.size(); ++i) CHECK(x[i] == 2.0 * static_cast<double>(i));
            double mean = 0;
            keeper->kept()->read("x_end_mean", 0, 1, &mean);
            CHECK(mean == 999);
            std::int64_t counted = 0;
            keeper->kept()->read("x_end_histogram", 0, 1, &counted);
            CHECK(counted == 1000);
        }
        return outcome;
    }
    std::string message() {
        try {
            run();
        } catch (const error& e) {
            return e.what();
        }
        return "nothing was thrown";
    }
};
bool is_gpu(const device& d) { return d.which() == device::kind::cuda; }

}  // namespace

TEST_CASE("All devices get chunks, each chunk is done once", "[runner]") {
    std::atomic<int> on_cpu{0}, on_gpu{0};
    test_run t;
    t.devices = {device::cpu(1), device::cuda(), device::cpu(2)};
    t.integrate = [&](const device& where, std::int64_t, std::int64_t) {
        ++(is_gpu(where) ? on_gpu : on_cpu);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    const run_outcome outcome = t.run();
    CHECK(outcome.complete);
    CHECK(outcome.instances == 1000);
    CHECK(on_cpu + on_gpu >= 34);  // a chunk that was given back is integrated again
    CHECK(on_cpu > 0);
    CHECK(on_gpu > 0);
    CHECK(t.warnings.empty());
}
TEST_CASE("A chunk that takes too long when the run is to end is given up, and not counted", "[runner]") {
    for (const bool patient : {true, false}) {
        std::atomic<int> begun{0};
        test_run t;
        t.integrate = [&](auto&&...) { ++begun; };
        t.stops = [&] { return begun >= 3; };
        if (!patient) t.patience = std::chrono::milliseconds(0);
        const run_outcome outcome = t.run();
        CHECK(!outcome.complete);
        CHECK((outcome.instances == 30 * begun) == patient);
        CHECK(outcome.instances % 30 == 0);
        CHECK(t.warnings.empty());
    }
}
TEST_CASE("One thread integrates on a device at a time", "[runner]") {
    std::atomic<int> at_once{0}, most{0};
    test_run t;
    t.integrate = [&](auto&&...) {
        most = std::max<int>(most, ++at_once);
        std::this_thread::sleep_for(std::chrono::microseconds(200));
        --at_once;
    };
    CHECK(t.run().complete);
    CHECK(most == 1);
}
TEST_CASE("A GPU that fails is dropped with a warning, and its chunks are done elsewhere", "[runner]") {
    std::atomic<int> calls{0};
    test_run t;
    t.devices = {device::cuda(), device::cpu(1)};
    t.integrate = [&](const device& where, std::int64_t, std::int64_t) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (is_gpu(where) && ++calls > 3) throw error("unspecified launch failure");
    };
    CHECK(t.run().complete);
    CHECK(calls == 4);
    REQUIRE(t.warnings.size() == 1);
    CHECK_THAT(t.warnings[0], Contains("device cuda:0 is left out") && Contains("unspecified launch failure"));
}
TEST_CASE("If all devices fail, the last failure ends the run", "[runner]") {
    test_run t;
    t.devices = {device::cuda()};
    t.integrate = [](auto&&...) { throw error("unspecified launch failure"); };
    CHECK_THAT(t.message(), Contains("no device is left") && Contains("unspecified launch failure"));
}
TEST_CASE("What the model throws on a CPU ends the run", "[runner]") {
    std::atomic<int> calls{0};
    test_run t;
    t.devices = {device::cpu(1), device::cuda()};
    t.integrate = [&](const device& where, std::int64_t, std::int64_t) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (!is_gpu(where) && ++calls == 2) throw error("a hook threw");
    };
    CHECK(t.message() == "a hook threw");
}
TEST_CASE("Where memory is short, fewer instances are integrated at a time", "[runner]") {
    std::mutex mutex;
    std::vector<std::int64_t> sizes;
    test_run t;
    t.integrate = [&](const device&, std::int64_t, std::int64_t count) {
        if (count > 8) throw out_of_memory("out of device memory");
        const std::lock_guard lock(mutex);
        sizes.push_back(count);
    };
    CHECK(t.run().complete);
    CHECK(*std::max_element(sizes.begin(), sizes.end()) == 8);  // 30, 15, 8
    REQUIRE(!t.warnings.empty());
    CHECK_THAT(t.warnings[0], Contains("15 instances are integrated at a time") && Contains("out of device memory"));

    t.integrate = [](auto&&...) { throw std::bad_alloc(); };
    CHECK_THAT(t.message(), Contains("out of memory"));
}
TEST_CASE("A GPU without free memory is left out where there is a CPU beside it", "[runner]") {
    test_run t;
    t.devices = {device::cuda(), device::cpu(1)};
    t.integrate = [](const device& where, std::int64_t, std::int64_t) {
        if (is_gpu(where)) throw out_of_memory("out of device memory");
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    CHECK(t.run().complete);
    REQUIRE(!t.warnings.empty());
    const auto left_out = [](const std::string& text) { return text.find("is left out") != text.npos; };
    CHECK(std::count_if(t.warnings.begin(), t.warnings.end(), left_out) == 1);

    t.devices = {device::cuda()};
    CHECK_THAT(t.message(), Contains("no device is left") && Contains("out of device memory"));
}
TEST_CASE("Both threads of a device that fails find it, and it is left out once", "[runner]") {
    for (int repetition = 0; repetition < 20; ++repetition) {
        std::atomic<int> at_once{0};
        test_run t;
        t.devices = {device::cuda(), device::cpu(1)};
        t.integrate = [&](const device& where, std::int64_t, std::int64_t) {
            while (!is_gpu(where) && at_once == 0) std::this_thread::yield();  // which leaves something for the GPU
        };
        t.reduce = [&] {
            ++at_once;  // the threads of the GPU fail together
            const auto begin = std::chrono::steady_clock::now();
            while (at_once < 2 && std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(200))
                std::this_thread::yield();
            throw error("unspecified launch failure");
        };
        CHECK(t.run().complete);
        CHECK(t.warnings.size() == 1);
    }
}
TEST_CASE("Where memory is short in the middle of reductions, nothing is reduced twice", "[runner]") {
    for (int fails = 1; fails <= 6; ++fails) {
        std::atomic<int> calls{0};
        test_run t;
        t.devices = {device::cuda()};
        t.reduce = [] {};
        t.start = [&] {
            if (++calls == fails) throw std::bad_alloc();
        };
        CHECK(t.run().complete);
    }
}
TEST_CASE("A result that cannot be kept ends the run", "[runner]") {
    test_run t;
    t.before = [](result_keeper& keeper) { (void)keeper.claim_next(); };
    std::atomic<int> calls{0};
    t.integrate = [&](auto&&...) {
        if (++calls == 5) throw error("stop");
    };
    CHECK(t.message() == "stop");  // and does not wait for the chunk that somebody else has
}
TEST_CASE("A slow device takes no chunk that the others are done with earlier", "[runner]") {
    std::atomic<int> on_gpu{0};
    test_run t;
    t.chunk = 10;
    t.devices = {device::cpu(1), device::cuda()};
    t.integrate = [&](const device& where, std::int64_t, std::int64_t) {
        std::this_thread::sleep_for(std::chrono::milliseconds(is_gpu(where) ? 400 : 1));
        if (is_gpu(where)) ++on_gpu;
    };
    CHECK(t.run().complete);
    CHECK(on_gpu <= 2);  // of its two threads, each without knowing how long it takes
}
TEST_CASE("A CPU that is a thousand times slower than the GPU beside it gives its chunk back", "[runner]") {
    std::atomic<std::int64_t> on_cpu{0}, on_gpu{0};
    test_run t;
    t.devices = {device::cpu(1), device::cuda()};
    t.chunk = 500;
    t.integrate = [&](const device& where, std::int64_t, std::int64_t count) {
        std::this_thread::sleep_for(std::chrono::microseconds(is_gpu(where) ? count : 1000 * count));
        (is_gpu(where) ? on_gpu : on_cpu) += count;
    };
    CHECK(t.run().complete);
    CHECK(on_gpu == 1000);
    CHECK(on_cpu <= 192);  // 64 and 128, by which its rate is known
}
TEST_CASE("A study on a GPU that is lost has the same bits as on the CPU", "[runner]") {
    const auto run = [](std::vector<device> devices, int chunks_before) {
        study<studied::duffing, dense<tsitouras_5>> s;
        s.axis("k", linspace(0.2, 0.3, 200));
        s.set("omega", 1);
        s.set("x", -0.5);
        s.set("v", 0);
        s.set("B", 0.3);
        s.set("power", 3);
        s.time_domain(0, 1);
        s.keep.end = {"x", "my_number"};
        s.chunk = 1;
        s.devices = std::move(devices);
        s.warning = {};
        s.generate("slow", [](std::int64_t, auto&) { std::this_thread::sleep_for(std::chrono::microseconds(200)); });
        if (chunks_before >= 0) simulated::the_gpu.fail(simulated::call::kernel, chunks_before);
        study_result r = s.run();
        CHECK(r.complete);
        CHECK(r.warnings.size() == (chunks_before >= 0 ? 1 : 0));
        auto x = r.values("x_end"), number = r.values("my_number_end");
        x.insert(x.end(), number.begin(), number.end());
        return x;
    };
    const auto expected = run({device::cpu(1)}, -1);
    CHECK(run({device::cuda()}, -1) == expected);
    CHECK(run({device::cuda(), device::cpu(1)}, 1) == expected);
}
TEST_CASE("No GPU reduces more instances at a time than the digits of a sum have room for", "[runner]") {
    const model_of<studied::lorenz, runge_kutta_4, float> model;
    axes a(model.names());
    for (const char* name : {"x", "y", "z", "r", "t_begin", "t_end"}) a.set(name, 1);
    a.repeat(std::int64_t{1} << 40);
    study_request asked{model.method(), model.real(), a, {}, {}, {}, {}, {}, {}, {}};
    asked.options.step = 0.01;
    const study_plan plan = plan_study(asked);
    const std::int64_t before = simulated::the_gpu.memory = std::int64_t{1} << 58;
    CHECK(model.make_device_solver(plan, device::cuda())->most_at_a_time() == std::int64_t{1} << 30);
    simulated::the_gpu.memory = before;
}
