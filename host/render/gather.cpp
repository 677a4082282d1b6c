#include "host/render/gather.hpp"

#include "host/render/local_radii.hpp"

namespace stokes {

Gather::Gather(const Device& device, const RayKernels& kernels, const CameraRecord& camera)
    : device_(device),
      camera_(camera),
      points_(device, "points seen by the camera", std::size_t{camera.width} * camera.height) {
    const Program program(device, "gather_radiance.cl");
    collect_points_ = program.kernel("collect_points");
    measure_disks_ = kernels.program(device, "measure_disks.cl").kernel("measure_disks");
    gather_radiance_ = program.kernel("gather_radiance");
    const Program counting(device, "count_photons.cl");
    count_photons_ = counting.kernel("count_photons");
    choose_radii_ = counting.kernel("choose_radii");
}

void Gather::collect_points(const GatherScene& scene, const Buffer<PassConstants>& pass, const Buffer<Ray>& rays,
                            const Buffer<Hit>& hits, const Buffer<FilmValue>& film) {
    collect_points_.launch(pixels(), camera_, pass, rays, hits, scene.triangles, scene.shapes, scene.materials,
                           scene.lights, scene.emitted, scene.textures.records, scene.textures.texels,
                           scene.textures.uv, points_, film);
}

void Gather::add_direct_light(const DeviceScene& on_device, const GatherScene& scene, const Buffer<PassConstants>& pass,
                              const Buffer<FilmValue>& film) {
    const RayScene& rays = on_device.rays;
    if (!add_direct_light_)
        add_direct_light_.emplace(rays.kernels.program(device_, "direct_light.cl").kernel("add_direct_light"));
    add_direct_light_->launch(pixels(), points_, pixels(), pass, rays.nodes, rays.blocks, rays.grid, scene.triangles,
                              scene.shapes, on_device.light_count, on_device.lights, on_device.light_areas,
                              scene.emitted, scene.spectra, scene.textures.records, film);
}

void Gather::count_photons(std::uint32_t map, std::uint32_t level, const SpatialHash& photons,
                           const Buffer<float>& counts) {
    count_photons_.launch(pixels(), points_, pixels(), map, level, enough_photons, photons.grid(),
                          photons.cell_starts(), photons.positions(), photons.normals(), photons.flux(), counts);
}

void Gather::set_radii(const std::vector<PixelRadius>& pixels) {
    radii_ = {device_, "radii of pixels", pixels};
    radius_classes_ = stokes::radius_classes(pixels);
}

void Gather::choose_radii() {
    if (radii_.size() > 0) choose_radii_.launch(pixels(), radii_, pixels(), points_);
}

void Gather::measure_disks(const DeviceScene& scene, const Buffer<PassConstants>& pass, float radius_mm) {
    measure_disks_.launch(pixels(), pixels(), radius_mm, pass, scene.rays.nodes, scene.rays.blocks, scene.rays.grid,
                          scene.triangles, points_);
}

void Gather::add_map(std::uint32_t map, float radius_class, const SpatialHash& photons, const GatherScene& scene,
                     const Buffer<PassConstants>& pass, const Buffer<FilmValue>& film) {
    gather_radiance_.launch(pixels(), points_, pixels(), map, radius_class, photons.grid(), photons.cell_starts(),
                            photons.positions(), photons.normals(), photons.flux(), scene.spectra,
                            scene.textures.records, pass, film);
}

}  // namespace stokes
