// SPDX-License-Identifier: MIT
// Exported files, read back by netCDF's C library, as text, and as the bytes that NumPy expects. What other programs
// make of them is in check_exports.py.
#include "myriad/study/export/export.hpp"

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <sstream>

#include <netcdf.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include "myriad/host/core/error.hpp"
#include "tests/catch.hpp"
#include "tests/study/store/synthetic.hpp"

namespace {

using Catch::Matchers::Contains;
using namespace myriad::studies;
using myriad::store;

// A netCDF file that is read.
class reader {
public:
    explicit reader(const std::string& path) { REQUIRE(nc_open(path.c_str(), NC_NOWRITE, &file_) == NC_NOERR); }
    reader(const reader&) = delete;
    reader& operator=(const reader&) = delete;
    ~reader() { nc_close(file_); }

    std::vector<std::string> dimensions(const std::string& name) const {
        int ids[NC_MAX_VAR_DIMS], count = 0;
        nc_inq_varndims(file_, id(name), &count);
        nc_inq_vardimid(file_, id(name), ids);
        std::vector<std::string> names;
        for (int d = 0; d < count; ++d) {
            char text[NC_MAX_NAME + 1];
            nc_inq_dimname(file_, ids[d], text);
            names.emplace_back(text);
        }
        return names;
    }
    nc_type type(const std::string& name) const {
        nc_type t = 0;
        nc_inq_vartype(file_, id(name), &t);
        return t;
    }
    template <class T>
    std::vector<T> values(const std::string& name) const {
        int ids[NC_MAX_VAR_DIMS], count = 0;
        nc_inq_varndims(file_, id(name), &count);
        nc_inq_vardimid(file_, id(name), ids);
        std::size_t size = 1;
        for (int d = 0; d < count; ++d) {
            std::size_t length = 0;
            nc_inq_dimlen(file_, ids[d], &length);
            size *= length;
        }
        std::vector<T> read(size);
        REQUIRE(nc_get_var(file_, id(name), read.data()) == NC_NOERR);
        return read;
    }
    // Of a variable, or of the file for an empty name. Empty if there is none.
    std::string text(const std::string& name, const std::string& attribute) const {
        const int variable = name.empty() ? NC_GLOBAL : id(name);
        std::size_t length = 0;
        if (nc_inq_attlen(file_, variable, attribute.c_str(), &length) != NC_NOERR) return "";
        std::string read(length, ' ');
        nc_get_att_text(file_, variable, attribute.c_str(), read.data());
        return read;
    }
    double number(const std::string& name, const std::string& attribute) const {
        double read = 0;
        REQUIRE(nc_get_att_double(file_, name.empty() ? NC_GLOBAL : id(name), attribute.c_str(), &read) == NC_NOERR);
        return read;
    }
    bool has(const std::string& name) const {
        int found = 0;
        return nc_inq_varid(file_, name.c_str(), &found) == NC_NOERR;
    }
    bool has_fill(const std::string& name) const {
        std::size_t length = 0;
        return nc_inq_attlen(file_, id(name), "_FillValue", &length) == NC_NOERR;
    }
    nc_type attribute_type(const std::string& name, const std::string& attribute) const {
        nc_type t = 0;
        nc_inq_atttype(file_, id(name), attribute.c_str(), &t);
        return t;
    }

private:
    int id(const std::string& name) const {
        int found = -1;
        REQUIRE(nc_inq_varid(file_, name.c_str(), &found) == NC_NOERR);
        return found;
    }
    int file_ = -1;
};

using names = std::vector<std::string>;

TEST_CASE("a netCDF file has the grid's dimensions, coordinates, values and attributes") {
    const std::int64_t chunk = GENERATE(1, 4, 5, 7, 35);  // rows of the grid have five places
    CAPTURE(chunk);
    tests::temporary_folder folder;
    tests::run_synthetic(folder / "run", tests::synthetic_layout(7, chunk));
    const store results = store::open(folder / "run");
    myriad::export_netcdf(results, folder / "run.nc");
    const reader file(folder / "run.nc");

    CHECK(file.dimensions("x") == names{"a", "b"});
    CHECK(file.dimensions("y") == names{"a", "b", "phase"});
    CHECK(file.dimensions("step") == names{"a", "b", "phase", "side"});
    CHECK(file.dimensions("total") == names{"bin"});
    CHECK(file.dimensions("a") == names{"a"});
    CHECK(file.dimensions("t_end").empty());
    CHECK_FALSE(file.has("partial"));
    CHECK(file.type("x") == NC_DOUBLE);
    CHECK(file.type("y") == NC_FLOAT);
    CHECK(file.type("count") == NC_INT64);
    CHECK(file.type("step") == NC_INT);
    CHECK(file.type("status") == NC_UBYTE);

    CHECK(file.values<double>("x") == results.read<double>("x", 0, 35));
    CHECK(file.values<float>("y") == results.read<float>("y", 0, 35));
    CHECK(file.values<std::int64_t>("count") == results.read<std::int64_t>("count", 0, 35));
    CHECK(file.values<std::int32_t>("step") == results.read<std::int32_t>("step", 0, 35));
    CHECK(file.values<std::uint8_t>("status") == results.read<std::uint8_t>("status", 0, 35));
    CHECK(file.values<double>("noise") == results.read<double>("noise", 0, 35));
    CHECK(file.values<double>("total") == results.read<double>("total", 0, 1));
    CHECK(file.values<double>("b") == std::vector<double>{1, 2, 4, 8, 16});
    CHECK(file.values<double>("t_end") == std::vector<double>{12.5});

    CHECK(file.text("x", "units") == "m");
    CHECK(file.text("a", "long_name") == "first axis");
    CHECK(file.text("status", "flag_meanings") == "ok failed");
    CHECK(file.attribute_type("status", "flag_values") == NC_UBYTE);
    CHECK(file.text("x", "coordinates") == "noise t_end");
    CHECK(file.has_fill("x"));
    CHECK_FALSE(file.has_fill("status"));
    CHECK(file.text("", "Conventions") == "CF-1.10");
    CHECK(file.text("", "model") == "synthetic");
    CHECK(file.number("", "seed") == 7);
    CHECK(file.number("", "options_relative_tolerance") == 1e-9);
    CHECK(file.text("", "devices") == "simulated device");
    CHECK(file.text("", "incomplete").empty());
    CHECK_THAT(file.text("", "description"), Contains("\"relative_tolerance\":1e-09"));
    CHECK(std::filesystem::exists(folder / "run.nc"));
    CHECK(tests::contents(folder / "").size() == tests::contents(folder / "run").size() + 1);
}

TEST_CASE("a netCDF file of a study that is not complete has fill values, and says so") {
    tests::temporary_folder folder;
    store results = store::create_or_resume(folder / "run", tests::synthetic_layout());
    tests::commit_synthetic(results, 1);
    tests::commit_synthetic(results, 8);
    myriad::export_netcdf(results, folder / "run.nc", {.deflate = 0});
    const reader file(folder / "run.nc");
    CHECK(file.text("", "incomplete") == "28 of 35 instances are not computed yet: they have _FillValue");
    const auto x = file.values<double>("x");
    const auto status = file.values<std::uint8_t>("status");
    const auto count = file.values<std::int64_t>("count");
    CHECK(file.has_fill("status"));
    CHECK(file.has_fill("count"));
    for (std::size_t i = 0; i < 35; ++i) {
        const bool done = (i >= 4 && i < 8) || i >= 32;
        const auto instance = static_cast<std::int64_t>(i);
        CHECK((done ? x[i] == tests::synthetic(instance, 1) : std::isnan(x[i])));
        CHECK(status[i] == (done ? i % 3 == 0 : 255));
        CHECK(count[i] == (done ? instance * instance : -9223372036854775806));
    }
    CHECK(std::isnan(file.values<double>("total")[0]));
}

TEST_CASE("zipped axes, coordinates along instances and a study of one instance are exported") {
    tests::temporary_folder folder;
    layout content;
    content.axes = {{"k_B", 3}, {"draw", 2}};
    content.chunk = 4;
    content.variables = {{.name = "x"}};
    content.coordinates = {with_values("k", "k_B", {1, 2, 3}), with_values("B", "k_B", {5, 6, 7}),
                           with_values("phi", "instance", {0, 1, 2, 3, 4, 5})};
    {
        store results = store::create_or_resume(folder / "zip", content);
        const std::vector<double> x{0, 1, 2, 3, 4, 5};
        results.commit(0, std::vector{column_of("x", std::span(x).first(4))}, {});
        results.commit(1, std::vector{column_of("x", std::span(x).subspan(4))}, {});
        myriad::export_netcdf(results, folder / "zip.nc");
        myriad::export_csv(results, folder / "zip.csv");
    }
    const reader file(folder / "zip.nc");
    CHECK(file.dimensions("k") == names{"k_B"});
    CHECK(file.dimensions("phi") == names{"k_B", "draw"});
    CHECK(file.values<double>("phi") == std::vector<double>{0, 1, 2, 3, 4, 5});
    CHECK(file.text("x", "coordinates") == "B k phi");
    CHECK(tests::text_of(folder / "zip.csv") == "k,B,draw,x\n1,5,0,0\n1,5,1,1\n2,6,0,2\n2,6,1,3\n3,7,0,4\n3,7,1,5\n");

    layout one;
    one.chunk = 1;
    one.variables = {{.name = "x"}};
    store results = store::create_or_resume(folder / "one", one);
    const std::vector<double> x{0.5};
    results.commit(0, std::vector{column_of("x", x)}, {});
    myriad::export_netcdf(results, folder / "one.nc");
    CHECK(reader(folder / "one.nc").values<double>("x") == x);
    myriad::export_csv(results, folder / "one.csv");
    CHECK(tests::text_of(folder / "one.csv") == "x\n0.5\n");
    myriad::export_npy(results, "x", folder / "one.npy");
    CHECK(tests::text_of(folder / "one.npy").size() == 128 + 8);
}

TEST_CASE("text has a line for each instance, with numbers that read back as they were") {
    tests::temporary_folder folder;
    store results = store::create_or_resume(folder / "run", tests::synthetic_layout());
    for (int i = 1; i < 9; ++i) tests::commit_synthetic(results, i);
    myriad::export_csv(results, folder / "run.csv");
    std::istringstream lines(tests::text_of(folder / "run.csv"));
    std::string line;
    std::getline(lines, line);
    CHECK(line ==
          "a,b,noise,x,y[0],y[1],y[2],count,step[0][0],step[0][1],step[1][0],step[1][1],step[2][0],step[2][1],"
          "status");
    for (std::int64_t i = 0; std::getline(lines, line); ++i) {
        std::istringstream values(line);
        std::vector<std::string> cells;
        for (std::string cell; std::getline(values, cell, ',');) cells.push_back(cell);
        REQUIRE(cells.size() == 15);
        CHECK(std::stod(cells[0]) == 0.1 * static_cast<double>(i / 5));
        CHECK(std::stod(cells[1]) == std::exp2(static_cast<double>(i % 5)));
        if (i < 4) {
            CHECK(cells[3] == "nan");
            CHECK(cells[14] == "nan");
            continue;
        }
        CHECK(std::stod(cells[2]) == tests::synthetic(i, 99));
        CHECK(std::stod(cells[3]) == tests::synthetic(i, 1));
        CHECK(std::stof(cells[6]) == static_cast<float>(tests::synthetic(i, 4)));
        CHECK(cells[7] == std::to_string(i * i));
        CHECK(cells[13] == std::to_string(10 * i + 5));
        CHECK(cells[14] == (i % 3 == 0 ? "failed" : "ok"));
    }
}

TEST_CASE("text says in words how instances ended") {
    tests::temporary_folder folder;
    layout content = tests::synthetic_layout();
    const std::string words = "not_started success";
    for (variable& v : content.variables)
        for (attribute& a : v.attributes)
            if (a.name == "flag_meanings") a.value = words;
    store results = store::create_or_resume(folder / "run", content);
    for (int i = 1; i < 9; ++i) tests::commit_synthetic(results, i);
    myriad::export_csv(results, folder / "run.csv");
    const std::string text = tests::text_of(folder / "run.csv");
    CHECK_THAT(text, Contains("nan,not_started\n"));  // of chunk 0, which is not done
    CHECK_THAT(text, Contains(",success\n"));
    CHECK_THAT(text, !Contains(",1\n") && !Contains(",255\n"));
}

TEST_CASE("an array for NumPy has its header and its values") {
    tests::temporary_folder folder;
    tests::run_synthetic(folder / "run", tests::synthetic_layout());
    const store results = store::open(folder / "run");
    myriad::export_npy(results, "step", folder / "step.npy");
    const std::string text = tests::text_of(folder / "step.npy");
    CHECK(text.substr(0, 8) == std::string("\x93NUMPY\x01\x00", 8));
    CHECK_THAT(text, Contains("{'descr': '<i4', 'fortran_order': False, 'shape': (7, 5, 3, 2, ), }"));
    const auto step = results.read<std::int32_t>("step", 0, 35);
    const std::size_t begin = text.size() - step.size() * sizeof(std::int32_t);
    CHECK(begin % 64 == 0);
    CHECK(text.substr(begin) == std::string(reinterpret_cast<const char*>(step.data()), step.size() * 4));
    CHECK(text[begin - 1] == '\n');
    CHECK_THROWS_WITH(myriad::export_npy(results, "z", folder / "z.npy"), Contains("there is no variable z"));
}

TEST_CASE("an export that fails says so and leaves nothing, and the file that was there before stays") {
    tests::temporary_folder folder;
    tests::run_synthetic(folder / "run", tests::synthetic_layout());
    const store results = store::open(folder / "run");
    for (const char* const name : {"run.nc", "run.csv", "run.npy"}) std::ofstream(folder / name) << "old";
    std::filesystem::resize_file(folder / "run/x/c.8", 5);
    CHECK_THROWS_WITH(myriad::export_netcdf(results, folder / "run.nc"), Contains("/x/c.8 is damaged"));
    CHECK_THROWS_WITH(myriad::export_csv(results, folder / "run.csv"), Contains("/x/c.8 is damaged"));
    CHECK_THROWS_WITH(myriad::export_npy(results, "x", folder / "run.npy"), Contains("/x/c.8 is damaged"));
    CHECK_THROWS_WITH(myriad::export_netcdf(results, folder / "none/run.nc"), Contains("No such file or directory"));
    CHECK_THROWS_WITH(myriad::export_csv(results, folder / "none/run.csv"), Contains("No such file or directory"));
    CHECK_THROWS_WITH(myriad::export_netcdf(results, folder / "run.nc", {.deflate = 10}), Contains("deflate is 10"));
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "")) {
        ++files;
        if (entry.is_regular_file()) CHECK(tests::text_of(entry.path()) == "old");
    }
    CHECK(files == 4);
}

