// SPDX-License-Identifier: MIT
// Stores and exports where a process may have few files open.
#include <cerrno>
#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "myriad/study/export/export.hpp"
#include "myriad/study/export/own_process.hpp"
#include "myriad/study/store/file_system.hpp"
#include "myriad/study/store/store.hpp"
#include "tests/catch.hpp"
#include "tests/study/store/synthetic.hpp"

namespace {

using Catch::Matchers::Contains;
using namespace myriad::studies;

// What goes wrong in a process with this limit.
std::string with_limit(rlim_t files, const std::function<void()>& work) {
    try {
        in_own_process(
            [&](const data_source&) {
                const rlimit limit{files, files};
                ::setrlimit(RLIMIT_NOFILE, &limit);
                work();
            },
            [](auto&&...) {});
    } catch (const process_error& failure) {
        return failure.what();
    }
    return "";
}

TEST_CASE("a study of 200 variables is stored by four threads and exported with 64 open files") {
    tests::temporary_folder folder;
    layout content;
    content.axes = {{"a", 8}};
    content.chunk = 1;
    for (int v = 0; v < 200; ++v) content.variables.push_back({.name = "x" + std::to_string(v)});
    const std::vector<double> values(1, 1.5);
    std::vector<column> columns;
    for (const variable& v : content.variables) columns.push_back(column_of(v.name, values));
    const std::string failure = with_limit(64, [&] {
        auto store = myriad::store::create_or_resume(folder / "run", content);
        std::vector<std::thread> threads;
        std::string wrong;
        for (int t = 0; t < 4; ++t)
            threads.emplace_back([&] {
                try {
                    while (const auto chunk = store.claim_next()) store.commit(*chunk, columns, {});
                } catch (const myriad::error& e) {
                    wrong = e.what();
                }
            });
        for (std::thread& t : threads) t.join();
        if (!wrong.empty()) throw myriad::error(wrong);
        myriad::export_netcdf(store, folder / "run.nc");
        myriad::export_csv(store, folder / "run.csv");
    });
    CHECK(failure.empty());
    CHECK(myriad::store::open(folder / "run").complete());
}
#if !defined(__SANITIZE_ADDRESS__)  // which ends a process that cannot open a file of its own
TEST_CASE("where no file can be opened any more, the message names the limit and how to raise it") {
    tests::temporary_folder folder;
    const std::string failure = with_limit(20, [&] {
        while (::open("/dev/null", O_RDONLY) >= 0) {
        }
        if (errno == EMFILE) open_file(file_system::real(), folder / "file", O_WRONLY | O_CREAT);
    });
    CHECK_THAT(failure,
               Contains("this process has all 20 files open that it may have: raise the limit (`ulimit -n 4096`)"));
    CHECK_THAT(file_error("opening", "x", EMFILE).of_export().what(),
               Contains("ulimit -n") && Contains("export again"));
    CHECK_THAT(file_error("opening", "x", ENFILE).what(), Contains("fs.file-max"));
}
#endif

}  // namespace
