// SPDX-License-Identifier: MIT
// Progress as text: what it says, and when.
#include <limits>
#include <sstream>
#include <string>

#include <myriad/host/report/progress.hpp>

#include "tests/catch.hpp"

namespace {

using namespace myriad;
using namespace std::chrono_literals;

std::string text_of(const work_progress& p) {
    std::ostringstream text;
    text << p;
    return text.str();
}
std::size_t index(status s) { return static_cast<std::size_t>(s); }

}  // namespace

TEST_CASE("Progress counts finished instances, their rate, the time left and failures", "[progress]") {
    work_progress p{.done = 17'152, .total = 46'080, .earlier = 5'152, .seconds = 10};
    CHECK(p.rate() == 1200);
    CHECK(p.seconds_left() == Approx(28'928 / 1200.0));
    CHECK(text_of(p) == "37 %, 17 152 of 46 080 instances, 1 200/s, 24 s left");
    p.by_status[index(status::success)] = 11'990;
    p.by_status[index(status::max_steps)] = 8;
    p.by_status[index(status::not_finite)] = 2;
    CHECK(p.failed() == 10);
    CHECK(text_of(p) == "37 %, 17 152 of 46 080 instances, 1 200/s, 24 s left, 10 failed (max_steps 8, not_finite 2)");
    CHECK(text_of({.done = 0, .total = 10}) == "0 %, 0 of 10 instances");
    CHECK(text_of({.done = 1, .total = 100'000, .seconds = 8}) ==
          "0 %, 1 of 100 000 instances, 0.13/s, 222 h 13 min left");
    CHECK(text_of({.done = 10, .total = 10, .seconds = 2}) == "100 %, 10 of 10 instances, 5/s");
}
TEST_CASE("Progress goes to one line on a terminal, which is removed", "[progress]") {
    std::ostringstream out;
    {
        progress_line line(out, progress_style::line, 0ms);
        line({.done = 1, .total = 4});
        line({.done = 2, .total = 4});
    }
    CHECK(out.str() == "\r\033[K25 %, 1 of 4 instances\r\033[K50 %, 2 of 4 instances\r\033[K");
}
TEST_CASE("Progress goes to plain lines elsewhere, not too often", "[progress]") {
    std::ostringstream often, rarely;
    progress_line all(often, progress_style::lines, 0ms), few(rarely, progress_style::lines, 1h);
    for (int i = 0; i <= 3; ++i) {
        all({.done = i, .total = 3});
        few(i, 3);
    }
    CHECK(often.str() == "0 %, 0 of 3 instances\n33 %, 1 of 3 instances\n66 %, 2 of 3 instances\n");
    CHECK(rarely.str().empty());
}
TEST_CASE("Progress of solve is told by the same line", "[progress]") {
    std::ostringstream out;
    progress_line line(out, progress_style::lines, 0ms);
    line(1, 2);
    CHECK(out.str().substr(0, 22) == "50 %, 1 of 2 instances");
}
