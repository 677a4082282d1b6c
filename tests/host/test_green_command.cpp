#include <string>

#include "host/subsurface/green_table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_stokes.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

Outcome run_tables(const std::string& arguments) { return run_stokes("tables " + arguments); }

}  // namespace

TEST_CASE("stokes tables --green writes a Green's function table", "[green_command]") {
    const TemporaryFolder work;
    const std::string path = work.file("green.json.gz");
    const Outcome run = run_tables("--green --eta 1.4 --walks 300 --device cpu -o \"" + path + "\"");
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    CHECK(run.out == path + "\n");
    CHECK_THAT(run.err, Contains("50 %\n") && Contains("100 %\n"));
    const GreenTable table = read_green_table(path);
    CHECK(table.eta == 1.4);
    const GreenTable nodes = green_table_nodes(1.4);
    CHECK((table.rho == nodes.rho));
    CHECK(green_row_integral(table, 20, 20) == Approx(nodes.u1[20 * nodes.z.size() + 20]).epsilon(1e-6));
}

TEST_CASE("stokes tables says what it cannot do", "[green_command]") {
    const TemporaryFolder work;
    const std::string out = " -o \"" + work.file("x") + "\"";
    CHECK(run_tables("--green --eta 0.5" + out).code == 2);
    CHECK_THAT(run_tables("--green --eta 0.5" + out).err, Contains("expected a refractive index from 1 to 4"));
    CHECK_THAT(run_tables("--green --walks 0" + out).err, Contains("expected a number from 1"));
    CHECK_THAT(run_tables("scene.json --green" + out).err, Contains("expected a scene or --green, not both"));
    CHECK_THAT(run_tables(out).err, Contains("expected a scene file, or --green"));
    CHECK(run_tables("scene.json --eta 1.5" + out).code == 2);
    CHECK(work.names().empty());
}
