// SPDX-License-Identifier: MIT
// The cost of 1000 Runge-Kutta steps of Lorenz' equations on a GPU besides the kernel: set-up of a solver object,
// `solve` with its transfers, and small ensembles. One CSV row per measurement, below a header with the work, the
// method and the machine. Exit status 0; 1 if `solve` and the solver object disagree in a bit; 2 for an error.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <myriad/myriad.hpp>

#include "benchmarks/gpu_ensembles/by_hand.hpp"
#include "benchmarks/gpu_ensembles/measure.hpp"
#include "benchmarks/gpu_ensembles/models.hpp"
#include "examples/common/exit_status.hpp"

namespace {

using gpu_ensembles::eight_thirds;
using gpu_ensembles::lorenz;
using gpu_ensembles::lorenz_by_hand;
using gpu_ensembles::median;
using solver = myriad::solver<lorenz, myriad::runge_kutta_4>;

constexpr int steps = 1000;
constexpr double h = 1e-3, largest_rho = 21, start = 10;

struct settings {
    std::string device = "auto", output, commit = "not given";
    double instances_scale = 1;
    int repetitions = 7;
};

/// Milliseconds that a call takes.
template <class Call>
double milliseconds(Call&& call) {
    const auto begin = std::chrono::steady_clock::now();
    call();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

/// One row; values not measured are left empty.
struct row {
    std::string name;
    myriad::counting counting;
    std::int64_t instances;
    double set = NAN, upload = NAN, kernel = NAN, download = NAN, wall = NAN, ratio = NAN;
};

/// Standard output and, if requested, a file.
class table {
public:
    explicit table(const std::string& path) {
        if (!path.empty()) file_.open(path);
        if (!path.empty() && !file_) throw std::runtime_error("the file " + path + " cannot be written");
    }
    void write(const std::string& line) {
        std::cout << line << std::endl;
        if (file_.is_open()) file_ << line << std::endl;
        if (!std::cout || !file_) throw std::runtime_error("the output cannot be written");
    }
    void write(const row& r) {
        std::string line =
            r.name + (r.counting == myriad::counting::on ? ",on," : ",off,") + std::to_string(r.instances);
        for (const double value : {r.set, r.upload, r.kernel, r.download, r.wall, r.ratio}) {
            char text[32] = ",";
            if (!std::isnan(value)) std::snprintf(text, sizeof text, ",%.4f", value);
            line += text;
        }
        write(line);
    }

private:
    std::ofstream file_;
};

/// Sets the values of an ensemble: through its maps, or by a multi-threaded loop, as a user may.
void set_by_maps(myriad::ensemble<lorenz>& e) {
    e.restart();
    e.parameter(lorenz::rho) = Eigen::ArrayXd::LinSpaced(e.size(), 0, largest_rho);
    for (const auto c : {lorenz::x, lorenz::y, lorenz::z}) e.state(c) = start;
    e.time_domain(0, steps * h);
}
void set_by_threads(myriad::ensemble<lorenz>& e) {
    e.restart();
    auto rho = e.parameter(lorenz::rho), x = e.state(lorenz::x), y = e.state(lorenz::y), z = e.state(lorenz::z);
    const std::int64_t size = e.size();
    const double spacing = size > 1 ? largest_rho / static_cast<double>(size - 1) : 0;
    const int threads = static_cast<int>(std::min<std::int64_t>(16, 1 + size / 65536));
#pragma omp parallel for num_threads(threads)
    for (std::int64_t i = 0; i < size; ++i) {
        rho[i] = spacing * static_cast<double>(i);
        x[i] = y[i] = z[i] = start;
    }
    e.time_domain(0, steps * h);
}

myriad::options integration(myriad::counting counting) { return {.step = h, .counting = counting}; }

class benchmark {
public:
    benchmark(const settings& chosen, const myriad::device& where, table& out)
        : chosen_(chosen), where_(where), out_(out) {}

    void run() {
        for (const auto counting : {myriad::counting::off, myriad::counting::on}) {
            counting_ = counting;
            set_up("set_up_maps", &set_by_maps);
            set_up("set_up_threads", &set_by_threads);
            for (const std::int64_t size :
                 {100'000, 200'000, 500'000, 1'000'000, 2'000'000, 4'000'000, 8'000'000, 16'000'000})
                solve(scaled(size));
            for (const std::int64_t size : {1, 10, 100, 1024, 8192}) small(size);
        }
    }
    bool right() const { return right_; }

private:
    using setter = void (*)(myriad::ensemble<lorenz>&);

    std::int64_t scaled(std::int64_t size) const {
        return std::max<std::int64_t>(1, std::llround(static_cast<double>(size) * chosen_.instances_scale));
    }

    /// Calls `once()`, which returns a row, after a warm-up, and returns the medians.
    template <class Once>
    row medians(const std::string& name, std::int64_t size, Once&& once) const {
        once();
        std::vector<row> all;
        for (int i = 0; i < chosen_.repetitions; ++i) all.push_back(once());
        row result{name, counting_, size};
        for (double row::*const value : {&row::set, &row::upload, &row::kernel, &row::download, &row::wall}) {
            std::vector<double> values;
            for (const row& r : all) values.push_back(r.*value);
            if (!std::isnan(values[0])) result.*value = median(values);
        }
        return result;
    }

    /// Every stage of a solver object, timed separately.
    static row stages(solver& s, setter set) {
        row r{};
        r.set = milliseconds([&] { set(s.instances()); });
        r.upload = milliseconds([&] {
            s.upload();
            s.wait();
        });
        s.integrate();
        s.wait();
        r.download = milliseconds([&] {
            s.download();
            s.wait();
        });
        r.kernel = 1e3 * s.report().seconds;
        r.wall = r.set + r.upload + r.download;
        return r;
    }

    void set_up(const std::string& name, setter set) {
        const std::int64_t size = scaled(1'000'000);
        solver s(where_, size, integration(counting_));
        row r = medians(name, size, [&] { return stages(s, set); });
        r.ratio = r.wall / r.kernel;
        out_.write(r);
    }

    void solve(std::int64_t size) {
        row parts;
        std::vector<double> expected;
        {
            solver s(where_, size, integration(counting_));
            parts = medians("solve", size, [&] { return stages(s, &set_by_threads); });
            const auto x = s.results().state(lorenz::x);
            expected.assign(x.data(), x.data() + size);
        }
        for (const bool pinned : {false, true}) {
            myriad::ensemble<lorenz> e(size);
            if (pinned) e.pin(where_);
            row whole = medians(pinned ? "solve_pinned" : "solve", size, [&] {
                set_by_threads(e);
                row r{};
                r.wall = milliseconds([&] { myriad::solve<myriad::runge_kutta_4>(where_, e, integration(counting_)); });
                return r;
            });
            if (std::memcmp(expected.data(), e.state(lorenz::x).data(), expected.size() * sizeof(double)) != 0) {
                right_ = false;
                out_.write("# WRONG: " + whole.name + " and the solver object differ at " + std::to_string(size) +
                           " instances");
            }
            whole.upload = parts.upload;
            whole.kernel = parts.kernel;
            whole.download = parts.download;
            whole.set = NAN;
            whole.ratio = whole.wall / std::max(parts.kernel, parts.upload + parts.download);
            out_.write(whole);
        }
    }

    void small(std::int64_t size) {
        const auto write = [&](row r) {
            r.ratio = r.wall / r.kernel;
            out_.write(r);
        };
        solver s(where_, size, integration(counting_));
        write(medians("small_solver", size, [&] {
            set_by_maps(s.instances());
            row r{};
            r.wall = milliseconds([&] {
                s.upload();
                s.integrate();
                s.download();
                s.wait();
            });
            r.kernel = 1e3 * s.report().seconds;
            return r;
        }));
        myriad::ensemble<lorenz> e(size);
        write(medians("small_solve", size, [&] {
            set_by_maps(e);
            row r{};
            r.wall = milliseconds([&] {
                r.kernel = 1e3 * myriad::solve<myriad::runge_kutta_4>(where_, e, integration(counting_)).kernel_seconds;
            });
            return r;
        }));
        if (where_.which() == myriad::device::kind::cpu || counting_ == myriad::counting::on) return;
        lorenz_by_hand kernel(where_.number(), size, eight_thirds::b);
        Eigen::Map<Eigen::ArrayXd>(kernel.parameter(), size) = Eigen::ArrayXd::LinSpaced(size, 0, largest_rho);
        kernel.choose_block(steps, h);
        write(medians("small_by_hand", size, [&] {
            std::fill_n(kernel.state(), 3 * size, start);
            const auto [alone, all] = kernel.run(steps, h);
            row r{};
            r.kernel = alone;
            r.wall = all;
            return r;
        }));
    }

    const settings& chosen_;
    myriad::device where_;
    table& out_;
    myriad::counting counting_ = myriad::counting::off;
    bool right_ = true;
};

int run(const settings& chosen) {
    const myriad::device where = myriad::device::parse(chosen.device);
    table out(chosen.output);
    out.write(
        "# Myriad on a GPU, end to end: 1000 classic Runge-Kutta steps of Lorenz' equations, "
        "milliseconds, medians of " +
        std::to_string(chosen.repetitions) + " after a warm-up");
    if (where.which() == myriad::device::kind::cuda) {
        for (const std::string& line : gpu_ensembles::describe_gpu(where.number())) out.write("# " + line);
    } else {
        out.write("# CPU TIMES, of no use but to try the program: " + where.name());
    }
    out.write("# flags: " END_TO_END_FLAGS);
    out.write("# commit: " + chosen.commit);
    out.write(
        "# set_up_maps, set_up_threads: a solver object, memory pinned before; restart and values "
        "set through maps or by a loop of several threads, upload with the check of inputs, "
        "download; wall_ms: set + upload + download; ratio: wall / kernel");
    out.write(
        "# solve: wall_ms is the call of solve on ordinary memory, solve_pinned on that of an "
        "ensemble pinned before; upload, kernel and download those of a solver object; ratio: wall / "
        "max(kernel, upload + download)");
    out.write(
        "# small_solver, small_solve, small_by_hand: wall_ms from before the upload to after the "
        "download; ratio: wall / kernel");
    out.write("case,counting,instances,set_ms,upload_ms,kernel_ms,download_ms,wall_ms,ratio");
    benchmark all(chosen, where, out);
    all.run();
    return all.right() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    settings chosen;
    CLI::App app("The cost of an ensemble on a GPU besides its kernel");
    app.add_option("--device", chosen.device, "Where to compute: auto, cpu, cpu:THREADS, cuda or cuda:NUMBER")
        ->capture_default_str();
    app.add_option("--instances-scale", chosen.instances_scale, "Factor to the large numbers of instances")
        ->check(CLI::Range(1e-6, 1e2))
        ->capture_default_str();
    app.add_option("--repetitions", chosen.repetitions, "Times that each is timed")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--commit", chosen.commit, "The commit, for the header");
    app.add_option("--output", chosen.output, "File to write the same lines to");
    try {
        app.parse(argc, argv);
        return run(chosen);
    } catch (const CLI::ParseError& e) {
        return examples::after_output(app.exit(e) == 0 ? 0 : 2);
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
    }
    return 2;
}
