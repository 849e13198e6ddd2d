// SPDX-License-Identifier: MIT
// Devices of different speed share a study: by a clock that is simulated, so that other programs do not matter.
#include "myriad/study/run/work_sharing.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/host/solve/simulated_gpu.hpp"

namespace {

using namespace myriad;
using namespace myriad::studies;

struct simulated_device {
    device where;
    double per_second;
    double overhead = 0;  // seconds of a call
    double first = 0;     // further ones of the first call, as for loading a kernel
};

/// What the run of a study does with devices, in simulated time.
class simulated_run {
public:
    simulated_run(std::vector<simulated_device> devices, std::int64_t chunks, std::int64_t chunk)
        : devices_(std::move(devices)), chunk_(chunk), open_(chunks), left_(chunks * chunk),
          sharing_(places(devices_), chunk), at_work_(devices_.size()), chunks_of_(devices_.size()) {}

    /// Seconds until all is done.
    double seconds() {
        while (left_ > 0) {
            for (std::size_t d = 0; d < devices_.size(); ++d)
                if (!at_work_[d]) begin(d);
            std::size_t next = 0;
            double end = std::numeric_limits<double>::infinity();
            for (std::size_t d = 0; d < devices_.size(); ++d) {
                if (!at_work_[d] || at_work_[d]->end >= end) continue;
                next = d;
                end = at_work_[d]->end;
            }
            REQUIRE(end < std::numeric_limits<double>::infinity());  // somebody works
            const bool somebody_waits = std::find(at_work_.begin(), at_work_.end(), std::nullopt) != at_work_.end();
            if (somebody_waits && open_ > 0 && end > now_ + 0.01) {
                now_ += 0.01;  // and asks again
                continue;
            }
            now_ = end;
            part_done(next);
        }
        return now_;
    }
    std::int64_t chunks_of(std::size_t d) const { return chunks_of_[d]; }

private:
    struct work {
        std::int64_t at, part;
        double claimed, begin, end;
        bool operator==(const work&) const = default;
    };
    static std::vector<device> places(const std::vector<simulated_device>& devices) {
        std::vector<device> all;
        for (const simulated_device& d : devices) all.push_back(d.where);
        return all;
    }

    void begin(std::size_t d) {
        if (!sharing_.is_worthwhile(d, chunk_, left_, now_)) return;
        if (open_ == 0) {
            for (std::size_t o = 0; o < devices_.size(); ++o) {
                if (!at_work_[o] || devices_[o].where.which() != device::kind::cpu) continue;  // a kernel is not ended
                const work& its = *at_work_[o];
                const double since = now_ - its.begin;
                const auto done = its.at + static_cast<std::int64_t>(since * devices_[o].per_second);
                if (!sharing_.is_better_off_with(d, o, chunk_ - done, done, now_ - its.claimed)) continue;
                give_back(o);
                break;
            }
        }
        if (open_ == 0) return;
        --open_;
        go_on(d, 0, now_);
    }
    void go_on(std::size_t d, std::int64_t at, double claimed) {
        const std::int64_t part = sharing_.part(d, chunk_ - at, left_);
        simulated_device& is = devices_[d];
        const double takes = is.overhead + std::exchange(is.first, 0) + static_cast<double>(part) / is.per_second;
        at_work_[d] = work{at, part, claimed, now_, now_ + takes};
    }
    void part_done(std::size_t d) {
        const work was = *at_work_[d];
        sharing_.measured(d, was.part, was.end - was.begin);
        left_ -= was.part;
        at_work_[d]->at += was.part;
        const std::int64_t at = at_work_[d]->at;
        if (at == chunk_) {
            ++chunks_of_[d];
            at_work_[d].reset();
        } else if (!sharing_.is_worthwhile(d, chunk_ - at, left_ + at, now_)) {
            give_back(d);
        } else {
            go_on(d, at, was.claimed);
        }
    }
    void give_back(std::size_t d) {
        left_ += at_work_[d]->at;
        at_work_[d].reset();
        ++open_;
    }

    std::vector<simulated_device> devices_;
    std::int64_t chunk_, open_, left_;
    work_sharing sharing_;
    std::vector<std::optional<work>> at_work_;
    std::vector<std::int64_t> chunks_of_;
    double now_ = 0;
};

constexpr std::int64_t chunk = 1 << 20;

}  // namespace

