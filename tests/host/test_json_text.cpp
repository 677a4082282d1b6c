#include <nlohmann/json.hpp>

#include "host/core/json_text.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

TEST_CASE("text for JSON is quoted so that it reads back", "[json]") {
    for (const std::string& text :
         {std::string(), std::string("plain"), std::string("a\"b\\c\n\t\x01z"), std::string("nul\0in", 6),
          std::string("\u00e9\u20ac\U0001F30D"), std::string("\u07ff\u0800\ud7ff\ue000\uffff\U00010000\U0010ffff")}) {
        CAPTURE(text);
        CHECK(nlohmann::json::parse(json_quoted(text)).get<std::string>() == text);
    }
}

// The library's own reading refuses every text here unless it was mended.
TEST_CASE("bytes that are not UTF-8 become U+FFFD", "[json]") {
    const std::string mark = "\uFFFD";
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"caf\xe9.json", "caf" + mark + ".json"},
        {"\x80", mark},
        {"\xc0\xaf", mark + mark},
        {"\xe0\x80\x80", mark + mark + mark},
        {"\xed\xa0\x80", mark + mark + mark},
        {"\xf4\x90\x80\x80", mark + mark + mark + mark},
        {"\xf8\x88", mark + mark},
        {"\xe2\x82", mark + mark},
        {"\xe2\x82g", mark + mark + "g"},
    };
    for (const auto& [text, expected] : cases) {
        CHECK_THROWS(nlohmann::json::parse('"' + text + '"'));
        CHECK(nlohmann::json::parse(json_quoted(text)).get<std::string>() == expected);
    }
    for (int a = 0; a < 256; ++a)
        for (int b = 0; b < 256; ++b)
            CHECK(nlohmann::json::accept(json_quoted(std::string{static_cast<char>(a), static_cast<char>(b), '\x80'})));
}
