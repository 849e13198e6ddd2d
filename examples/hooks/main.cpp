// SPDX-License-Identifier: MIT
// Runs the small models of docs/hooks_and_events.md and the solvers of docs/gpu.md, and compares them with known
// results; exit status 1 if one is wrong.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <iostream>
#include <limits>
#include <numbers>

#include <myriad/myriad.hpp>

#include "models.hpp"

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
bool all_right = true;

// Written so that NaN counts as wrong.
void compare(const char* what, double value, double exact, double tolerance) {
    const bool right = std::abs(value - exact) <= tolerance;
    all_right = all_right && right;
    std::cout << (right ? "right: " : "WRONG: ") << what << ' ' << value << ", expected " << exact << " within "
              << tolerance << '\n';
}

template <class Method, class R>
void bounce(double tolerance) {
    myriad::ensemble<bouncing_ball, R> balls(10);
    balls.parameter(bouncing_ball::r).setLinSpaced(R(0.5), R(0.9));
    balls.shared(bouncing_ball::g) = R(9.81);
    balls.state(bouncing_ball::x) = R(1);
    balls.state(bouncing_ball::v) = R(0);
    balls.time_domain(0, static_cast<R>(endless));  // the hook ends the phase
    myriad::solve<Method>(myriad::device::best(), balls,
                          {.relative_tolerance = tolerance,
                           .absolute_tolerance = tolerance,
                           .events = {{.direction = myriad::direction::falling, .tolerance = tolerance}}});
    const double r = static_cast<double>(balls.parameter(bouncing_ball::r)[9]);
    const double fall = std::sqrt(2 / 9.81);
    compare("time of the fifth impact", static_cast<double>(balls.accessory(bouncing_ball::t_impact)[9]),
            fall * (1 + 2 * (r + r * r + r * r * r + r * r * r * r)), 20 * tolerance);
}

// snippet: solvers
/// The time of the fifth impact for each restitution, batch by batch: two solvers per GPU take turns.
Eigen::ArrayXd fifth_impacts(const Eigen::ArrayXd& restitution, Eigen::Index batch, const myriad::options& options) {
    using solver = myriad::solver<bouncing_ball, myriad::cash_karp>;
    std::deque<solver> solvers;  // solvers can be neither copied nor moved
    for (const myriad::device& where : myriad::devices()) {
        if (where.which() == myriad::device::kind::cpu && !solvers.empty()) continue;  // the CPU if there is no GPU
        for (int i = 0; i < 2; ++i) solvers.emplace_back(where, batch, options);
    }
    const auto turns = static_cast<Eigen::Index>(solvers.size());

    Eigen::ArrayXd t(restitution.size());
    for (Eigen::Index first = 0; first < t.size() + turns * batch; first += batch) {
        solver& next = solvers[static_cast<std::size_t>(first / batch % turns)];
        auto& balls = next.instances();  // waits for this solver; the others go on
        if (const Eigen::Index done = first - turns * batch; done >= 0) {
            const Eigen::Index n = std::min(batch, t.size() - done);
            t.segment(done, n) = balls.accessory(bouncing_ball::t_impact).head(n);
        }
        if (first >= t.size()) continue;
        const Eigen::Index n = std::min(batch, t.size() - first);
        balls.restart();  // a new batch, not further phases of the last one
        balls.parameter(bouncing_ball::r).head(n) = restitution.segment(first, n);
        balls.shared(bouncing_ball::g) = 9.81;
        balls.state(bouncing_ball::x) = 1;
        balls.state(bouncing_ball::v) = 0;
        balls.time_domain(0, endless);  // infinity: the hook ends the phase
        next.upload(n);
        next.integrate();
        next.download({.accessories = {bouncing_ball::t_impact}});
    }
    return t;
}
// end of snippet

void take_turns() {
    constexpr double tolerance = 1e-9;
    const Eigen::ArrayXd r = Eigen::ArrayXd::LinSpaced(1000, 0.5, 0.9);
    const Eigen::ArrayXd t =
        fifth_impacts(r, 150,
                      {.relative_tolerance = tolerance,
                       .absolute_tolerance = tolerance,
                       .events = {{.direction = myriad::direction::falling, .tolerance = tolerance}}});
    const Eigen::ArrayXd exact = std::sqrt(2 / 9.81) * (1 + 2 * (r + r.square() + r.cube() + r.square().square()));
    compare("solvers in turns differ in the time of the fifth impact by",
            (t - exact).abs().maxCoeff<Eigen::PropagateNaN>(), 0, 20 * tolerance);
}

