#include "host/core/text_input.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

std::string times(int count, const std::string& text) {
    std::string result;
    for (int i = 0; i < count; ++i) result += text;
    return result;
}

}  // namespace

// Characters of one to four bytes in UTF-8.
TEST_CASE("quoted text is cut between characters, after forty", "[text]") {
    for (const std::string character : {"a", "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x94\xa6"}) {
        CAPTURE(character);
        CHECK(printable(times(40, character)) == times(40, character));
        CHECK(printable(times(41, character)) == times(40, character) + "...");
        CHECK(printable("a" + times(60, character)) == "a" + times(39, character) + "...");
    }
}

// The Unicode standard, table 3-7, says which bytes are well formed.
TEST_CASE("what cannot be shown on one line is replaced", "[text]") {
    CHECK(printable("a\tb\nc\x7f") == "a?b?c?");
    CHECK(printable("\x1b[31mred") == "?[31mred");
    CHECK(printable("\xc2\x9b") == "??");            // a control character of two bytes
    CHECK(printable("caf\xe9") == "caf?");           // Latin-1
    CHECK(printable("\xe2\x82") == "??");            // cut
    CHECK(printable("\xc0\xaf") == "??");            // longer than it need be
    CHECK(printable("\xe0\x80\xaf") == "???");       // the same of three bytes
    CHECK(printable("\xed\xa0\x80") == "???");       // a surrogate
    CHECK(printable("\xf4\x90\x80\x80") == "????");  // beyond the last character
    CHECK(printable("\xf4\x8f\xbf\xbf") == "\xf4\x8f\xbf\xbf");
}

TEST_CASE("an error quotes whole characters of a scene and of a table", "[text]") {
    const TemporaryFolder folder;
    const std::string key = "a" + times(50, "\xc3\xa4"), shown = "a" + times(39, "\xc3\xa4") + "...";
    put_file(folder.file("s.json"), "{\"format\": \"stokes-scene\", \"version\": 1, \"" + key + "\": 1}");
    const Outcome scene = run_stokes("render " + folder.file("s.json") + " --png " + folder.file("x.png"));
    CHECK(scene.code == 2);
    CHECK_THAT(scene.err, Contains("unknown key \"" + shown + "\""));
    put_file(folder.file("t.csv"), "lambda_nm,x\n400,1\n410," + key + "\n");
    const Outcome table = run_stokes("probe --sigma-s 1 --sigma-a " + folder.file("t.csv"));
    CHECK(table.code == 2);
    CHECK_THAT(table.err, Contains("\"" + shown + "\""));
}

TEST_CASE("an error stays on one line whatever a file is called", "[text]") {
    const Outcome outcome = run_stokes("render 'no\nsuch\x1b.json' --png x.png");
    CHECK(outcome.code == 2);
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    CHECK_THAT(outcome.err, Contains("no?such?.json: cannot read"));
}
