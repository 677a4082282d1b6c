#include "host/render/renderer.hpp"

#include <algorithm>
#include <ctime>

#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/render/emission_seeds.hpp"
#include "host/render/emission_trial.hpp"
#include "host/render/local_radii.hpp"
#include "host/render/radius.hpp"
#include "host/render/wavelength_importance.hpp"

namespace stokes {

namespace {

// Index of the trial pass that finds the radius; no render reaches it.
constexpr std::uint32_t trial_pass = 0xffffffffu;

// Camera rays that tell which sides of shapes are seen; of more, every so many.
constexpr std::uint32_t most_side_rays = 1u << 18;

// Trial passes for the aiming of photons have the indices below, and together this many photons where that takes no
// more of them. The second half of them starts where the first half found that they should.
constexpr std::uint32_t least_trials = 4, most_trials = 32;
constexpr std::uint32_t all_trial_photons = 1u << 20, most_trial_photons = all_trial_photons / least_trials;

// Share of the photons that start as with stratified emission in the trials' second half, and in the render.
constexpr double uniform_share_of_trials = 0.3, uniform_share = 0.15;

// The partition of the lights is no finer than this, nor than so many photons of a pass to a cell.
constexpr std::uint32_t most_cells = 1024, photons_per_cell = 64;

// Photons of a trial pass, and how many of these there are.
std::uint32_t trial_photons(std::uint32_t photons) { return std::min(photons, most_trial_photons); }
std::uint32_t trial_count(std::uint32_t photons) {
    return std::clamp(all_trial_photons / trial_photons(photons), least_trials, most_trials);
}

// Cells of a partition for passes of so many photons.
std::size_t most_cells_of(std::uint32_t photons, std::size_t lights) {
    return std::clamp(photons / photons_per_cell, 1u, most_cells) + lights;
}

// Slots a map starts with; it grows with the first passes where that is too few.
std::uint32_t first_slots(std::uint32_t photons) { return photons + 1024; }

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
      hash_builder_(device, first_slots(photons_)),
      hash_(device, "photon map", first_slots(photons_)),
      photon_pass_(device, scene_, on_device_, photons_, first_slots(photons_), &hash_builder_, &hash_),
      view_(device, make_camera_record(scene.camera, scene.film.width, scene.film.height)),
      gather_(device, on_device_.rays.kernels, view_.camera()),
      camera_rays_(device, "camera rays", view_.ray_count()),
      camera_hits_(device, "camera hits", view_.ray_count()),
      film_(device, "film", std::vector<FilmValue>(layer_count * view_.ray_count(), FilmValue{0, 0, 0, 0})) {
    const RayKernels& kernels = on_device_.rays.kernels;
    trace_ = kernels.program(device, "trace_rays.cl").kernel(kernels.packets ? "trace_packets" : "trace_closest_all");
    if (on_device_.has_contested) settle_ = kernels.program(device, "settle_hits.cl").kernel("settle_hits");
    if (on_device_.has_mirrors)
        trace_reflections_ = kernels.program(device, "trace_reflections.cl").kernel("trace_reflections");
    const std::clock_t start = std::clock();
    set_up_passes();
    seen_sides_ = find_seen_sides();
    device_.finish();
    trials_processor_s_ = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    // The trials have added the emitters that their camera rays met.
    film_.upload(std::vector<FilmValue>(film_.size(), FilmValue{0, 0, 0, 0}));
    device_.reset_stage_times();
}

// Runs the trial passes. The first radius is that of photons that start at random and are all stored, so that it does
// not depend on how the scene is sampled; but where photons are aimed at a body that hardly one of those would find, it
// is that of photons that find it. Local radii are factors on this radius, also where the scene gives another;
// they come from photons as the scene samples them.
void Renderer::set_up_passes() {
    const ResolvedSettings render = resolved(scene_.render);
    const bool local = render.radii == Radii::local;
    std::vector<EmittingLight> lights = emitting_lights(scene_, on_device_);
    std::vector<EmissionSample> seeds;
    if (render.emission == Emission::aimed) seeds = emission_seeds(lights);
    double found_mm = 0.0;
    if (!render.radius_mm || local) {
        if (!seeds.empty())
            photon_pass_.inputs().set_emission(EmissionCells::seeded(
                lights, seeds, uniform_share_of_trials, most_cells_of(photons_, scene_.lights.size()), photons_));
        make_trial_photons(true);
        found_mm = find_first_radius();
    }
    first_radius_mm_ = render.radius_mm.value_or(found_mm);
    if (render.emission == Emission::stratified)
        photon_pass_.inputs().set_emission(EmissionCells::stratified(lights, photons_));
    if (render.emission == Emission::aimed) {
        try {
            photon_pass_.inputs().set_emission(aimed_cells(lights, seeds));
        } catch (const InputError& error) {  // no memory for the trials
            for (PhotonMap& map : photon_pass_.maps()) map.track_paths(false);
            warn(std::string("photons are spread evenly in place of aimed: ") + error.what());
            photon_pass_.inputs().set_emission(EmissionCells::stratified(lights, photons_));
        }
    }
    if (local) {
        make_trial_photons(false);
        gather_.set_radii(find_local_radii(found_mm));
    }
    photon_pass_.note_met_bodies();
}

// Traces the photons of a trial pass. They have the same flux at every wavelength, because a lamp of few wavelengths
// might be dark at all of those that were drawn. Each is stored once an event: copies in several places would count as
// photons that found their own way.
void Renderer::make_trial_photons(bool as_plain) {
    photon_pass_.prepare(trial_pass, photons_);
    photon_pass_.inputs().set_photon_flux(1.0f);
    PathSampling plain = photon_pass_.sampling();
    plain.both_branches = false;
    plain.many_exits = false;
    if (as_plain) {
        plain.weighted_distances = false;
        plain.store_direct = true;
    }
    photon_pass_.trace(plain);
}

// Camera rays go through the whole picture, so that a crop has the radius of the whole.
double Renderer::find_first_radius() {
    const CameraRecord whole = make_whole_record(scene_.camera, scene_.film.width, scene_.film.height);
    find_visible_points(whole);
    std::vector<PhotonHead> photons;
    for (const PhotonMap& map : photon_pass_.maps())
        for (const PhotonHead& head : map.heads().download(map.used())) photons.push_back(head);
    const double radius_mm = first_radius_mm(whole, gather_.points().download(), photons);
    return radius_mm > 0.0 ? radius_mm : spread_radius_mm(scene_, photons_);
}

// Where photons go to small bodies and to what the camera sees; none where even trial photons find all bodies. Gives
// the lights regions about the small bodies.
std::vector<EmissionSample> Renderer::emission_seeds(std::vector<EmittingLight>& lights) {
    EmissionSeeds seeds(device_, scene_, on_device_);
    const double first_half = 0.5 * trial_photons(photons_) * trial_count(photons_);
    const std::vector<std::vector<SeedPoint>> rare = rare_bodies(scene_, seeds, first_half);
    if (rare.empty()) return {};
    for (const std::vector<SeedPoint>& points : rare) seeds.add(points);
    seeds.set_regions(lights);
    photon_pass_.prepare(trial_pass, photons_);
    find_visible_points(view_.camera());
    seeds.add(visible_points(view_.camera(), gather_.points().download()));
    return seeds.samples();
}

// Runs trial passes that leave nothing in the film: what their photons bring to the picture says where more should
// start. Their wavelengths are drawn by importance, so that few passes suffice for all of the light.
// seeds: where the first half of the photons starts; none: evenly over the lights.
EmissionCells Renderer::aimed_cells(const std::vector<EmittingLight>& lights,
                                    const std::vector<EmissionSample>& seeds) {
    const RenderSettings& render = scene_.render;
    const std::uint32_t photons = trial_photons(photons_), trials = trial_count(photons_);
    const std::size_t trial_cells = most_cells_of(photons, lights.size());
    std::optional<StratifiedWavelengths> strata;
    if (render.lambda_max_nm - render.lambda_min_nm + 1 > STOKES_WAVELENGTHS)
        strata.emplace(render.lambda_min_nm, wavelength_importance(scene_));
    EmissionTrial trial(device_, photons);
    EmissionCells cells = EmissionCells::stratified(lights, photons);
    if (cells.records().empty()) return cells;
    if (!seeds.empty()) cells = EmissionCells::seeded(lights, seeds, uniform_share_of_trials, trial_cells, photons);
    for (PhotonMap& map : photon_pass_.maps()) map.track_paths(true);
    for (std::uint32_t i = 0; i < trials; ++i) {
        if (i == trials / 2)
            cells = EmissionCells::aimed(lights, trial.samples(), uniform_share_of_trials, trial_cells, photons);
        if (i == 0 || i == trials / 2) photon_pass_.inputs().set_emission(cells);
        const std::uint32_t pass = trial_pass - 1 - i;
        photon_pass_.prepare(strata ? strata->draw(render.seed, pass) : pass_wavelengths(render, pass), pass, photons);
        photon_pass_.trace();
        find_visible_points(view_.camera());
        trial.add(cells, photon_pass_.arguments(), photon_pass_.maps(), view_.camera(), gather_.points());
    }
    for (PhotonMap& map : photon_pass_.maps()) map.track_paths(false);
    return EmissionCells::aimed(lights, trial.samples(), uniform_share, most_cells_of(photons_, lights.size()),
                                photons_);
}

// Counts the photons about the points of this picture, which may be a crop: so a crop has the radii of its part of the
// whole.
std::vector<PixelRadius> Renderer::find_local_radii(double radius_mm) {
    find_visible_points(view_.camera());
    const Buffer<float> counts(device_, "photons about points",
                               std::vector<float>(std::size_t{count_levels} * view_.ray_count(), 0.0f));
    float counted_mm = least_count_factor * static_cast<float>(radius_mm);
    for (std::uint32_t level = 0; level < count_levels; ++level, counted_mm *= 2.0f)
        for (std::uint32_t m = 0; m < STOKES_MAP_COUNT; ++m) {
            const PhotonMap& map = photon_pass_.maps()[m];
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
    photon_pass_.prepare(pass, photons_);
    const PhotonAccount account = photon_pass_.trace();
    find_visible_points(view_.camera());
    if (!photon_pass_.sampling().store_direct) gather_.add_direct_light(photon_pass_.arguments(), film_);
    gather_maps(radius_of(pass));
    book_.add(account, image_weight_nm(scene_.render.lambda_min_nm, scene_.render.lambda_max_nm));
    ++passes_;
}

// Finds the points that the camera rays meet, at the end of all reflections, and adds emitters among them to the film.
void Renderer::find_visible_points(const CameraRecord& camera) {
    const Arguments common = photon_pass_.arguments();
    const Arguments rays = Arguments("rays", camera_rays_).add("hits", camera_hits_).add("n", view_.ray_count());
    const std::uint32_t count = view_.ray_count();
    view_.make_rays(camera, common, camera_rays_);
    trace_.launch(on_device_.rays.kernels.packets ? (count + ray_packet - 1) / ray_packet : count, common, rays);
    if (on_device_.has_contested) settle_.launch(count, common, rays);
    if (on_device_.has_mirrors) trace_reflections_.launch(count, common, rays, Arguments("camera", camera));
    gather_.collect_points(common, camera_rays_, camera_hits_, film_);
}

std::vector<SeenSides> Renderer::find_seen_sides() {
    photon_pass_.prepare(trial_pass, photons_);
    find_visible_points(view_.camera());
    const Buffer<std::uint32_t> counts(device_, "sides of shapes",
                                       std::vector<std::uint32_t>(2 * scene_.shapes.size(), 0));
    const std::uint32_t n = view_.ray_count(), stride = (n + most_side_rays - 1) / most_side_rays;
    Program(device_, "count_sides.cl")
        .kernel("count_sides")
        .launch((n + stride - 1) / stride, photon_pass_.arguments(),
                Arguments("n", n)
                    .add("stride", stride)
                    .add("rays", camera_rays_)
                    .add("hits", camera_hits_)
                    .add("side_counts", counts));
    const std::vector<std::uint32_t> found = counts.download();
    std::vector<SeenSides> sides(scene_.shapes.size());
    for (std::size_t i = 0; i < sides.size(); ++i) sides[i] = {found[2 * i], found[2 * i + 1]};
    return sides;
}

// Adds the photons to the film, map by map: each map is sorted for the radii of the points, and summed about them.
void Renderer::gather_maps(double radius_mm) {
    const Arguments common = photon_pass_.arguments();
    gather_.choose_radii();
    gather_.measure_disks(common, static_cast<float>(radius_mm));
    for (std::uint32_t m = 0; m < STOKES_MAP_COUNT; ++m) {
        const PhotonMap& map = photon_pass_.maps()[m];
        if (map.used() == 0) continue;
        for (const float radius_class : gather_.radius_classes()) {
            hash_builder_.build(hash_, map.heads(), map.flux(), map.used(), on_device_.minimum_mm,
                                on_device_.maximum_mm, radius_class * static_cast<float>(radius_mm));
            gather_.add_map(common, m, radius_class, hash_, film_);
        }
    }
}

FilmImage Renderer::image() const {
    FilmImage image(scene_.film.width, scene_.film.height);
    const std::vector<FilmValue> sums = film_.download();
    const float share = passes_ > 0 ? 1.0f / static_cast<float>(passes_) : 0.0f;
    for (std::size_t c = 0; c < layer_count; ++c)
        for (std::size_t i = 0; i < image.pixels(); ++i) {
            const FilmValue& sum = sums[c * image.pixels() + i];
            image.xyz[c][i * 3] = sum.x * share;
            image.xyz[c][i * 3 + 1] = sum.y * share;
            image.xyz[c][i * 3 + 2] = sum.z * share;
        }
    return image;
}

}  // namespace stokes
