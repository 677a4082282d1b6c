#include "tests/support/device_fixture.hpp"

#include <fstream>
#include <sstream>

#include "tests/support/paths.hpp"

namespace stokes {

Device& test_device() {
    // Never destroyed: under oclgrind the compiler's own statics are gone by then.
    static Device& device = *new Device(Device::open("cpu"));
    return device;
}

Program test_program(const std::string& name, const std::vector<std::string>& options) {
    const std::string path = source_path("tests/kernel/" + name);
    std::ifstream in(path);
    if (!in) throw RunError(path + ": cannot read this test kernel");
    std::ostringstream text;
    text << in.rdbuf();
    return Program::from_source(test_device(), name, text.str(), options);
}

}  // namespace stokes
