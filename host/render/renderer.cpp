#include "host/render/renderer.hpp"

#include <algorithm>
#include <ctime>

#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/render/emission_trial.hpp"
#include "host/render/local_radii.hpp"
#include "host/render/radius.hpp"
#include "host/render/wavelength_importance.hpp"

namespace stokes {

namespace {

// Index of the trial pass that finds the radius; no render reaches it.
constexpr std::uint32_t trial_pass = 0xffffffffu;

// Trial passes for the aiming of photons have the indices below, and together this many photons where that takes no
// more of them. The second half of them starts where the first half found that they should.
constexpr std::uint32_t least_trials = 4, most_trials = 32;
constexpr std::uint32_t all_trial_photons = 1u << 20, most_trial_photons = all_trial_photons / least_trials;

// Share of the photons that start evenly spread in the trials' second half, and in the render.
constexpr double even_share_of_trials = 0.3, uniform_share = 0.15;

// The partition of the lights is no finer than this, nor than so many photons of a pass to a cell.
constexpr std::uint32_t most_cells = 1024, photons_per_cell = 64;

// Slots a map starts with; it grows with the first passes where that is too few.
std::uint32_t first_capacity(std::uint32_t photons) { return photons + 1024; }

std::uint32_t checked_photons(const Scene& scene) {
    const std::int64_t photons = scene.render.photons_per_pass;
    if (photons < 1 || photons > most_photons_per_pass)
        throw InputError("photons per pass: expected 1 to " + std::to_string(most_photons_per_pass) + ", got " +
                         std::to_string(photons));
    return static_cast<std::uint32_t>(photons);
}

}  // namespace

Renderer::Renderer(const Device& device, const Scene& scene)
    : device_(device),
      scene_(scene),
      on_device_(device, scene),
      photons_(checked_photons(scene)),
      pass_(device, scene_, on_device_),
      tracer_(device, on_device_.rays.kernels, photons_),
      hash_builder_(device, first_capacity(photons_)),
      hash_(device, "photon map", first_capacity(photons_)),
      maps_(make_maps()),
      view_(device, make_camera_record(scene.camera, scene.film.width, scene.film.height)),
      gather_(device, on_device_.rays.kernels, view_.camera()),
      camera_rays_(device, "camera rays", view_.ray_count()),
      camera_hits_(device, "camera hits", view_.ray_count()),
      film_(device, "film",
            std::vector<FilmValue>(std::size_t{STOKES_MAP_COUNT} * view_.ray_count(), FilmValue{0, 0, 0, 0})) {
    const RayKernels& kernels = on_device_.rays.kernels;
    trace_ = kernels.program(device, "trace_rays.cl").kernel(kernels.packets ? "trace_packets" : "trace_closest_all");
    if (on_device_.has_fresnel)
        trace_seen_ = kernels.program(device, "trace_reflections.cl").kernel("trace_reflections");
    const std::clock_t start = std::clock();
    set_up_passes();
    device_.finish();
    trials_processor_s_ = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    // Trials have added the emitters that they saw.
    film_.upload(std::vector<FilmValue>(film_.size(), FilmValue{0, 0, 0, 0}));
    device_.reset_stage_times();
}

PhotonMaps Renderer::make_maps() {
    const std::uint32_t capacity = first_capacity(photons_);
    const auto map = [&](const char* name) { return PhotonMap(device_, name, capacity, &hash_builder_, &hash_); };
    return {map("fluorescence"), map("single scattering"), map("multiple scattering"), map("surface")};
}

// By trial passes. The first radius is that of photons that start at random and are all stored, so that it does not
// depend on how the scene is sampled. Local radii relate to it, whatever the scene's, but are those of the photons of
// its passes.
void Renderer::set_up_passes() {
    const RenderSettings& render = scene_.render;
    const bool local = chosen_radii(render) == Radii::local;
    double found_mm = 0.0;
    if (!render.radius_mm || local) {
        make_trial_photons(true);
        found_mm = find_first_radius();
    }
    first_radius_mm_ = render.radius_mm.value_or(found_mm);
    if (chosen_emission(render) == Emission::stratified)
        pass_.set_emission(EmissionCells::stratified(emitting_lights(scene_, on_device_), photons_));
    if (chosen_emission(render) == Emission::aimed) {
        try {
            pass_.set_emission(aimed_cells());
        } catch (const InputError& error) {  // no memory for the trials
            for (PhotonMap& map : maps_) map.track_paths(false);
            warn(std::string("photons are spread evenly in place of aimed: ") + error.what());
            pass_.set_emission(EmissionCells::stratified(emitting_lights(scene_, on_device_), photons_));
        }
    }
    if (!local) return;
    make_trial_photons(false);
    gather_.set_radii(find_local_radii(found_mm));
}

// Photons have the same flux at every wavelength: a lamp of few wavelengths might be dark at all of those that were
// drawn. What one photon stores in several places at once counts as one: it is no more light that found its own way.
void Renderer::make_trial_photons(bool as_plain) {
    pass_.make(trial_pass, photons_);
    Flux16 even;
    std::fill(std::begin(even.v), std::end(even.v), 1.0f);
    pass_.buffers().photon_flux.upload(std::vector<Flux16>(scene_.lights.size(), even));
    for (PhotonMap& map : maps_) map.clear();
    PassBuffers plain = pass_.buffers();
    plain.both_branches = false;
    plain.exits = 1;
    if (as_plain) {
        plain.weighted_distances = false;
        plain.store_direct = true;
    }
    tracer_.trace(on_device_, plain, photons_, maps_);
}

// The camera sees the whole picture: a crop has its radius.
double Renderer::find_first_radius() {
    const CameraRecord whole = make_whole_record(scene_.camera, scene_.film.width, scene_.film.height);
    find_visible_points(whole);
    std::vector<PhotonHead> photons;
    for (const PhotonMap& map : maps_)
        for (const PhotonHead& head : map.heads().download(map.used())) photons.push_back(head);
    const double radius_mm = first_radius_mm(whole, gather_.points().download(), photons);
    return radius_mm > 0.0 ? radius_mm : spread_radius_mm(scene_, photons_);
}

// By trial passes that leave nothing in the film: what their photons bring to the picture says where more should start.
// Their wavelengths are drawn by importance, so that few passes see all of the light.
EmissionCells Renderer::aimed_cells() {
    const std::vector<EmittingLight> lights = emitting_lights(scene_, on_device_);
    const RenderSettings& render = scene_.render;
    const std::uint32_t photons = std::min(photons_, most_trial_photons);
    const std::uint32_t trials = std::clamp(all_trial_photons / photons, least_trials, most_trials);
    const auto cells_of = [&](std::uint32_t n) {
        return std::clamp(n / photons_per_cell, 1u, most_cells) + lights.size();
    };
    const std::size_t trial_cells = cells_of(photons);
    std::optional<StratifiedWavelengths> strata;
    if (render.lambda_max_nm - render.lambda_min_nm + 1 > STOKES_WAVELENGTHS)
        strata.emplace(render.lambda_min_nm, wavelength_importance(scene_));
    EmissionTrial trial(device_, photons);
    EmissionCells cells = EmissionCells::stratified(lights, photons);
    if (cells.records().empty()) return cells;
    for (PhotonMap& map : maps_) map.track_paths(true);
    for (std::uint32_t i = 0; i < trials; ++i) {
        if (i == trials / 2)
            cells = EmissionCells::aimed(lights, trial.samples(), even_share_of_trials, trial_cells, photons);
        if (i == 0 || i == trials / 2) pass_.set_emission(cells);
        const std::uint32_t pass = trial_pass - 1 - i;
        pass_.make(strata ? strata->draw(render.seed, pass) : pass_wavelengths(render, pass), pass, photons);
        for (PhotonMap& map : maps_) map.clear();
        tracer_.trace(on_device_, pass_.buffers(), photons, maps_);
        find_visible_points(view_.camera());
        trial.add(cells, on_device_, pass_.buffers(), maps_, view_.camera(), gather_.points(), on_device_.textures);
    }
    for (PhotonMap& map : maps_) map.track_paths(false);
    return EmissionCells::aimed(lights, trial.samples(), uniform_share, cells_of(photons_), photons_);
}

// From the points of this picture, be it a crop: photons are counted about them, so that a crop has the radii of its
// part of the whole.
std::vector<PixelRadius> Renderer::find_local_radii(double radius_mm) {
    find_visible_points(view_.camera());
    const Buffer<float> counts(device_, "photons about points",
                               std::vector<float>(std::size_t{count_levels} * view_.ray_count(), 0.0f));
    float counted_mm = least_count_factor * static_cast<float>(radius_mm);
    for (std::uint32_t level = 0; level < count_levels; ++level, counted_mm *= 2.0f)
        for (std::uint32_t m = 0; m < STOKES_MAP_COUNT; ++m) {
            const PhotonMap& map = maps_[m];
            if (map.used() == 0) continue;
            hash_builder_.build(hash_, map.heads(), map.flux(), map.used(), on_device_.minimum_mm,
                                on_device_.maximum_mm, counted_mm);
            gather_.count_photons(m, level, hash_, counts);
        }
    return pixel_radii(gather_.points().download(), counts.download(), view_.camera().width, view_.camera().height);
}

double Renderer::radius_of(std::uint32_t pass) const {
    return pass_radius_mm(first_radius_mm_, scene_.render.alpha, pass);
}

void Renderer::render_pass(std::uint32_t pass) {
    const double radius_mm = radius_of(pass);
    pass_.make(pass, photons_);
    for (PhotonMap& map : maps_) map.clear();
    const PhotonAccount account = tracer_.trace(on_device_, pass_.buffers(), photons_, maps_);
    find_visible_points(view_.camera());
    if (!pass_.buffers().store_direct)
        gather_.add_direct_light(on_device_, seen_scene(), pass_.buffers().constants, film_);
    gather_maps(radius_mm);
    book_.add(account, image_weight_nm(scene_.render.lambda_min_nm, scene_.render.lambda_max_nm));
    ++passes_;
}

// What the camera's rays meet, at the end of all reflections; emitters among it are added to the film.
void Renderer::find_visible_points(const CameraRecord& camera) {
    view_.make_rays(camera, pass_.buffers().constants, camera_rays_);
    const RayScene& rays = on_device_.rays;
    const std::uint32_t count = view_.ray_count();
    trace_.launch(rays.kernels.packets ? (count + ray_packet - 1) / ray_packet : count, count, rays.nodes, rays.blocks,
                  rays.grid, camera_rays_, camera_hits_);
    if (on_device_.has_fresnel)
        trace_seen_.launch(count, camera, pass_.buffers().constants, rays.nodes, rays.blocks, rays.grid,
                           on_device_.triangles, on_device_.shapes, on_device_.materials, camera_rays_, camera_hits_);
    gather_.collect_points(seen_scene(), pass_.buffers().constants, camera_rays_, camera_hits_, film_);
}

GatherScene Renderer::seen_scene() const {
    return {on_device_.triangles, on_device_.shapes,        on_device_.materials, on_device_.lights,
            pass_.buffers().rows, pass_.buffers().radiance, on_device_.textures};
}

// Adds the photons to the film, map by map.
void Renderer::gather_maps(double radius_mm) {
    gather_.choose_radii();
    gather_.measure_disks(on_device_, pass_.buffers().constants, static_cast<float>(radius_mm));
    for (std::uint32_t m = 0; m < STOKES_MAP_COUNT; ++m) {
        const PhotonMap& map = maps_[m];
        if (map.used() == 0) continue;
        for (const float radius_class : gather_.radius_classes()) {
            hash_builder_.build(hash_, map.heads(), map.flux(), map.used(), on_device_.minimum_mm,
                                on_device_.maximum_mm, radius_class * static_cast<float>(radius_mm));
            gather_.add_map(m, radius_class, hash_, seen_scene(), pass_.buffers().constants, film_);
        }
    }
}

FilmImage Renderer::image() const {
    FilmImage image(scene_.film.width, scene_.film.height);
    const std::vector<FilmValue> sums = film_.download();
    const float share = passes_ > 0 ? 1.0f / static_cast<float>(passes_) : 0.0f;
    for (std::size_t c = 0; c < component_count; ++c)
        for (std::size_t i = 0; i < image.pixels(); ++i) {
            const FilmValue& sum = sums[c * image.pixels() + i];
            image.xyz[c][i * 3] = sum.x * share;
            image.xyz[c][i * 3 + 1] = sum.y * share;
            image.xyz[c][i * 3 + 2] = sum.z * share;
        }
    return image;
}

}  // namespace stokes
