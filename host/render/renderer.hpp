// Probabilistic progressive photon mapping of a scene: independent passes, and their mean.
#pragma once

#include <cstdint>
#include <vector>

#include "host/device/kernel.hpp"
#include "host/image/film.hpp"
#include "host/render/camera_view.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/emission_cells.hpp"
#include "host/render/gather.hpp"
#include "host/render/ledger.hpp"
#include "host/render/photon_pass.hpp"
#include "host/render/seen_sides.hpp"
#include "host/render/spatial_hash.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

class Renderer {
  public:
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    // Uploads the scene and compiles the kernels. InputError for scenes that cannot be rendered (no power, too large
    // for the device's memory budget), RunError for device failures.
    Renderer(const Device& device, const Scene& scene);

    // Renders the pass with this index (from 0) and adds it to the film. Passes are independent of each other: a pass
    // depends on the scene, its seed and its index alone.
    void render_pass(std::uint32_t pass);

    // Mean of the passes so far: XYZ per component, Y in cd/m^2. Waits for the device.
    FilmImage image() const;

    std::uint32_t passes() const { return passes_; }
    const LedgerBook& book() const { return book_; }
    // Translucent bodies that no photon of these passes has met, by index.
    std::vector<int> unmet_bodies() const { return photon_pass_.unmet_bodies(); }
    // Of each shape, what a pass's camera rays, or some of them, meet of its front and its back.
    const std::vector<SeenSides>& seen_sides() const { return seen_sides_; }
    // Of the power that the lights emit, what starts where it can meet something.
    double emitted_part() const { return on_device_.emitted_part; }
    std::uint64_t camera_rays() const { return std::uint64_t{passes_} * view_.ray_count(); }
    double first_radius() const { return first_radius_mm_; }  // [mm]
    double radius_of(std::uint32_t pass) const;               // [mm]
    // Processor time of the trial passes that found radii and where photons should start, of all threads of the
    // process.
    double trials_processor_s() const { return trials_processor_s_; }

  private:
    void set_up_passes();
    void make_trial_photons(bool as_plain);
    double find_first_radius();
    std::vector<EmissionSample> emission_seeds(std::vector<EmittingLight>& lights);
    EmissionCells aimed_cells(const std::vector<EmittingLight>& lights, const std::vector<EmissionSample>& seeds);
    std::vector<PixelRadius> find_local_radii(double radius_mm);
    void find_visible_points(const CameraRecord& camera);
    std::vector<SeenSides> find_seen_sides();
    void gather_maps(double radius_mm);

    Device device_;
    Scene scene_;
    DeviceScene on_device_;
    std::uint32_t photons_;
    double first_radius_mm_ = 0.0, trials_processor_s_ = 0.0;
    HashBuilder hash_builder_;
    SpatialHash hash_;  // of one map at a time
    PhotonPass photon_pass_;
    CameraView view_;
    Gather gather_;
    Kernel trace_;              // camera rays, to what they meet first
    Kernel settle_;             // camera rays, where surfaces lie in one place
    Kernel trace_reflections_;  // camera rays, on from surfaces that mirror them
    Buffer<Ray> camera_rays_;
    Buffer<Hit> camera_hits_;
    Buffer<FilmValue> film_;
    std::vector<SeenSides> seen_sides_;
    std::uint32_t passes_ = 0;
    LedgerBook book_;
};

}  // namespace stokes
