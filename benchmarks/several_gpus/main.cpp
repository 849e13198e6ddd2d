// SPDX-License-Identifier: MIT
// A sweep over the damping of the Duffing oscillator, with events and accessories, on one solver object and in equal
// parts on one per GPU: time from before the first upload to after the last download, medians of interleaved runs, with
// memory allocated beforehand. Usage: several_gpus [INSTANCES [PHASES]] [--check]; --check times nothing, and uses two
// solvers on the CPU if there is no GPU. Exit status 1 if the parts do not have the bits of the whole.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <iostream>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <myriad/myriad.hpp>

#include "examples/common/exit_status.hpp"
#include "examples/duffing/duffing.hpp"

namespace {

using solver = myriad::solver<duffing, myriad::cash_karp>;

struct settings {
    std::int64_t instances = 2'097'152, phases = 64;
    bool check = false;
};

myriad::options integration(std::int64_t phases) {
    return {.phases = phases,
            .relative_tolerance = 1e-9,
            .absolute_tolerance = 1e-9,
            .events = {{.direction = myriad::direction::falling, .tolerance = 1e-6}, {.tolerance = 1e-6}},
            .counting = myriad::counting::off};
}

/// Instances first, first + 1, ... of the sweep.
void fill(myriad::ensemble<duffing>& part, std::int64_t first, std::int64_t instances) {
    part.restart();
    const auto last = static_cast<double>(std::max<std::int64_t>(instances - 1, 1));
    for (std::int64_t i = 0; i < part.size(); ++i)
        part.parameter(duffing::k)(i) = 0.2 + 0.1 * static_cast<double>(first + i) / last;
    part.shared(duffing::B) = 0.3;
    part.state(duffing::x) = -0.5;
    part.state(duffing::v) = -0.1;
    part.time_domain(0, 2 * std::numbers::pi);
}

/// The sweep in equal parts, one per device.
class sweep {
public:
    sweep(const std::vector<myriad::device>& devices, const settings& chosen) : instances_(chosen.instances) {
        const auto parts = static_cast<std::int64_t>(devices.size());
        for (std::int64_t part = 0; part < parts; ++part) {
            begins_.push_back(instances_ * part / parts);
            solvers_.emplace_back(devices[static_cast<std::size_t>(part)],
                                  instances_ * (part + 1) / parts - begins_.back(), integration(chosen.phases));
        }
    }

    double seconds() {
        for (std::size_t part = 0; part < solvers_.size(); ++part)
            fill(solvers_[part].instances(), begins_[part], instances_);
        const auto begin = std::chrono::steady_clock::now();
        for (solver& s : solvers_) {
            s.upload();
            s.integrate();
            s.download();
        }
        for (solver& s : solvers_) s.wait();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }

    /// Results of the last run.
    std::vector<double> x() {
        std::vector<double> all;
        for (solver& s : solvers_) {
            const auto part = s.instances().state(duffing::x);
            all.insert(all.end(), part.data(), part.data() + part.size());
        }
        return all;
    }
    std::int64_t failed() {
        std::int64_t sum = 0;
        for (solver& s : solvers_) sum += s.report().failed();
        return sum;
    }

private:
    std::int64_t instances_;
    std::vector<std::int64_t> begins_;
    std::deque<solver> solvers_;  // solvers can be neither copied nor moved
};

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

int run(const settings& chosen) {
    std::vector<myriad::device> gpus;
    for (const myriad::device& d : myriad::devices())
        if (d.which() == myriad::device::kind::cuda) gpus.push_back(d);
    if (gpus.empty()) {
        if (!chosen.check) {
            std::cerr << "There is no GPU: " << myriad::device::no_gpu() << '\n';
            return 2;
        }
        gpus = {myriad::device::cpu(1), myriad::device::cpu(2)};
    }
    if (gpus.size() == 1) gpus.push_back(gpus.front());  // two solvers share it

    sweep one({gpus.front()}, chosen), several(gpus, chosen);
    std::vector<double> alone, together;
    for (int repetition = 0; repetition < (chosen.check ? 1 : 6); ++repetition) {
        alone.push_back(one.seconds());
        together.push_back(several.seconds());
    }
    if (!chosen.check) {
        alone.erase(alone.begin());  // the first run warms up
        together.erase(together.begin());
    }
    const bool same = one.x() == several.x();
    std::cout << "devices,instances,phases,failed,one_ms,several_ms,ratio,same_bits\n";
    for (std::size_t i = 0; i < gpus.size(); ++i) std::cout << (i > 0 ? " + " : "") << gpus[i].name();
    std::cout << ',' << chosen.instances << ',' << chosen.phases << ',' << one.failed() << ',' << 1e3 * median(alone)
              << ',' << 1e3 * median(together) << ',' << median(together) / median(alone) << ','
              << (same ? "yes" : "NO") << '\n';
    return same ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
    settings chosen;
    std::vector<std::int64_t*> numbers{&chosen.phases, &chosen.instances};
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        char* end = nullptr;
        const std::int64_t number = std::strtoll(argv[i], &end, 10);
        if (argument == "--check") {
            chosen.check = true;
        } else if (!numbers.empty() && *end == '\0' && number > 0) {
            *numbers.back() = number;
            numbers.pop_back();
        } else {
            std::cerr << "Usage: several_gpus [INSTANCES [PHASES]] [--check]\n";
            return 2;
        }
    }
    try {
        return examples::after_output(run(chosen));
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
    }
    return 2;
}
