// SPDX-License-Identifier: MIT
// The list of an ensemble's arrays: it has all of them, and what a model writes comes back.
#include "myriad/host/backend/arrays.hpp"

#include <cstddef>
#include <set>

#include "tests/catch.hpp"

using namespace myriad::detail;

namespace {

using pointers = instance_arrays<array_pointer, double>;

myriad::host::model_shape shape_with_all(bool writes) {
    myriad::host::model_shape shape{};
    shape.n_state = 2;
    shape.n_parameter = 3;
    shape.n_accessory = shape.n_integer_accessory = shape.n_event = 1;
    shape.writes_parameters = shape.writes_time_domain = writes;
    return shape;
}

}  // namespace

TEST_CASE("every array of an instance is in the list, once", "[arrays]") {
    pointers arrays{};
    std::set<const void*> members;
    std::size_t visits = 0;
    for_each_instance_array<double>(
        shape_with_all(false),
        [&](const array_properties& of, auto, auto& pointer) {
            members.insert(&pointer);
            ++visits;
            CHECK(of.components > 0);
        },
        arrays);
    CHECK(members.size() == sizeof(pointers) / sizeof(void*));  // it has nothing but pointers
    CHECK(visits == members.size());
}

TEST_CASE("parameters and time domains come back from a kernel only if the model writes them", "[arrays]") {
    const bool writes = GENERATE(false, true);
    pointers arrays{};
    const auto check = [&](const array_properties& of, auto, auto& pointer) {
        const void* const member = &pointer;
        const bool is_input = member == &arrays.parameter || member == &arrays.t_begin || member == &arrays.t_end;
        if (is_input) CHECK(of.access == (writes ? array_access::update : array_access::read));
        if (member == &arrays.tolerance_scale) CHECK(of.access == array_access::read);
        if (member == &arrays.state) CHECK(of.access == array_access::update);
    };
    for_each_instance_array<double>(shape_with_all(writes), check, arrays);
}
