#include "host/render/emission_trial.hpp"

#include <algorithm>

#include "host/render/device_lights.hpp"

namespace stokes {

std::vector<EmittingLight> emitting_lights(const Scene& scene, const DeviceScene& on_device) {
    std::vector<EmittingLight> lights;
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        lights.push_back({on_device.light_probability[i], place_dimensions(scene.lights[i])});
    return lights;
}

EmissionTrial::EmissionTrial(const Device& device, std::uint32_t photons)
    : device_(device),
      photons_(photons),
      find_places_(Program(device, "emit_photons.cl").kernel("find_places")),
      score_photons_(Program(device, "score_photons.cl").kernel("score_photons")),
      cells_(device, "emission cells of trial paths", photons),
      places_(device, "emission places of trial paths", photons) {}

void EmissionTrial::add(const EmissionCells& cells, const Arguments& common, const PhotonMaps& maps,
                        const CameraRecord& camera, const Buffer<GatherPoint>& points) {
    find_places_.launch(photons_, common, Arguments("cell_of_path", cells_).add("places", places_, "float4"));
    const std::vector<double> scores = path_scores(common, maps, camera, points);
    const std::vector<std::uint32_t> cell = cells_.download();
    const std::vector<Place> places = places_.download();
    std::vector<double> count(cells.records().size(), 0.0);
    for (const std::uint32_t c : cell) count[c] += 1.0;
    for (std::uint32_t path = 0; path < photons_; ++path) {
        const EmissionCell& record = cells.records()[cell[path]];
        EmissionSample sample;
        sample.light = record.light;
        std::copy(std::begin(places[path].at), std::end(places[path].at), sample.place.begin());
        // A photon of weight w has w times the flux, and stands for w photons.
        sample.square = scores[path] / (static_cast<double>(record.probability) * photons_ / count[cell[path]]);
        samples_.push_back(sample);
    }
    ++passes_;
}

// Of all that each path stored.
std::vector<double> EmissionTrial::path_scores(const Arguments& common, const PhotonMaps& maps,
                                               const CameraRecord& camera, const Buffer<GatherPoint>& points) {
    std::vector<double> scores(photons_, 0.0);
    for (std::uint32_t m = 0; m < maps.size(); ++m) {
        const std::uint32_t slots = maps[m].used();
        if (slots == 0) continue;
        if (scores_.size() < slots) scores_ = Buffer<float>(device_, "scores of trial photons", slots);
        score_photons_.launch(slots, common, maps[m].arguments(),
                              Arguments("slots", slots)
                                  .add("map", m)
                                  .add("camera", camera)
                                  .add("gather_points", points)
                                  .add("scores", scores_));
        const std::vector<float> of_slot = scores_.download(slots);
        const std::vector<std::uint32_t> path = maps[m].paths().download(slots);
        for (std::uint32_t slot = 0; slot < slots; ++slot)
            if (of_slot[slot] > 0.0f) scores[path[slot]] += static_cast<double>(of_slot[slot]);
    }
    return scores;
}

std::vector<EmissionSample> EmissionTrial::samples() const {
    std::vector<EmissionSample> result = samples_;
    const double share = passes_ > 0 ? 1.0 / (static_cast<double>(photons_) * passes_) : 0.0;
    for (EmissionSample& sample : result) sample.square *= share;
    return result;
}

}  // namespace stokes