void lyapunov() {
    myriad::ensemble<tangent_duffing> sweep(2);
    sweep.parameter(tangent_duffing::k) << 0.22, 0.24;
    sweep.shared(tangent_duffing::B) = 0.3;
    sweep.state(tangent_duffing::x) = -0.5;
    sweep.state(tangent_duffing::v) = -0.1;
    sweep.state(tangent_duffing::a) = 1;
    sweep.state(tangent_duffing::b) = 0;
    sweep.accessory(tangent_duffing::growth) = 0;
    sweep.time_domain(0, 2 * std::numbers::pi);
    const auto run = [&sweep](int phases) {
        myriad::solve<myriad::tsitouras_5>(myriad::device::best(), sweep, {.phases = phases});
    };
    run(300);
    sweep.accessory(tangent_duffing::growth) = 0;  // discards the transient
    run(1000);
    const Eigen::ArrayXd exponent = sweep.accessory(tangent_duffing::growth) / (1000 * 2 * std::numbers::pi);
    std::cout << "largest Lyapunov exponents " << exponent.transpose()
              << " for k = 0.22 (period three), 0.24 (chaos)\n";
    compare("signs differ by", (exponent > 0).cast<double>().matrix().dot(Eigen::Vector2d(-1, 1)), 1, 0);
}

void observe() {
    myriad::ensemble<damped> masses(10);
    masses.parameter(damped::zeta).setLinSpaced(0.05, 0.5);
    masses.state(damped::x) = 1;
    masses.state(damped::v) = 0;
    masses.time_domain(0, 20);
    myriad::solve<myriad::tsitouras_5>(myriad::device::best(), masses);
    const double zeta = 0.1, root = std::sqrt(1 - zeta * zeta), half_period = std::numbers::pi / root;
    compare("overshoot", masses.accessory(damped::overshoot)[1], -std::exp(-zeta * half_period), 1e-7);
    compare("time of the overshoot", masses.accessory(damped::t_overshoot)[1], half_period, 1e-6);
    const double left = (std::pow(masses.state(damped::x)[1], 2) + std::pow(masses.state(damped::v)[1], 2)) / 2;
    compare("dissipated energy", masses.accessory(damped::dissipated)[1], 0.5 - left, 1e-6);
}

template <class Method, class R>
void settle(const myriad::options& options, double tolerance) {
    myriad::ensemble<settling, R> decays(100);
    decays.parameter(settling::k).setLinSpaced(R(0.5), R(2));
    decays.shared(settling::limit) = R(0.01);
    decays.state(settling::x) = R(1);
    decays.accessory(settling::integral) = R(0);
    decays.accessory(settling::x_before) = R(0);
    decays.time_domain(0, R(1000));
    const auto report = myriad::solve<Method>(myriad::device::best(), decays, options);
    compare("decays stopped", static_cast<double>(report.count(myriad::status::stopped_by_user)), 100, 0);
    compare("integral of the first", static_cast<double>(decays.accessory(settling::integral)[0]),
            (1 - static_cast<double>(decays.state(settling::x)[0])) / 0.5, tolerance);
}

void follow() {
    myriad::ensemble<continuation> paths(3);
    paths.parameter(continuation::mu) << 0, 1, 2;
    paths.shared(continuation::increment) = 0.1;
    paths.state(continuation::x) = 0.5;
    paths.time_domain(0, 5);
    myriad::solve<myriad::tsitouras_5>(myriad::device::best(), paths, {.phases = 10});
    compare("parameter after ten phases", paths.parameter(continuation::mu)[1], 2, 1e-12);
    compare("end of the time domain", paths.t_end()[1], 15, 0);
    compare("equilibrium", paths.state(continuation::x)[1], std::cbrt(1.9), 1e-6);
}

// After many doses every interval is like the one before.
void take_doses() {
    myriad::ensemble<dosing> patients(10);
    patients.parameter(dosing::ka) = 1.2;
    patients.parameter(dosing::ke).setLinSpaced(0.1, 0.4);
    patients.parameter(dosing::dose) = 100;
    patients.parameter(dosing::interval) = 0.7;
    patients.shared_integer(dosing::doses) = 1000;
    patients.state(dosing::gut) = 0;
    patients.state(dosing::blood) = 0;
    patients.time_domain(0, 700);
    myriad::solve<myriad::tsitouras_5>(myriad::device::best(), patients, {.relative_tolerance = 1e-10});
    const double left = std::exp(-1.2 * 0.7);
    compare("content of the gut before the next dose", patients.state(dosing::gut)[0], 100 * left / (1 - left), 1e-6);
    // the sum of all doses' Bateman functions, a geometric series
    const double ke = 0.1, gone = std::exp(-ke * 0.7);
    const double before = 100 * 1.2 / (1.2 - ke) * (gone / (1 - gone) - left / (1 - left));
    compare("content of the blood before the next dose", patients.state(dosing::blood)[0], before, 1e-5);
}

