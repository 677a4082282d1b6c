#include "tests/support/device_fixture.hpp"

#include "host/core/text_input.hpp"
#include "tests/support/paths.hpp"

namespace stokes {

Device& test_device() {
    // Never destroyed: under oclgrind the compiler's own statics are gone by then.
    static Device& device = *new Device(Device::open("cpu"));
    return device;
}

Program test_program(const std::string& name, const std::vector<std::string>& options) {
    const std::string path = source_path("tests/kernel/" + name);
    return Program::from_source(test_device(), name, read_file(path), options);
}

}  // namespace stokes
