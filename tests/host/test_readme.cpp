#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;

TEST_CASE("the scene of the guide to scenes is a scene", "[readme]") {
    const std::string text = file_content(source_path("scenes/README.md"));
    const std::string open = "```json\n";
    const std::size_t first = text.find(open);
    REQUIRE(first != std::string::npos);
    const std::size_t begin = first + open.size();
    const Scene scene = parse_scene(text.substr(begin, text.find("```", begin) - begin), "scenes/README.md");
    CHECK(scene.shapes.size() == 2);
    CHECK(scene.lights.size() == 1);
    CHECK(scene.fluorophores.size() == 1);
}
