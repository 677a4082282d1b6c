#include <unistd.h>

#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

// A scene in project/scenes, which names two files beside that folder; link leads to project/scenes.
class LinkedProject {
  public:
    LinkedProject() {
        namespace fs = std::filesystem;
        for (const char* folder : {"project/scenes", "project/data", "data"}) fs::create_directories(at(folder));
        put_file(at("project/scenes/s.json"), R"({"format": "stokes-scene", "version": 1,
            "camera": {"position_mm": [0, 0, 9], "target_mm": [0, 0, 0]},
            "media": {"stone": {"sigma_s_per_mm": {"file": "../data/s.csv", "column": "s"}, "sigma_a_per_mm": 1}},
            "materials": {"body": {"type": "translucent", "medium": "stone"}},
            "lights": [{"type": "disk", "center_mm": [0, 9, 0], "normal": [0, -1, 0], "radius_mm": 1, "spectrum": 1,
                        "power_W": 1}],
            "shapes": [{"type": "mesh", "file": "../data/m.obj", "material": "body"}]})");
        put_data("project/data", 2.0, "1");
        if (::symlink("project/scenes", at("link").c_str()) != 0) throw std::runtime_error("no link can be made");
    }
    std::string at(const std::string& name) const { return folder_.file(name); }
    // sigma_s [1/mm], and the height of a triangle [mm]
    void put_data(const std::string& folder, double sigma_s, const std::string& height) const {
        put_file(at(folder + "/s.csv"),
                 "lambda_nm,s\n300," + std::to_string(sigma_s) + "\n830," + std::to_string(sigma_s) + "\n");
        put_file(at(folder + "/m.obj"), "v 0 0 0\nv 1 0 0\nv 0 " + height + " 0\nf 1 2 3\n");
    }

  private:
    TemporaryFolder folder_;
};

void check_is_the_projects(const Scene& scene) {
    CHECK(scene.media.at(0).sigma_s.at(500) == Approx(2.0));
    float top = 0.0f;
    for (const auto& vertex : scene.shapes.at(0).mesh.positions_mm) top = std::max(top, vertex.y);
    CHECK(top == 1.0f);
}

}  // namespace

// POSIX: "link/.." is the folder that holds what the link leads to.
TEST_CASE("\"..\" after a symbolic link leads where the system goes", "[scene]") {
    const LinkedProject project;
    check_is_the_projects(read_scene(project.at("link/s.json")));
    project.put_data("data", 7.0, "3");  // where "link/../data" would be with the link struck out
    check_is_the_projects(read_scene(project.at("link/s.json")));
    check_is_the_projects(read_scene(project.at("link/../scenes/s.json")));
    check_is_the_projects(read_scene(project.at("project/./scenes/../scenes/s.json")));
}

TEST_CASE("a file that is not there is named as the scene names it", "[scene]") {
    const LinkedProject project;
    std::filesystem::remove(project.at("project/data/s.csv"));
    CHECK_THAT(input_error([&] { read_scene(project.at("link/s.json")); }),
               Contains("link/../data/s.csv: cannot read"));
}
