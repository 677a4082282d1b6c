// Where photons should start for the first trial passes, from geometry alone: trial photons that start evenly would
// hardly find a body that is small beside all that the lights reach.
#pragma once

#include <vector>

#include "host/device/kernel.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/emission_cells.hpp"
#include "host/scene/scene.hpp"
#include "kernels/shared/camera.h"
#include "kernels/shared/gather.h"

namespace stokes {

// A place that photons should meet, and the area of the surface that it stands for [mm^2].
struct SeedPoint {
    EmissionTarget at;
    double area_mm2 = 0.0;
};

// Of a body, evenly by area; none where it has no area.
std::vector<SeedPoint> points_of_body(const Scene& scene, int body, std::size_t count);

// Some of what camera rays meet and photons light, each for its share of the pixels.
std::vector<SeedPoint> visible_points(const CameraRecord& camera, const std::vector<GatherPoint>& points);

class EmissionSeeds {
  public:
    // scene and on_device outlive it.
    EmissionSeeds(const Device& device, const Scene& scene, const DeviceScene& on_device);

    // Of photons that start evenly over the lights, the share that goes to these points; what lies between is not
    // counted.
    double share(const std::vector<SeedPoint>& points) const;

    // Takes the points in as a set of which each point, and each light by its share of the photons, counts alike.
    void add(const std::vector<SeedPoint>& points);

    // Gives the lights a region about the samples so far.
    void set_regions(std::vector<EmittingLight>& lights) const;

    // Samples for EmissionCells::aimed(), by which photons go to all sets alike.
    const std::vector<EmissionSample>& samples() const { return samples_; }

  private:
    struct alignas(16) Place {
        float at[4];
    };
    struct Found {
        std::vector<Place> places;     // [points]
        std::vector<float> densities;  // [points, 1/mm^2]
    };
    Found find(std::uint32_t light, const std::vector<SeedPoint>& points) const;

    Device device_;
    const Scene& scene_;
    const DeviceScene& on_device_;
    Kernel find_places_;
    std::vector<EmissionSample> samples_;
};

// Of the translucent bodies that fewer of so many even photons would go to than it takes to aim at them: points on
// each.
std::vector<std::vector<SeedPoint>> rare_bodies(const Scene& scene, const EmissionSeeds& seeds, double photons);

}  // namespace stokes
