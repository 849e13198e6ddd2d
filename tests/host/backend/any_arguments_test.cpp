// SPDX-License-Identifier: MIT
// A kernel's arguments are bytes that host code puts together from a model's numbers: they are where the kernel looks.
#include "myriad/host/backend/any_arguments.hpp"

#include <cstddef>

#include "examples/duffing/duffing.hpp"
#include "problems/lorenz.hpp"
#include "tests/catch.hpp"

using namespace myriad::detail;

namespace {

/// 33 events, in two words, and odd numbers of everything else.
struct odd_numbers {
    enum state { x, y, z, n_state };
    enum parameter { k, n_parameter };
    enum accessory { n_accessory = 5 };
    enum integer_accessory { n_integer_accessory = 3 };
    enum event { n_event = 33 };
};

template <class Model, class R>
void check_places() {
    const kernel_arguments<Model, R> all{};
    any_arguments<R> same{};
    same.model = &numbers_of<Model>;
    const argument_offsets<R> at = same.offsets();
    const auto place = [&](const auto& member) {
        return reinterpret_cast<const std::byte*>(&member) - reinterpret_cast<const std::byte*>(&all) -
               static_cast<std::ptrdiff_t>(sizeof(argument_head<R>));
    };
#define CHECK_PLACE(type, name, count) CHECK(place(all.name) == at.name);
    MYRIAD_ARGUMENT_ARRAYS(CHECK_PLACE)
#undef CHECK_PLACE
    CHECK(sizeof(argument_arrays<Model, R>) == static_cast<std::size_t>(at.end));
    CHECK(place(all.size) == -static_cast<std::ptrdiff_t>(sizeof(argument_head<R>)));  // the head is first
}

}  // namespace

TEMPLATE_TEST_CASE("the arrays behind the head of a kernel's arguments are where host code puts them", "[arguments]",
                   double, float) {
    check_places<duffing, TestType>();
    check_places<problems::lorenz, TestType>();
    check_places<odd_numbers, TestType>();
}
