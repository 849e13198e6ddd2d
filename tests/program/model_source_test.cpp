// SPDX-License-Identifier: MIT
// Headers of models as one text: what is put in its place, and what the text stands for.
#include "program/model_source.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/stat.h>

#include "tests/catch.hpp"

using namespace myriad::programs;
using Catch::Matchers::Contains;

namespace {

struct folder {
    std::filesystem::path path;
    folder() {
        std::string name = (std::filesystem::temp_directory_path() / "myriad_source_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        path = name;
    }
    folder(const folder&) = delete;
    folder& operator=(const folder&) = delete;
    ~folder() { std::filesystem::remove_all(path); }
    void write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path / name).parent_path());
        std::ofstream(path / name) << text;
    }
    model_source read(const std::string& name) const { return read_model_source((path / name).string()); }
};

}  // namespace

TEST_CASE("headers in quotes are put in their place, and lines say from where") {
    const folder here;
    here.write("model.hpp",
               "#pragma once\n#include <myriad/model.hpp>\n  #  include \"parts/rates.hpp\"  // rates\n"
               "#include \"parts/rates.hpp\"\n#include \"absent.hpp\"\nstruct m {};");
    here.write("parts/rates.hpp", "#pragma once\n#include \"more.hpp\"\nconst int rates = 1;\n");
    here.write("parts/more.hpp", "const int more = 2;\n");
    const model_source source = here.read("model.hpp");
    CHECK(source.name == "model.hpp");
    CHECK(source.text ==
          "#line 1 \"model.hpp\"\n"
          "\n"
          "#include <myriad/model.hpp>\n"
          "#line 1 \"parts/rates.hpp\"\n"
          "\n"
          "#line 1 \"parts/more.hpp\"\n"
          "const int more = 2;\n"
          "#line 3 \"parts/rates.hpp\"\n"
          "const int rates = 1;\n"
          "#line 4 \"model.hpp\"\n"
          "#line 5 \"model.hpp\"\n"
          "#include \"absent.hpp\"\n"
          "struct m {};\n");
}

TEST_CASE("a header without #pragma once is there each time it is included, and not without end") {
    const folder here;
    here.write("model.hpp", "#include \"list.inc\"\n#include \"list.inc\"\n");
    here.write("list.inc", "x,\n");
    const std::string text = here.read("model.hpp").text;
    const std::size_t first = text.find("x,\n");
    REQUIRE(first != std::string::npos);
    CHECK(text.find("x,\n", first + 1) != std::string::npos);
    here.write("list.inc", "#include \"list.inc\"\n");
    CHECK_THROWS_WITH(here.read("model.hpp"), Contains("list.inc includes itself: put #pragma once at its beginning"));
}

TEST_CASE("what stands for a source changes with its text alone, not with its place") {
    const folder one, other;
    for (const folder* const f : {&one, &other}) {
        f->write("a/model.hpp", "#pragma once\n#include \"../b/rates.hpp\"\nstruct m {};\n");
        f->write("b/rates.hpp", "const int rates = 1;\n");
    }
    const std::string digest = one.read("a/model.hpp").digest();
    CHECK(digest.size() == 16);
    CHECK(digest == other.read("a/model.hpp").digest());
    other.write("b/rates.hpp", "const int rates = 2;\n");
    CHECK(digest != other.read("a/model.hpp").digest());
    // The text itself, kept in one file, is the same source.
    one.write("joined/model.hpp", one.read("a/model.hpp").text);
    CHECK(digest == one.read("joined/model.hpp").digest());
}

TEST_CASE("a header that cannot be read is refused") {
    const folder here;
    CHECK_THROWS_WITH(here.read("none.hpp"),
                      Contains("none.hpp cannot be read (No such file or directory): give the path of a file"));
    here.write("folder.hpp/x", "");
    CHECK_THROWS_WITH(here.read("folder.hpp"), Contains("is no regular file"));
}

TEST_CASE("a pipe, a device or a folder that is named as a header is refused, and nobody waits") {
    const folder here;
    REQUIRE(mkfifo((here.path / "pipe.hpp").c_str(), 0600) == 0);
    std::filesystem::create_directory(here.path / "folder.hpp");
    here.write("includes.hpp", "#include \"pipe.hpp\"\n");
    for (const char* name : {"pipe.hpp", "folder.hpp", "/dev/zero", "includes.hpp"})
        CHECK_THROWS_WITH(here.read(name), Contains("is no regular file: give the path of a file"));
}

TEST_CASE("the structs of a header are those it defines, not parameters of templates, declarations or comments") {
    const model_source source{"model.hpp",
                              "template <class R, class S> struct vec;\n"
                              "// a struct of a class: the class that moves\n"
                              "struct duffing {\n    template <class R>\n    static R rhs(R);\n};\n"
                              "class pendulum final : base {};\nstruct forced : duffing {};\n"
                              "template <template <class> class T> using other = duffing;\n"
                              "using outer::name;\nstruct outer::inner;\n"};
    const std::vector<std::string> names = source.structs();
    CHECK(std::set<std::string>(names.begin(), names.end()) ==
          std::set<std::string>{"duffing", "pendulum", "forced", "other"});
}
