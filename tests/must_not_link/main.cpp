// SPDX-License-Identifier: MIT
// A program that declares a third model with that name, with MYRIAD_TEST_STATES states.
#include <iostream>

#include <myriad/myriad.hpp>

struct oscillator {
    enum state { x, v, n_state = MYRIAD_TEST_STATES };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return y;
    }
};

int main() try {
    myriad::ensemble<oscillator> e(3);
    for (int c = 0; c < MYRIAD_TEST_STATES; ++c) e.state(c) = 1.0;
    e.time_domain(0, 1);
    std::cout << myriad::solve<myriad::runge_kutta_4>(myriad::device::cpu(1), e, {.step = 0.1});
    return 0;
} catch (const myriad::error& error) {
    std::cout << error.what() << '\n';
    return 3;
}
