// SPDX-License-Identifier: MIT
// The list of methods of MYRIAD_INSTANTIATE may be long. Its backend here only counts.
#include <myriad/instantiate.hpp>

#include "tests/catch.hpp"

namespace counted {

template <class Method>
constexpr bool instantiated = false;
template <int number>
struct method : myriad::cash_karp {};
struct model {};

}  // namespace counted

#undef MYRIAD_BACKEND_INSTANTIATE
#define MYRIAD_BACKEND_INSTANTIATE(Model, Method, R) \
    template <>                                      \
    constexpr bool counted::instantiated<Method> = true;
#define FIVE(n) \
    counted::method<n>, counted::method<n + 1>, counted::method<n + 2>, counted::method<n + 3>, counted::method<n + 4>
#define TWENTY(n) FIVE(n), FIVE(n + 5), FIVE(n + 10), FIVE(n + 15)

MYRIAD_INSTANTIATE(counted::model, TWENTY(0), TWENTY(20))

TEST_CASE("forty methods are instantiated by one line") {
    STATIC_REQUIRE(counted::instantiated<counted::method<0>>);
    STATIC_REQUIRE(counted::instantiated<counted::method<14>>);
    STATIC_REQUIRE(counted::instantiated<counted::method<39>>);
    STATIC_REQUIRE(!counted::instantiated<counted::method<40>>);
}
