// A scene on the device: uploaded once, read by every pass.
#pragma once

#include <cstdint>
#include <vector>

#include "host/device/kernel.hpp"
#include "host/render/device_textures.hpp"
#include "host/render/emission_bounds.hpp"
#include "host/render/ray_casting.hpp"
#include "host/scene/mesh/contacts.hpp"
#include "host/scene/scene.hpp"
#include "kernels/shared/light.h"
#include "kernels/shared/material.h"
#include "kernels/shared/ray.h"

namespace stokes {

struct DeviceScene {
    DeviceScene(const Device& device, const Scene& scene);

    // The groups RAY_SCENE_ARGUMENTS, SURFACE_ARGUMENTS, TEXTURE_ARGUMENTS, LIGHT_ARGUMENTS, and bodies.
    Arguments arguments() const;

    Buffer<Triangle> triangles;
    Buffer<ShapeRecord> shapes;
    Buffer<MaterialRecord> materials;
    DeviceTextures textures;
    Buffer<BodyRecord> bodies;
    Buffer<ContactRegion> contact_regions;  // one at least
    RayScene rays;
    Buffer<LightRecord> lights;
    Buffer<float> light_areas;                     // cumulative area of the triangles of each surface light [mm^2]
    bool has_mirrors = false;                      // some material mirrors camera rays
    bool has_contacts = false;                     // some bodies touch
    bool has_contested = false;                    // some triangles lie in one place
    std::vector<double> light_probability;         // per light
    double emitted_part = 1.0;                     // of the lights' power, what starts within their EmissionBounds
    std::vector<double> light_spread;              // per light, LightTables::spread
    float offset_mm = 0.0f;                        // rays start this far off a surface
    glm::vec3 minimum_mm{0.0f}, maximum_mm{0.0f};  // bounding box
    std::uint32_t light_count = 0;

  private:
    void set_emitted_part(const std::vector<EmissionBounds>& bounds);
};

// How far rays start off a surface [mm].
double ray_offset_mm(const Scene& scene);

// All triangles of the scene in the order of its shapes; degenerate ones are kept, they are never hit.
std::vector<Triangle> scene_triangles(const Scene& scene, const Contacts& contacts);

}  // namespace stokes
