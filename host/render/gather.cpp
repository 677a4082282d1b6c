#include "host/render/gather.hpp"

#include "host/render/local_radii.hpp"

namespace stokes {

Gather::Gather(const Device& device, const RayKernels& kernels, const CameraRecord& camera)
    : device_(device),
      kernels_(kernels),
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

Arguments Gather::own(const Buffer<FilmValue>& film) const {
    return Arguments("count", pixels()).add("gather_points", points_).add("film", film, "float4");
}

void Gather::collect_points(const Arguments& common, const Buffer<Ray>& rays, const Buffer<Hit>& hits,
                            const Buffer<FilmValue>& film) {
    collect_points_.launch(pixels(), common, own(film),
                           Arguments("camera", camera_).add("rays", rays).add("hits", hits));
}

void Gather::add_direct_light(const Arguments& common, const Buffer<FilmValue>& film) {
    if (!add_direct_light_)
        add_direct_light_.emplace(kernels_.program(device_, "direct_light.cl").kernel("add_direct_light"));
    add_direct_light_->launch(pixels(), common, own(film));
}

void Gather::count_photons(std::uint32_t map, std::uint32_t level, const SpatialHash& photons,
                           const Buffer<float>& counts) {
    count_photons_.launch(
        pixels(), own({}), photons.arguments(),
        Arguments("map", map).add("level", level).add("enough", enough_photons).add("counts", counts));
}

void Gather::set_radii(const std::vector<PixelRadius>& pixels) {
    radii_ = {device_, "radii of pixels", pixels};
    radius_classes_ = stokes::radius_classes(pixels);
}

void Gather::choose_radii() {
    if (radii_.size() > 0) choose_radii_.launch(pixels(), own({}), Arguments("pixel_radii", radii_));
}

void Gather::measure_disks(const Arguments& common, float radius_mm) {
    measure_disks_.launch(pixels(), common, own({}), Arguments("radius_mm", radius_mm));
}

void Gather::add_map(const Arguments& common, std::uint32_t map, float radius_class, const SpatialHash& photons,
                     const Buffer<FilmValue>& film) {
    gather_radiance_.launch(pixels(), common, own(film), photons.arguments(),
                            Arguments("map", map).add("largest_factor", radius_class));
}

}  // namespace stokes