TEST_CASE("a netCDF file with a backslash in its name is not written elsewhere") {
    tests::temporary_folder folder;
    tests::run_synthetic(folder / "run", tests::synthetic_layout());
    std::filesystem::create_directory(folder / "back");
    CHECK_THROWS_WITH(myriad::export_netcdf(store::open(folder / "run"), folder / "back\\slash.nc"),
                      Contains("has a backslash, which netCDF takes for a slash: give another path"));
    CHECK(std::filesystem::is_empty(folder / "back"));
}

TEST_CASE("an export replaces what a symbolic link points to, and no device") {
    tests::temporary_folder folder;
    tests::run_synthetic(folder / "run", tests::synthetic_layout());
    const store results = store::open(folder / "run");
    const auto write_all = [&](const std::string& path, auto check) {
        check([&] { myriad::export_netcdf(results, path); });
        check([&] { myriad::export_csv(results, path); });
        check([&] { myriad::export_npy(results, "x", path); });
    };
    std::ofstream(folder / "file") << "old";
    std::filesystem::create_symlink("file", folder / "link");
    std::filesystem::create_symlink("/dev/null", folder / "device");
    write_all(folder / "link", [&](auto write) {
        write();
        CHECK(std::filesystem::is_symlink(folder / "link"));
        CHECK(std::filesystem::file_size(folder / "file") > 100);
    });
    write_all(folder / "device", [&](auto write) { CHECK_THROWS_WITH(write(), Contains("is no regular file")); });
    write_all(folder / "none/run.nc", [&](auto write) {
        CHECK_THROWS_WITH(write(), Contains("No such file or directory: give a file in a folder that exists"));
    });
    CHECK(tests::contents(folder / "").size() == tests::contents(folder / "run").size() + 1);  // link and file are one
}

