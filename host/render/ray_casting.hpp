// The scene's bounding volume hierarchy on a device, and the kernels that go with it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/device/kernel.hpp"
#include "host/scene/bvh/bvh_builder.hpp"
#include "kernels/shared/bvh.h"
#include "kernels/shared/ray.h"

namespace stokes {

inline constexpr std::uint32_t ray_packet = 16;  // rays that trace_packets takes at a time

// How kernels that include lib/bvh.clh are built.
struct RayKernels {
    std::vector<std::string> options;  // of the compiler
    bool packets = false;              // neighbouring rays are traced sixteen at a time

    Program program(const Device& device, const std::string& file) const { return {device, file, options}; }
};

// Children of a node, by the shape of the device's kernels and the width of its vectors.
BvhLayout ray_layout(const Device& device);

// layout: as built, its bounds known.
RayKernels ray_kernels(const Device& device, const BvhLayout& layout);

// Triangles ready to be traced.
struct RayScene {
    RayScene() = default;
    RayScene(const Device& device, const Bvh& bvh);
    // InputError as build_bvh.
    RayScene(const Device& device, const std::vector<Triangle>& triangles)
        : RayScene(device, build_bvh(triangles, ray_layout(device))) {}

    // RAY_SCENE_ARGUMENTS.
    Arguments arguments() const {
        return Arguments().add("bvh_nodes", nodes, "BvhNode").add("bvh_blocks", blocks).add("bvh_grid", grid);
    }

    RayKernels kernels;
    Buffer<std::uint32_t> nodes;
    Buffer<BvhBlock> blocks;
    BvhGrid grid{};
};

}  // namespace stokes
