// SPDX-License-Identifier: MIT
// Studies over MPI: every case runs on all ranks at the same time, and also on one process. That a rank is killed is
// tested by examples/mpi/check.sh.
#include "myriad/mpi.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <myriad/study.hpp>
#include <sched.h>

#include "tests/catch.hpp"
#include "tests/support/problems.hpp"

namespace {

using namespace myriad;
using Catch::Matchers::Contains;

mpi_ranks& ranks() {
    static mpi_ranks all;
    return all;
}

std::int64_t sum(std::int64_t own) {
    std::int64_t all = 0;
    MPI_Allreduce(&own, &all, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    return all;
}

/// A folder of its own for each case, which all ranks know.
struct shared_folder {
    std::filesystem::path path;
    shared_folder() {
        std::string name = (std::filesystem::temp_directory_path() / "myriad_mpi_XXXXXX").string();
        if (ranks().rank() == 0 && mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        MPI_Bcast(name.data(), static_cast<int>(name.size()), MPI_CHAR, 0, MPI_COMM_WORLD);
        path = name;
    }
    shared_folder(const shared_folder&) = delete;
    shared_folder& operator=(const shared_folder&) = delete;
    ~shared_folder() {
        MPI_Barrier(MPI_COMM_WORLD);
        if (ranks().rank() == 0) std::filesystem::remove_all(path);
    }
    std::string store() const { return (path / "store").string(); }
};

/// 200 instances in 20 chunks.
struct example : study<problems::oscillator, runge_kutta_4> {
    explicit example(const std::string& folder) {
        axis("x", linspace(-1, 1, 200));
        set("v", 0.5);
        time_domain(0, 20);
        options.step = 0.01;
        chunk = 10;
        keep.end = {"x"};
        if (!folder.empty()) store(folder);
    }
};

std::vector<double> expected() {
    example alone("");
    alone.devices = {device::cpu(1)};
    return alone.run().values("x_end");
}

}  // namespace

TEST_CASE("ranks share the cores, or have GPUs of their own") {
    REQUIRE_FALSE(ranks().devices().empty());
    if (ranks().devices()[0].which() != device::kind::cpu) return;
    cpu_set_t own, of_any;
    REQUIRE(sched_getaffinity(0, sizeof own, &own) == 0);
    MPI_Allreduce(&own, &of_any, sizeof own, MPI_BYTE, MPI_BOR, MPI_COMM_WORLD);
    const int threads = ranks().devices()[0].threads(), cores = std::max(CPU_COUNT(&of_any), ranks().size());
    CHECK(threads >= 1);
    CHECK(threads <= CPU_COUNT(&own));
    CHECK(sum(threads) <= cores);
    const bool is_bound = sum(CPU_EQUAL(&own, &of_any) ? 0 : 1) > 0;
    if (!is_bound) CHECK(sum(threads) == cores);
}

TEST_CASE("each chunk is done once, by one of the ranks, and never again") {
    const shared_folder here;
    example s(here.store());
    const study_result first = ranks().run(s);
    CHECK(first.complete);
    CHECK(first.values("x_end") == expected());
    CHECK(sum(first.instances) == 200);
    CHECK(s.devices.empty());
    CHECK_FALSE(s.chunk_counter);
    const study_result second = ranks().run(s);
    CHECK(second.complete);
    CHECK(second.instances == 0);
    CHECK_FALSE(ranks().lost());
}

TEST_CASE("a rank that throws loses nothing, and the others end the study") {
    const shared_folder here;
    example s(here.store());
    const bool throws = ranks().rank() == ranks().size() - 1;
    if (throws) s.progress = [](const work_progress&) { throw std::runtime_error("enough"); };
    if (throws) {
        CHECK_THROWS_WITH(ranks().run(s), "enough");
    } else {
        const study_result result = ranks().run(s);
        CHECK(result.complete);
        CHECK(result.values("x_end") == expected());
    }
    CHECK_FALSE(ranks().lost());
}

TEST_CASE("what was stopped goes on with other ranks, from the chunks that are not done") {
    const shared_folder here;
    example s(here.store());
    s.stop();
    const study_result none = ranks().run(s);
    CHECK_FALSE(none.complete);
    const std::int64_t before = sum(none.instances);
    if (ranks().rank() == 0) {  // a process outside of the job
        example alone(here.store());
        alone.devices = {device::cpu(1)};
        int left = 5;
        alone.progress = [&](const work_progress& now) {
            if (now.done >= 50 && --left == 0) alone.stop();
        };
        CHECK(alone.run().instances > 0);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    example again(here.store());
    const study_result result = ranks().run(again);
    CHECK(result.complete);
    CHECK(before + sum(result.instances) <= 200);
    CHECK(result.values("x_end") == expected());
}

TEST_CASE("a study without a folder is refused by all ranks") {
    example s("");
    const char* const why = ranks().rank() == 0 ? "needs a folder that they share" : "rank 0 does not start the study";
    CHECK_THROWS_WITH(ranks().run(s), Contains(why));
}
