#include "tests/support/catch.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

TEST_CASE("every command refuses the name of another format before it works", "[command line]") {
    const TemporaryFolder folder;
    const std::string path = folder.path() + "/", render = "render " + sphere_scene + small_render,
                      probe = "probe --sigma-s 1 --sigma-a 0.1 ", exr = folder.file("a.exr");
    REQUIRE(run_stokes(render + "--quiet -o " + exr).code == 0);
    struct Case {
        std::string arguments, expected;
    };
    for (const Case& c : std::vector<Case>{
             {render + "-o " + path + "x.png",
              "x.png: -o writes an OpenEXR picture; expected a name that ends in .exr"},
             {render + "-o " + path + "x.tiff", ".exr"},
             {render + "--png " + path + "x.jpg",
              "x.jpg: --png writes a PNG picture; expected a name that ends in .png"},
             {render + "-o " + path + "x.exr --png " + path + "y.exr", "y.exr: --png"},
             {render + "--stats " + path + "x.csv", "x.csv: --stats writes JSON; expected a name that ends in .json"},
             {render + "--stats -", "--stats: expected the name of a file, got \"-\""},
             {render + "--rmse-against " + exr + " --csv " + path + "x.json", "x.json: --csv writes a table, CSV"},
             {probe + "--json " + path + "x.txt", "x.txt: --json"},
             {probe + "--matrix " + path + "x.json", "x.json: --matrix"},
             {"compare " + exr + " " + exr + " --diff " + path + "x.exr", "x.exr: --diff"},
             {"tables --green -o " + path + "x.json", "x.json: -o with --green"},
             {render + "-o ''", "--output: expected the name of a file, got \"\""},
             {render + "-o " + path + "x.exr --png ''", "--png: expected the name of a file, got \"\""},
         }) {
        const Outcome outcome = run_stokes(c.arguments);
        CAPTURE(c.arguments, outcome.err);
        CHECK(outcome.code == 2);
        CHECK_THAT(outcome.err, Contains(c.expected));
        CHECK(outcome.err.find('\n') + 1 == outcome.err.size());
    }
    CHECK(folder.names() == std::vector<std::string>{"a.exr"});
}

TEST_CASE("an ending that no format has is warned of, none is fine", "[command line]") {
    const TemporaryFolder folder;
    const Outcome outcome = run_stokes("render " + sphere_scene + small_render + "--quiet -o " + folder.file("a.part") +
                                       " --png " + folder.file("plain") + " --stats " + folder.file("B.JSON"));
    CHECK(outcome.code == 0);
    CHECK(outcome.err == "stokes: warning: " + folder.file("a.part") +
                             ": -o writes an OpenEXR picture; expected a name that ends in .exr\n");
    CHECK(folder.names() == std::vector<std::string>{"B.JSON", "a.part", "plain"});
}

TEST_CASE("no output replaces a file that the scene or a flag names", "[command line]") {
    const TemporaryFolder folder;
    const std::string spectrum = folder.file("lamp.csv"), content = "lambda_nm,x\n300,0.5\n830,0.5\n";
    put_file(spectrum, content);
    const Outcome probe =
        run_stokes("probe --sigma-s " + spectrum + " --sigma-a 0.1 --photons 20000 --matrix " + spectrum);
    CHECK(probe.code == 2);
    CHECK_THAT(probe.err, Contains("this output would replace a file that is read"));

    std::string scene = file_content(sphere_scene);
    for (std::size_t at = scene.find("../"); at != std::string::npos; at = scene.find("../"))
        scene.replace(at, 3, source_path(""));
    const std::string body = "\"type\": \"diffuse\",", reflectance = "\"reflectance\": ";
    REQUIRE(scene.find(body) != std::string::npos);
    const std::size_t begin = scene.find(reflectance, scene.find(body)) + reflectance.size();
    scene.replace(begin, scene.find_first_of(",}\n", begin) - begin, "{\"file\": \"lamp.csv\", \"column\": \"x\"}");
    put_file(folder.file("s.json"), scene);
    const std::string render = "render " + folder.file("s.json") + small_render + "--quiet ";
    REQUIRE(run_stokes(render + "-o " + folder.file("a.exr")).code == 0);
    const Outcome outcome = run_stokes(render + "--rmse-against " + folder.file("a.exr") + " --csv " + spectrum);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.err, Contains("lamp.csv: this output would replace a file that is read"));
    CHECK(file_content(spectrum) == content);
}

TEST_CASE("a run that ends with bad input touches no file", "[command line]") {
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "a.png.tmp", "a.exr"}) put_file(folder.file(name), "mine");
    const Outcome outcome =
        run_stokes("render nowhere.json --png " + folder.file("a.png") + " -o " + folder.file("a.exr"));
    CHECK(outcome.code == 2);
    CHECK(folder.names() == std::vector<std::string>{"a.exr", "a.png", "a.png.tmp"});
    for (const std::string& name : folder.names()) CHECK(file_content(folder.file(name)) == "mine");
}
