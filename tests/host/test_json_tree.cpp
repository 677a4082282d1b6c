#include "host/core/json_cursor.hpp"
#include "host/core/json_tree.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"

using namespace stokes;

TEST_CASE("Every JSON value and key knows its line") {
    const JsonValue root =
        parse_json("{\n\"a\":\n 12\n, \"b\": [true,\n-0.5\n,null,\n\"x\\n\"],\n\n\"c\":{}}", "f.json");
    REQUIRE(root.type == JsonValue::Type::object);
    CHECK(root.line == 1);
    REQUIRE(root.keys.size() == 3);
    CHECK(root.keys[0].name == "a");
    CHECK(root.keys[0].line == 2);
    CHECK(root.items[0].line == 3);
    CHECK(root.items[0].number == 12.0);
    CHECK(root.keys[1].line == 4);
    const JsonValue& b = root.items[1];
    CHECK(b.line == 4);
    REQUIRE(b.items.size() == 4);
    CHECK((b.items[0].boolean && b.items[0].line == 4));
    CHECK((b.items[1].number == -0.5 && b.items[1].line == 5));
    CHECK((b.items[2].type == JsonValue::Type::null && b.items[2].line == 6));
    CHECK((b.items[3].text == "x\n" && b.items[3].line == 7));
    CHECK(root.keys[2].line == 9);
    CHECK(root.items[2].line == 9);
}

TEST_CASE("Line ends of either kind count once, and a byte order mark is skipped") {
    const JsonValue root = parse_json("\xEF\xBB\xBF[1,\r\n2,\r\n\r\n3\r\n]", "f.json");
    REQUIRE(root.items.size() == 3);
    CHECK(root.items[0].line == 1);
    CHECK(root.items[1].line == 2);
    CHECK(root.items[2].line == 4);
}

TEST_CASE("Bad JSON is one line with file and line") {
    struct Case {
        std::string text;
        std::string expected;
    };
    const Case cases[] = {
        {"", "f.json:1: JSON syntax error"},
        {"{\n\"a\": 1,\n}", "f.json:3: JSON syntax error while parsing object key"},
        {"{\n\"a\": 1\n\"b\": 2}", "f.json:3: JSON syntax error while parsing object"},
        {"[1,\n2", "f.json:2: JSON syntax error while parsing array"},
        {"[1,\n2]\n]", "f.json:3: JSON syntax error while parsing value"},
        {"[1,\n\n 1e999\n]", "f.json:3: number out of range: 1e999"},
        {"[NaN]", "f.json:1: JSON syntax error"},
        {"[\n\"tab\there\"]", "f.json:2: JSON syntax error"},
        {"[\n\"\xFF\"]", "f.json:2: JSON syntax error"},
        {"[1] // remark", "f.json:1: JSON syntax error"},
        {"{\"a\": 1,\n \"b\": {\"x\": 1,\n\"y\": 2, \"x\": 3}}", "f.json:3: key \"x\" given twice, first in line 2"},
        {std::string(33, '['), "f.json:1: values nested deeper than 32"},
        {std::string(1'000'000, '['), "f.json:1: values nested deeper than 32"},
    };
    for (const Case& c : cases) {
        INFO(c.text.substr(0, 60));
        CHECK_THAT(input_error([&] { parse_json(c.text, "f.json"); }), Catch::Matchers::StartsWith(c.expected));
    }
    CHECK_NOTHROW(parse_json(std::string(32, '[') + std::string(32, ']'), "f.json"));
}

TEST_CASE("Every shortened JSON text is an error and nothing worse") {
    const std::string whole = "{\"a\": [1, 2.5e3, true, null, \"x\\u00e4\"], \"b\": {\"c\": -1}}";
    CHECK_NOTHROW(parse_json(whole, "f.json"));
    for (std::size_t length = 0; length < whole.size(); ++length) {
        INFO(length);
        CHECK(input_error([&] { parse_json(whole.substr(0, length), "f.json"); }).substr(0, 9) == "f.json:1:");
    }
}

TEST_CASE("A cursor names the key path, what it expected and what it found") {
    const std::string file = "f.json";
    const JsonValue tree =
        parse_json("{\"n\": 1.5, \"s\": \"word\", \"list\": [1,\n2, {\"z\": []}], \"v\": [0, 3, 4]}", file);
    const JsonCursor root(tree, file);
    CHECK(root.at("n").number({0, 2}) == 1.5);
    CHECK(root.at("v").direction() == glm::dvec3(0.0, 0.6, 0.8));
    CHECK(input_error([&] {
              root.at("n").number({0, 1, true});
          }) == "f.json:1: n: expected a number in (0, 1], got 1.5");
    CHECK(input_error([&] { root.at("n").integer(0, 9); }) == "f.json:1: n: expected an integer in [0, 9], got 1.5");
    CHECK(input_error([&] {
              root.at("s").number({0, 1});
          }) == "f.json:1: s: expected a number in [0, 1], got \"word\"");
    CHECK(input_error([&] { root.at("s").boolean(); }) == "f.json:1: s: expected true or false, got \"word\"");
    CHECK(input_error([&] {
              root.at("s").choice({"sword", "shield"});
          }) == "f.json:1: s: expected \"sword\" or \"shield\", got \"word\"; did you mean \"sword\"?");
    CHECK(input_error([&] { root.at("list").items().at(2).at("z").text(); }) ==
          "f.json:2: list[2].z: expected a string, got an array of 0");
    CHECK(input_error([&] { root.at("list").vector(); }) ==
          "f.json:2: list[2]: expected a number in [-1e+11, 1e+11], got an object");
    CHECK(input_error([&] { root.at("width"); }) == "f.json:1: missing key \"width\"");
    CHECK(input_error([&] {
              root.expect_keys({"n", "s", "v", "lists"}, {});
          }) == "f.json:1: unknown key \"list\"; did you mean \"lists\"?");
    CHECK(input_error([&] { root.expect_keys({"n", "s", "list", "v"}, {"n", "w"}); }) == "f.json:1: missing key \"w\"");
    CHECK(input_error([&] {
              root.one_of({"n", "s"});
          }) == "f.json:1: \"n\" and \"s\" given together; expected one of them");
}
