// A scene on the device: uploaded once, read by every pass.
#pragma once

#include <cstdint>
#include <vector>

#include "host/device/device.hpp"
#include "host/scene/scene.hpp"
#include "host/subsurface/device_table.hpp"
#include "kernels/shared/bvh.h"
#include "kernels/shared/light.h"
#include "kernels/shared/material.h"
#include "kernels/shared/power_table.h"
#include "kernels/shared/ray.h"

namespace stokes {

// The power tables of all media of a scene, for each medium fluorescence, single, multiple.
struct DeviceTables {
    Buffer<TableShape> shapes;             // [3 media]
    Buffer<float> values;                  // [entry][lambda]
    Buffer<float> mean_rows;               // [entry] distance densities
    Buffer<float> cumulative_rows;         // [entry]
    Buffer<Flux16> at_wavelengths;         // [entry] at the pass's wavelengths
    EvenAxis wavelengths;                  // of values [nm]
    std::uint32_t entries = 0;
};

struct DeviceScene {
    DeviceScene(const Device& device, const Scene& scene);

    Buffer<Triangle> triangles;
    Buffer<ShapeRecord> shapes;
    Buffer<MaterialRecord> materials;
    Buffer<BvhNode> nodes;
    Buffer<BvhBlock> blocks;
    BvhGrid grid{};
    Buffer<LightRecord> lights;
    Buffer<float> light_areas;  // cumulative area of the triangles of each surface light [mm^2]
    DeviceTables tables;
    std::vector<double> light_probability;      // per light
    std::vector<double> light_surface_area_mm2;  // per light, 0 for beams
    float offset_mm = 0.0f;                      // rays start this far off a surface
    glm::vec3 minimum_mm{0.0f}, maximum_mm{0.0f};  // bounding box
    std::uint32_t light_count = 0;
};

// All triangles of the scene in the order of its shapes; degenerate ones are kept, they are never hit.
std::vector<Triangle> scene_triangles(const Scene& scene);

}  // namespace stokes
