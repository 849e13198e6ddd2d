// SPDX-License-Identifier: MIT
// Names in a model's file belong to the user: equal names in the library's internals change nothing.
#include "tests/kernel/model/own_names.hpp"

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/support/device.hpp"

namespace {

template <class Model, class Method>
myriad::ensemble<Model> solved() {
    myriad::ensemble<Model> e(37);
    e.state(Model::x) = Eigen::ArrayXd::LinSpaced(37, 0.5, 2.0);
    e.state(Model::v) = 0.0;
    e.parameter(Model::stiffness) = 2.0;
    e.accessory(Model::largest) = 0.0;
    e.time_domain(0, 10);
    myriad::solve<Method>(tests::test_device(), e, {.step = 0.01});
    return e;
}

template <class Method>
void check_same() {
    const auto plain = solved<plainly_named, Method>();
    const auto strange = solved<strangely_named, Method>();
    for (const auto c : {plainly_named::x, plainly_named::v}) CHECK((plain.state(c) == strange.state(c)).all());
    CHECK((plain.accessory(plainly_named::largest) == strange.accessory(plainly_named::largest)).all());
    CHECK((plain.accepted_steps() == strange.accepted_steps()).all());
    CHECK(plain.state(plainly_named::x).isFinite().all());
}

}  // namespace

TEST_CASE("a model's file may have functions with the names of the library's internals") {
    check_same<myriad::runge_kutta_4>();
    check_same<myriad::dense<myriad::dormand_prince_5>>();
    check_same<myriad::rodas_5p>();
}
