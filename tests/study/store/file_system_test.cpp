// SPDX-License-Identifier: MIT
// Files that appear whole or not at all, folders, and messages. That every call may fail is in store_test.cpp.
#include "myriad/study/store/file_system.hpp"

#include <algorithm>
#include <cerrno>
#include <map>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "myriad/study/store/array_file.hpp"
#include "tests/catch.hpp"
#include "tests/study/store/synthetic.hpp"

namespace {

using Catch::Matchers::Contains;
using namespace myriad::studies;

file_system& disk() { return file_system::real(); }

TEST_CASE("a new file has its name when it is whole, and is gone if it never is") {
    tests::temporary_folder folder;
    {
        new_file half(disk(), folder / "half");
        half.write("text");
        CHECK(tests::text_of(folder / "half") == "text");
    }
    CHECK_FALSE(std::filesystem::exists(folder / "half"));

    std::ofstream(folder / "old") << "old";
    new_file whole(disk(), folder / "new");
    whole.write("new");
    whole.finish();
    CHECK_FALSE(whole.link_to(folder / "old"));
    CHECK(tests::text_of(folder / "old") == "old");
    CHECK(whole.link_to(folder / "linked"));
    CHECK(tests::text_of(folder / "linked") == "new");
    whole.rename_to(folder / "old");
    CHECK(tests::text_of(folder / "old") == "new");
    CHECK_FALSE(std::filesystem::exists(folder / "new"));
    CHECK_THROWS_AS(new_file(disk(), folder / "old"), file_error);
}

TEST_CASE("a device without an end, a pipe whose writer is silent and a socket are read as empty files") {
    tests::temporary_folder folder;
    std::filesystem::create_symlink("/dev/zero", folder / "device");
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    const int writer = ::open((folder / "pipe").c_str(), O_RDWR);
    REQUIRE(writer >= 0);
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string place = folder / "socket";
    place.copy(address.sun_path, sizeof address.sun_path - 1);
    REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    for (const char* const name : {"device", "pipe", "socket"}) {
        CAPTURE(name);
        CHECK(read_text(disk(), folder / name) == "");
        std::byte values[8];
        CHECK(read_array_file(disk(), folder / name, {element::f64, {}}, 0, 8, values).damage == "it is too short");
    }
    ::close(socket);
    ::close(writer);
}

TEST_CASE("a path with a zero byte is refused, and nothing is written to what is before it") {
    tests::temporary_folder folder;
    const std::string path = (folder / "run") + std::string("\0b", 2);
    CHECK_THROWS_WITH(myriad::store::create_or_resume(path, tests::synthetic_layout()), Contains("after a zero byte"));
    CHECK_THROWS_WITH(myriad::store::open(path), Contains("after a zero byte"));
    CHECK_THROWS_WITH(file_place(path), Contains("after a zero byte"));
    CHECK_FALSE(std::filesystem::exists(folder / "run"));
}

TEST_CASE("texts are read as a whole, and what there is not is nothing") {
    tests::temporary_folder folder;
    for (const std::size_t size : std::vector<std::size_t>{0, 1, 65535, 65536, 65537, 200000}) {
        const std::string text(size, 'x');
        write_text(disk(), folder / "temporary", folder / "text", text);
        CHECK((read_text(disk(), folder / "text") == text));
    }
    CHECK_FALSE(read_text(disk(), folder / "none").has_value());
    CHECK_FALSE(names_in(disk(), folder / "none").has_value());
    make_folders(disk(), folder / "a/b//c/");
    make_folders(disk(), folder / "a/b/c");
    make_folder(disk(), folder / "a/b/d");
    auto names = names_in(disk(), folder / "a/b").value();
    std::sort(names.begin(), names.end());
    CHECK(names == std::vector<std::string>{"c", "d"});
}

TEST_CASE("the folders above a new one are durable, and one that cannot be read is no obstacle") {
    class watched final : public file_system {
    public:
        int open(const std::string& p, int flags) override {
            if (p == secret && (flags & O_DIRECTORY) != 0) {
                errno = EACCES;
                return -1;
            }
            const int file = file_system::open(p, flags);
            opened[file] = p;
            return file;
        }
        int fsync(int file) override {
            synced.push_back(opened[file]);
            return file_system::fsync(file);
        }
        std::map<int, std::string> opened;
        std::vector<std::string> synced;
        std::string secret;
    } files;
    tests::temporary_folder folder;
    make_folders(files, folder / "a/b/c");
    const std::string top = folder / "";
    CHECK(files.synced == std::vector<std::string>{top.substr(0, top.size() - 1), folder / "a", folder / "a/b"});
    files.synced.clear();
    make_folders(files, folder / "a/b/c");  // is there
    CHECK(files.synced.empty());
    files.secret = folder / "a";
    CHECK_NOTHROW(make_folders(files, folder / "a/d"));
    CHECK(std::filesystem::exists(folder / "a/d"));
}

TEST_CASE("the folder of a path is known without asking the disk") {
    CHECK(folder_of("a/b") == "a");
    CHECK(folder_of("a//b/") == "a");
    CHECK(folder_of("a") == ".");
    CHECK(folder_of("a/") == ".");
    CHECK(folder_of("/a") == "/");
    CHECK(folder_of("/") == "/");
    CHECK(folder_of("") == ".");
}

TEST_CASE("a file is written where a symbolic link points to, and replaces files alone") {
    tests::temporary_folder folder;
    std::filesystem::create_directories(folder / "data");
    std::filesystem::create_symlink("data/file", folder / "link");
    std::filesystem::create_symlink(folder / "link", folder / "second");
    for (int turn = 0; turn < 2; ++turn) {  // without and with the file
        CHECK(file_place(folder / "link") == folder / "data/file");
        CHECK(file_place(folder / "second") == folder / "data/file");
        CHECK(file_place(folder / "data/file") == folder / "data/file");
        std::ofstream(folder / "data/file") << "old";
    }
    std::filesystem::create_symlink("round", folder / "round");
    CHECK_THROWS_WITH(file_place(folder / "round"), Contains("Too many levels of symbolic links"));
    CHECK_THROWS_WITH(file_place("/dev/null"), Contains("/dev/null is no regular file"));
    CHECK_THROWS_WITH(file_place(folder / "data"), Contains("is a folder"));
    CHECK_THROWS_WITH(file_place(""), Contains("has no name"));
}

TEST_CASE("errors name the file, the reason and what to do") {
    const auto text = [](int code) { return std::string(file_error("writing", "run/x/c.1", code).what()); };
    CHECK(text(ENOSPC) ==
          "writing run/x/c.1 failed: No space left on device. What was finished is kept: free space, or "
          "move the folder to a larger disk, and start again");
    CHECK_THAT(text(EDQUOT), Contains("free space"));
    CHECK_THAT(text(EACCES), Contains("give a folder that you may write to"));
    CHECK_THAT(text(ENOTSUP), Contains("hard links"));
    CHECK_THAT(text(EIO), Contains("start again when the disk works"));
    CHECK_THAT(text(ENAMETOOLONG), Contains("give a folder with a shorter path"));
    CHECK_THAT(file_error("writing", "", EIO).what(), Contains("writing a file without a name failed"));
    // Of a study nothing is said where there is none.
    for (const int code : {ENOSPC, EIO, ENOTDIR, ENOENT, ENAMETOOLONG, EACCES}) {
        const std::string exported = file_error("writing", "run.nc", code).of_export().what();
        INFO(exported);
        CHECK_THAT(exported, Contains("writing run.nc failed: ") && !Contains("finished") && !Contains("start again") &&
                                 !Contains("move the folder"));
    }
    try {
        open_file(disk(), "/nonexistent/file", O_RDONLY);
        FAIL("a file that is not there was opened");
    } catch (const file_error& failure) {
        CHECK(failure.code() == ENOENT);
    }
}

}  // namespace
