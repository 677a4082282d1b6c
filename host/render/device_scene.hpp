// A scene on the device: uploaded once, read by every pass.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "host/device/device.hpp"
#include "host/render/device_textures.hpp"
#include "host/render/ray_casting.hpp"
#include "host/scene/scene.hpp"
#include "host/subsurface/device_table.hpp"
#include "host/subsurface/green_table.hpp"
#include "kernels/shared/integrated_power.h"
#include "kernels/shared/light.h"
#include "kernels/shared/material.h"
#include "kernels/shared/power_table.h"
#include "kernels/shared/ray.h"

namespace stokes {

// A medium's Green's function tables, model `conserving`. They are made anew for every pass (SubsurfaceTables).
struct GreenOwner {
    int medium;             // index into Scene::media
    double eta;             // of the tables: 1 where the surface does not reflect
    std::size_t first_row;  // in the probabilities of escape
    TableShape shape;
};

// What subsurface light is looked up in. An owner has three shapes, for fluorescence, single and multiple scattering.
// Model `paper`: an owner is a medium, with three power tables. `conserving`: an owner is a medium with or without a
// reflecting surface, with one table. `walk`: there are none.
struct DeviceTables {
    Buffer<TableShape> shapes;      // [3 owners]
    Buffer<float> values;           // paper: [entry][lambda]
    Buffer<float> mean_rows;        // [entry] distance densities; paper: then as many, DistanceSampler's weighted
    Buffer<float> cumulative_rows;  // likewise
    Buffer<Flux16> at_wavelengths;  // [entry] at the pass's wavelengths
    UniformAxis wavelengths;        // of values [nm]
    std::uint32_t entries = 0;
    std::vector<GreenOwner> green;              // conserving
    std::map<double, GreenTable> green_tables;  // by refractive index
    std::size_t green_rows = 0;                 // of all of them together
};

// Model `paper` without power tables: what distances are drawn from, and the media at the pass's wavelengths, both by
// index of Scene::media. Entries of media that no material needs are all 0.
struct IntegratedMedia {
    Buffer<DistanceMixture> mixtures;
    Buffer<float> mixture_rows;
    Buffer<PassMedium> at_wavelengths;
};

struct DeviceScene {
    DeviceScene(const Device& device, const Scene& scene);

    Buffer<Triangle> triangles;
    Buffer<ShapeRecord> shapes;
    Buffer<MaterialRecord> materials;
    DeviceTextures textures;
    Buffer<std::uint32_t> bodies;  // STOKES_BODY_*, by body; one entry where the transport does not ask
    RayScene rays;
    Buffer<LightRecord> lights;
    Buffer<float> light_areas;  // cumulative area of the triangles of each surface light [mm^2]
    Transport transport = Transport::paper;
    bool has_fresnel = false;  // some material reflects specularly
    DeviceTables tables;
    std::optional<IntegratedMedia> integrated;     // in place of tables
    std::vector<double> light_probability;         // per light
    std::vector<double> light_spread;              // per light, LightTables::spread
    float offset_mm = 0.0f;                        // rays start this far off a surface
    glm::vec3 minimum_mm{0.0f}, maximum_mm{0.0f};  // bounding box
    std::uint32_t light_count = 0;
};

// All triangles of the scene in the order of its shapes; degenerate ones are kept, they are never hit.
std::vector<Triangle> scene_triangles(const Scene& scene);

}  // namespace stokes
