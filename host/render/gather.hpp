// Light that reaches the camera: that of emitters which camera rays meet, light that falls straight from the lights
// onto the points which they meet, and the density estimate over the photon maps.
#pragma once

#include <optional>

#include "host/device/kernel.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/spatial_hash.hpp"
#include "kernels/shared/camera.h"
#include "kernels/shared/gather.h"
#include "kernels/shared/layers.h"
#include "kernels/shared/material.h"
#include "kernels/shared/pass.h"
#include "kernels/shared/photon.h"
#include "kernels/shared/ray.h"

namespace stokes {

// One value of the film: X, Y, Z [cd/m^2], 0.
struct alignas(16) FilmValue {
    float x, y, z, unused;
};

// Adds a pass to the film [STOKES_LAYER_COUNT][height][width]. common: arguments of the scene and of the pass.
class Gather {
  public:
    Gather(const Device& device, const RayKernels& kernels, const CameraRecord& camera);

    // Finds the points that the camera rays meet, and adds the light of emitters among them to the surface layer.
    // rays, hits: one per pixel, as CameraView makes and trace_closest_all or trace_reflections find them.
    // Asynchronous.
    void collect_points(const Arguments& common, const Buffer<Ray>& rays, const Buffer<Hit>& hits,
                        const Buffer<FilmValue>& film);

    // Adds the light that falls straight from the lights onto diffuse points to the surface layer. This is the light
    // of the photons that a pass stores at their first event, where it stores them. Asynchronous.
    void add_direct_light(const Arguments& common, const Buffer<FilmValue>& film);

    // Raises counts [count_levels][points], 0 to begin with, to the photons of a map that count towards each point
    // within the radius of its hash: kernels/count_photons.cl. Levels in ascending order. Asynchronous.
    void count_photons(std::uint32_t map, std::uint32_t level, const SpatialHash& photons, const Buffer<float>& counts);

    // Sets the radii that choose_radii gives the points from now on, by pixel: width * height of them.
    void set_radii(const std::vector<PixelRadius>& pixels);

    // Powers of two: add_map gathers the points whose radius, over that of the pass, is at most one of them and above
    // half of it. 1 alone without set_radii.
    const std::vector<float>& radius_classes() const { return radius_classes_; }

    // Gives the points the radii of set_radii, once a pass; without these nothing. Asynchronous.
    void choose_radii();

    // Weighs the points by how much of their disk lies on the surface, once a pass; radius_mm is that of the pass.
    // Without this call each point weighs one, or the exit_scale of its material. Asynchronous.
    void measure_disks(const Arguments& common, float radius_mm);

    // Adds the light of one map (STOKES_MAP_*) at the points of one radius class to the film's layer of the same
    // number. photons: hashed for that many times the radius of the pass. Asynchronous.
    void add_map(const Arguments& common, std::uint32_t map, float radius_class, const SpatialHash& photons,
                 const Buffer<FilmValue>& film);

    // What collect_points found, one a pixel, in the order of the rays.
    const Buffer<GatherPoint>& points() const { return points_; }

  private:
    std::uint32_t pixels() const { return camera_.width * camera_.height; }
    Arguments own(const Buffer<FilmValue>& film) const;
    Device device_;
    RayKernels kernels_;
    CameraRecord camera_;
    Kernel collect_points_, count_photons_, choose_radii_, measure_disks_, gather_radiance_;
    std::optional<Kernel> add_direct_light_;  // compiled when it is first needed
    Buffer<GatherPoint> points_;
    Buffer<PixelRadius> radii_;
    std::vector<float> radius_classes_ = {1.0f};
};

}  // namespace stokes
