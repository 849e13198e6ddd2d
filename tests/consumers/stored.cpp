// SPDX-License-Identifier: MIT
// Stores an array, exports it and reads it again, with the component study of the installed package and no model; exit
// status 1 if it is wrong.
#include <cstdio>
#include <vector>

#include <myriad/study/export/export.hpp>
#include <myriad/study/store/store.hpp>

int main() {
    myriad::studies::layout content;
    content.axes = {{"k", 100}};
    content.chunk = 60;
    content.variables = {{.name = "x"}};
    {
        myriad::store store = myriad::store::create_or_resume("values", content);
        while (const auto chunk = store.claim_next()) {
            const auto range = myriad::studies::range_of(content, *chunk);
            const std::vector<double> x(static_cast<std::size_t>(range.count), 0.5 * static_cast<double>(*chunk));
            store.commit(*chunk, std::vector{myriad::studies::column_of("x", x)}, {});
        }
    }
    const myriad::store store = myriad::store::open("values");
    myriad::export_netcdf(store, "values.nc");
    const std::vector<double> x = store.read<double>("x", 59, 2);
    std::printf("%g %g\n", x[0], x[1]);
    return store.complete() && x[0] == 0.0 && x[1] == 0.5 ? 0 : 1;
}