TEST_CASE("A study on two GPUs takes no longer with a CPU beside them, however slow it is", "[work_sharing]") {
    const double slower = GENERATE(1.0, 2.0, 5.0, 20.0, 100.0, 1000.0, 1e5);
    const std::int64_t chunks = GENERATE(1, 2, 3, 5, 8, 32, 33, 100);
    const double first = GENERATE(0.0, 0.02);  // a tenth of a second to load a kernel is long for a study
    CAPTURE(slower, chunks, first);
    const simulated_device gpu{device::cuda(), 1e8, 1e-5, first}, cpu{device::cpu(16), 1e8 / slower, 1e-5, 0.002};
    const double alone = simulated_run({gpu, gpu}, chunks, chunk).seconds();
    simulated_run with_cpu({gpu, gpu, cpu}, chunks, chunk);
    CHECK(with_cpu.seconds() <= 1.05 * alone);
    if (slower >= 1000) CHECK(with_cpu.chunks_of(2) == 0);
}
TEST_CASE("A study on a CPU takes no longer with a slow GPU or a CPU of few threads beside it", "[work_sharing]") {
    const bool is_gpu = GENERATE(false, true);
    const double slower = is_gpu ? GENERATE(1.0, 3.0, 10.0, 50.0) : GENERATE(1.0, 10.0, 1000.0, 1e5);
    CAPTURE(slower, is_gpu);
    const simulated_device cpu{device::cpu(16), 1e6, 1e-5};
    const simulated_device slow{is_gpu ? device::cuda() : device::cpu(1), 1e6 / slower, 1e-5};
    const double alone = simulated_run({cpu}, 64, chunk).seconds();
    const double together = simulated_run({cpu, slow}, 64, chunk).seconds();
    CHECK(together <= 1.05 * alone);
    if (slower <= 3) CHECK(together <= 0.85 * alone);
}
TEST_CASE("A device that does a fifth of the work is used", "[work_sharing]") {
    const simulated_device gpu{device::cuda(), 1e8, 1e-5}, cpu{device::cpu(16), 2e7, 1e-5};
    const double alone = simulated_run({gpu}, 128, chunk).seconds();
    simulated_run both({gpu, cpu}, 128, chunk);
    CHECK(both.seconds() < 0.88 * alone);  // 0.83 if nothing were lost
    CHECK(both.chunks_of(1) >= 16);
}
TEST_CASE("A CPU is not tried beside a GPU that is done in a tenth of a second", "[work_sharing]") {
    const simulated_device gpu{device::cuda(), 1e8, 1e-5}, cpu{device::cpu(16), 2e7, 1e-5};
    for (const std::int64_t chunks : {1, 3, 8}) {
        simulated_run both({gpu, cpu}, chunks, chunk);
        CHECK(both.seconds() < simulated_run({gpu}, chunks, chunk).seconds() + 1e-4);
        CHECK(both.chunks_of(1) == 0);
    }
}
TEST_CASE("Equal GPUs, and a device alone, take whole chunks", "[work_sharing]") {
    const device gpu = device::cuda();
    for (const std::vector<device>& all : {std::vector{gpu, gpu}, {gpu}, {device::cpu()}}) {
        work_sharing sharing(all, chunk);
        CHECK(sharing.is_known(0));
        CHECK(sharing.part(0, chunk, 10 * chunk) == chunk);
        sharing.measured(0, chunk, 1);
        CHECK(sharing.part(0, chunk, 10 * chunk) == chunk);
    }
}
TEST_CASE("What is left of dropped devices' rates is nothing", "[work_sharing]") {
    work_sharing sharing({device::cuda(), device::cpu(4)}, chunk);
    for (int call = 0; call < 2; ++call) sharing.measured(0, chunk, 0.01);  // the first loads its kernel
    sharing.measured(1, chunk, 100);
    CHECK_FALSE(sharing.is_worthwhile(1, chunk, 10 * chunk, 1));
    sharing.drop(0);
    CHECK(sharing.is_worthwhile(1, chunk, 10 * chunk, 1));
}