// In a process of its own, on a disk of `size` bytes: 0 if all went well there, including the end of the process, 77 if
// such a disk cannot be made, else what went wrong.
int export_on_small_disk(const store& results, const std::string& folder, const std::string& size) {
    const pid_t child = ::fork();
    if (child == 0) {
        const bool alone = ::unshare(CLONE_NEWNS) == 0 || ::unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0;
        if (!alone || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
            ::mount("tmpfs", folder.c_str(), "tmpfs", 0, ("size=" + size).c_str()) != 0)
            ::_exit(77);
        int wrong = 0;
        try {
            myriad::export_netcdf(results, folder + "/run.nc");
            wrong = 1;
        } catch (const myriad::error& failure) {
            if (!Contains("No space left on device").match(failure.what())) wrong = 2;
        }
        if (!std::filesystem::is_empty(folder)) wrong = 3;
        std::exit(wrong);  // HDF5 ends here too
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + status;
}

TEST_CASE("an export to a disk that gets full ends with an error, and the process in good order") {
    tests::temporary_folder folder;
    layout content;
    content.axes = {{"a", 2000000}};  // 16 MB for each variable
    content.chunk = 1000000;
    content.variables = {{.name = "x"}, {.name = "y"}};
    std::vector<double> values(1000000);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = tests::synthetic(static_cast<std::int64_t>(i), 1);
    store results = store::create_or_resume(folder / "run", content);
    for (int chunk = 0; chunk < 2; ++chunk)
        results.commit(chunk, std::vector{column_of("x", values), column_of("y", values)}, {});
    std::filesystem::create_directories(folder / "disk");
    // From one that is too small for anything to one that lacks a little at the end.
    myriad::export_netcdf(results, folder / "whole.nc");
    const auto whole = static_cast<std::int64_t>(std::filesystem::file_size(folder / "whole.nc"));
    for (const std::int64_t bytes : {std::int64_t{65536}, whole / 4, whole / 2, whole - (1 << 20), whole - 8192}) {
        const std::string size = std::to_string(bytes);
        const int status = export_on_small_disk(results, folder / "disk", size);
        if (status == 77) {
            WARN("not tested: this user may not mount a disk");
            return;
        }
        INFO(size);
        CHECK(status == 0);
    }
}

// Not a test of its own: what check_failing_disk.sh runs where a call to the disk fails, in the folder
// MYRIAD_TEST_FILES.
TEST_CASE("an export fails and the process goes on", "[.][failing]") {
    const char* const folder = std::getenv("MYRIAD_TEST_FILES");
    REQUIRE(folder != nullptr);
    const std::string place = std::string(folder) + "/out";
    std::filesystem::create_directories(place);
    std::ofstream(place + "/run.nc") << "old";
    const store results = store::open(std::string(folder) + "/run");
    std::string said = "exported";
    try {
        myriad::export_netcdf(results, place + "/run.nc");
    } catch (const myriad::error& failure) {
        said = failure.what();
        CHECK(tests::text_of(place + "/run.nc") == "old");
    }
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(place)) files += entry.is_regular_file() ? 1 : 0;
    CHECK(files == 1);
    ::unsetenv("MYRIAD_FAILING_DISK");
    myriad::export_netcdf(results, place + "/run.nc");  // the libraries are in good order
    CHECK(reader(place + "/run.nc").values<double>("x").size() == 35);
    std::cout << said << '\n';
}

// Not a test: what check_exports.py reads, in the folder MYRIAD_TEST_FILES.
TEST_CASE("files for other programs are written", "[.][files]") {
    const char* const folder = std::getenv("MYRIAD_TEST_FILES");
    REQUIRE(folder != nullptr);
    const std::string run = std::string(folder) + "/run";
    tests::run_synthetic(run, tests::synthetic_layout());
    const store results = store::open(run);
    myriad::export_netcdf(results, run + ".nc");
    myriad::export_csv(results, run + ".csv");
    myriad::export_npy(results, "y", run + ".npy");
    store part = store::create_or_resume(std::string(folder) + "/part", tests::synthetic_layout());
    tests::commit_synthetic(part, 2);
    myriad::export_netcdf(part, std::string(folder) + "/part.nc");
}

}  // namespace
