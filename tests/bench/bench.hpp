// What stokes_bench measures, a function a section. Each prints a table and returns its part of the JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/device/device.hpp"
#include "tests/bench/timing.hpp"

namespace stokes::bench {

using Json = nlohmann::ordered_json;

// tiny: the smallest that still runs everything, for the test of the program itself; its times mean nothing.
enum class Amount { tiny, quick, full };

struct Setting {
    Device device;
    unsigned threads = 1;  // of the device and of the C++ programs it is compared with
    Amount amount = Amount::full;
    std::string own_mesh;     // PLY file, or empty
    std::string own_program;  // path of this program
    std::string device_selector;

    // One of three by amount.
    template <class T>
    T pick(T tiny, T quick, T full) const {
        return amount == Amount::tiny ? tiny : amount == Amount::quick ? quick : full;
    }
};

// Rays against Embree's; by scene.
Json bench_rays(Setting& setting);
// Photon map: build, permute and gather against the same algorithm in C++; by distribution of photons.
Json bench_photon_map(Setting& setting);
// From emission to the last deposit, of prisms.json, by transport model.
Json bench_photons(Setting& setting);
// Whole passes of scenes/prisms.json at 512 x 512 and 262144 photons.
Json bench_pass(Setting& setting);
// What happens to the cost with more photons, pixels, triangles and threads.
Json bench_growth(Setting& setting);

// {"median", "q1", "q3"}
Json to_json(const Spread& spread);

}  // namespace stokes::bench