// x rises to 1 + lag, and sinks.
void close_slowly() {
    myriad::ensemble<slow_valve> tanks(5);
    tanks.parameter(slow_valve::lag).setLinSpaced(0.1, 0.5);
    tanks.state(slow_valve::x) = 0;
    tanks.time_domain(0, 1.6);
    myriad::solve<myriad::tsitouras_5>(myriad::device::best(), tanks,
                                       {.events = {{.direction = myriad::direction::rising}}});
    compare("level after a valve that closed 0.5 too late", tanks.state(slow_valve::x)[4], 1.4, 1e-9);
}

// The exact solution is 2 cos t as long as the mass does not reach the stop.
void sample() {
    myriad::ensemble<stop_by_select> masses(3);
    masses.parameter(stop_by_select::gap) = 10;
    masses.shared(stop_by_select::K) = 10;
    masses.state(stop_by_select::x) = 2;
    masses.state(stop_by_select::v) = 0;
    masses.time_domain(0, 10);
    // snippet: samples
    myriad::solve<myriad::dense<myriad::tsitouras_5>>(
        myriad::device::best(), masses, {.samples = {.states = {stop_by_select::x}, .capacity = 101, .evenly = 101}});
    const auto t = masses.samples().time();  // one row per instance, one column per sample
    const auto x = masses.samples().state(stop_by_select::x);
    // end of snippet
    compare("samples differ from 2 cos t by", (x - 2 * t.cos()).abs().maxCoeff(), 0, 1e-6);
}

// Each mass swings for its own time: until a quarter of the amplitude is left.
void swing_down() {
    // snippet: inputs
    myriad::ensemble<damped> masses(100);
    masses.parameter(damped::zeta).setLinSpaced(0.05, 0.5);
    masses.state(damped::x) = 1;
    masses.state(damped::v) = 0;
    masses.t_begin() = 0;
    masses.t_end() = std::log(4.0) / masses.parameter(damped::zeta);  // every instance its own
    // end of snippet
    // snippet: call
    const auto report = myriad::solve<myriad::tsitouras_5>(myriad::device::best(), masses,
                                                           {.relative_tolerance = 1e-10,
                                                            .absolute_tolerance = 1e-10,
                                                            .record = {.states = {damped::x}, .time = true},
                                                            .progress = [](std::int64_t done, std::int64_t total) {
                                                                if (done == total)
                                                                    std::cerr << total << " instances are done\n";
                                                            }});
    // end of snippet
    // snippet: results
    if (report.failed() > 0) std::cerr << report;  // which one was first, and with what inputs
    for (Eigen::Index i = 0; i < masses.size(); i += 25)
        std::cout << "instance " << i << ": " << myriad::name_of(masses.status(i)) << " at t = " << masses.t()[i]
                  << " after " << masses.phases_done()[i] << " phase, " << masses.accepted_steps()[i] << " steps\n";
    const double mean_steps = masses.accepted_steps().cast<double>().mean();
    const auto x = report.records.state(damped::x);  // one row per instance, one column per phase
    // end of snippet
    compare("masses that reached their own t_end", static_cast<double>(report.count(myriad::status::success)), 100, 0);
    compare("end of the first", masses.t()[0], std::log(4.0) / 0.05, 1e-12);
    compare("the record is the state at the end, but for", (x.col(0) - masses.state(damped::x)).abs().maxCoeff(), 0, 0);
    compare("steps in all", mean_steps * 100, static_cast<double>(report.accepted_steps), 1e-6);
}

template <class Model>
Eigen::ArrayXd swing() {
    myriad::ensemble<Model> masses(100);
    masses.parameter(Model::gap).setLinSpaced(0.1, 0.9);
    masses.shared(Model::K) = 10;
    masses.state(Model::x) = -1;
    masses.state(Model::v) = 0;
    masses.time_domain(0, 20);
    myriad::solve<myriad::tsitouras_5>(myriad::device::best(), masses, {.relative_tolerance = 1e-10});
    return masses.state(Model::x);
}

}  // namespace

int main() {
    std::cout << myriad::describe<bouncing_ball>();
    bounce<myriad::cash_karp, double>(1e-9);
    bounce<myriad::tsitouras_5, double>(1e-9);
    bounce<myriad::tsitouras_5, float>(1e-5);
    take_turns();
    lyapunov();
    observe();
    settle<myriad::tsitouras_5, double>({.maximum_step = 0.01}, 1e-4);
    settle<myriad::runge_kutta_4, float>({.step = 0.01}, 1e-4);
    follow();
    take_doses();
    close_slowly();
    sample();
    swing_down();
    // A last bit may decide whether a step over the kink is accepted, so the results agree to its error only.
    compare("difference of select and branch", (swing<stop_by_select>() - swing<stop_by_branch>()).abs().maxCoeff(), 0,
            1e-4);
    return all_right && std::cout.flush() ? EXIT_SUCCESS : EXIT_FAILURE;
}
