// SPDX-License-Identifier: MIT
// The background thread runs all its tasks, in order, and passes on their exceptions.
#include "myriad/host/threads/worker_thread.hpp"

#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "tests/catch.hpp"

TEST_CASE("tasks in the background are done in order, by one other thread") {
    myriad::host::worker_thread other;
    std::vector<int> done;
    std::vector<std::thread::id> by;
    std::future<void> last;
    for (int i = 0; i < 100; ++i)
        last = other.ask([&, i] {
            done.push_back(i);
            by.push_back(std::this_thread::get_id());
        });
    last.get();
    REQUIRE(done.size() == 100);
    for (int i = 0; i < 100; ++i) CHECK(done[static_cast<std::size_t>(i)] == i);
    for (const auto id : by) CHECK(id == by.front());
    CHECK(by.front() != std::this_thread::get_id());
}

TEST_CASE("what a task in the background throws reaches the one who waits, and later tasks are done") {
    myriad::host::worker_thread other;
    auto bad = other.ask([] { throw std::runtime_error("enough"); });
    std::atomic<bool> reached{false};
    auto good = other.ask([&] { reached = true; });
    CHECK_THROWS_AS(bad.get(), std::runtime_error);
    good.get();
    CHECK(reached);
}

TEST_CASE("the end of a background thread waits for the task at work and drops the others") {
    std::promise<void> begun, go;
    std::atomic<int> done{0};
    {
        auto other = std::make_unique<myriad::host::worker_thread>();
        other->ask([&, may = go.get_future().share()] {
            begun.set_value();
            may.wait();
            ++done;
        });
        begun.get_future().get();
        std::vector<std::future<void>> dropped;
        dropped.push_back(other->ask([&] { ++done; }));
        std::thread end([&] { other.reset(); });
        CHECK_THROWS_AS(dropped.front().get(), std::future_error);  // broken promise
        CHECK(done == 0);
        go.set_value();
        end.join();
    }
    CHECK(done == 1);
}

TEST_CASE("a background thread that was lent and given back works for the next one, without what was left") {
    std::thread::id first, second;
    std::promise<void> begun, go;
    std::atomic<int> done{0};
    std::future<void> left;
    std::optional<myriad::host::pooled_worker> lent(std::in_place);
    (*lent)->ask([&, may = go.get_future().share()] {
        first = std::this_thread::get_id();
        begun.set_value();
        may.wait();
        ++done;
    });
    begun.get_future().get();
    left = (*lent)->ask([&] { ++done; });
    std::thread end([&] { lent.reset(); });
    CHECK_THROWS_AS(left.get(), std::future_error);  // broken promise
    CHECK(done == 0);
    go.set_value();
    end.join();
    CHECK(done == 1);
    myriad::host::pooled_worker next, beside_it;
    next->ask([&] { second = std::this_thread::get_id(); }).get();
    CHECK(first == second);
    beside_it->ask([&] { second = std::this_thread::get_id(); }).get();
    CHECK(first != second);
}
