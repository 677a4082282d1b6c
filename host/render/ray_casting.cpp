#include "host/render/ray_casting.hpp"

namespace stokes {

// Nodes of sixteen children pay where one vector holds a bound of all of them.
BvhLayout ray_layout(const Device& device) {
    const RayShape shape = device.ray_shape();
    const bool wide =
        shape == RayShape::avx512 || (shape == RayShape::portable && device.description().vector_floats >= 16);
    return {wide ? 16 : 8, BvhBounds::automatic};
}

RayKernels ray_kernels(const Device& device, const BvhLayout& layout) {
    const RayShape shape = device.ray_shape();
    RayKernels kernels;
    kernels.options = bvh_kernel_options(layout);
    if (shape == RayShape::portable) kernels.options.push_back("-DSTOKES_BVH_PORTABLE");
    if (shape == RayShape::scalar) kernels.options.push_back("-DSTOKES_BVH_SCALAR");
    kernels.packets = shape != RayShape::scalar;
    return kernels;
}

RayScene::RayScene(const Device& device, const Bvh& bvh)
    : kernels(ray_kernels(device, bvh.layout)),
      nodes(device, "bounding volumes", bvh.nodes),
      blocks(device, "triangle blocks", bvh.blocks),
      grid(bvh.grid) {}

}  // namespace stokes
