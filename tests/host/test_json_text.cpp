#include <cmath>

#include "host/core/json_text.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;
using Json = nlohmann::ordered_json;

TEST_CASE("text for JSON reads back, its keys in their order", "[json]") {
    const Json json = {{"z", 0.1}, {"a", "a\"b\\c\n\t\x01z"}, {"m", std::string("nul\0in \u20ac", 10)}};
    CHECK(Json::parse(json_text(json)) == json);
    CHECK(json_text({{"z", 0.1}, {"a", {1, 2}}}, -1) == "{\"z\":0.1,\"a\":[1,2]}\n");
}

TEST_CASE("bytes that are not UTF-8 become U+FFFD, numbers that are not finite null", "[json]") {
    CHECK(json_text("caf\xe9.json") == "\"caf\uFFFD.json\"\n");
    CHECK(json_text({INFINITY, -INFINITY, NAN, 1.5}, -1) == "[null,null,null,1.5]\n");
    for (int a = 0; a < 256; ++a)
        for (int b = 0; b < 256; ++b)
            CHECK(Json::accept(json_text(std::string{static_cast<char>(a), static_cast<char>(b), '\x80'})));
}
