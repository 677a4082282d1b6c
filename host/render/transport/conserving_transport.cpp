#include "host/render/transport/conserving_transport.hpp"

#include <algorithm>
#include <limits>

#include "host/render/device_materials.hpp"
#include "host/render/transport/green_walk.hpp"
#include "host/render/transport/transport_model.hpp"

namespace stokes {

namespace {

GreenResampler::Sixteen sixteen(const Flux16& row) {
    GreenResampler::Sixteen result;
    std::copy(std::begin(row.v), std::end(row.v), result.begin());
    return result;
}

// Smallest and largest extinction coefficient over the render's wavelengths [1/mm].
struct Extinction {
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
};

Extinction extinction_of(const Medium& medium, const RenderSettings& render) {
    Extinction result;
    for (int lambda = render.lambda_min_nm; lambda <= render.lambda_max_nm; ++lambda) {
        const double sigma_t = medium.sigma_s.at(lambda) + medium.sigma_a.at(lambda);
        result.least = std::min(result.least, sigma_t);
        result.most = std::max(result.most, sigma_t);
    }
    return result;
}

}  // namespace

ConservingTransport::ConservingTransport(const Device& device, const Scene& scene, const DeviceScene& on_device)
    : ExitTransport(device, STOKES_TRANSPORT_CONSERVING, settings_of(scene.render, Transport::conserving).exits),
      scene_(scene) {
    fold_exits_ = on_device.rays.kernels.program(device, "fold_exits.cl").kernel("fold_exits");
    retrace_exits_ = Program(device, "retrace_subsurface.cl").kernel("retrace_exits");
    reserve_tables(device, scene);
}

// A table for each medium that some material has, and for each kind of surface it has it under.
void ConservingTransport::reserve_tables(const Device& device, const Scene& scene) {
    std::vector<TableShape> shapes(std::max<std::size_t>(6 * scene.media.size(), 1), TableShape{});
    std::map<double, GreenTable> universal;
    std::size_t entries = 0, rows = 0;
    const std::vector<MaterialUse> uses = material_uses(scene);
    for (std::size_t m = 0; m < scene.media.size(); ++m) {
        const Medium& medium = scene.media[m];
        const Extinction sigma_t = extinction_of(medium, scene.render);
        for (const bool fresnel : {false, true}) {
            const auto owned = [&](const MaterialUse& use) {
                const Material& material = scene.materials[static_cast<std::size_t>(use.material)];
                return use.transport == Transport::conserving && medium_of(material) == static_cast<int>(m) &&
                       reflects(material, use.transport) == fresnel;
            };
            if (std::none_of(uses.begin(), uses.end(), owned)) continue;
            Owner owner{static_cast<int>(m), fresnel ? medium.eta : 1.0, rows, {}};
            if (universal.count(owner.eta) == 0) universal[owner.eta] = green_table_for(device, owner.eta);
            owner.shape = green_medium_shape(universal[owner.eta], sigma_t.least, sigma_t.most, entries);
            entries += std::size_t{owner.shape.row_count} * owner.shape.r_count;
            rows += owner.shape.row_count;
            for (std::size_t component = 0; component < 3; ++component)
                shapes[3 * (2 * m + (fresnel ? 1 : 0)) + component] = owner.shape;
            owners_.push_back(owner);
        }
    }
    for (const auto& [eta, table] : universal) resamplers_[eta] = std::make_unique<GreenResampler>(device, table);
    entries = std::max<std::size_t>(entries, 1);
    shapes_ = Buffer<TableShape>(device, "power table shapes", shapes);
    tables_ = {Buffer<Flux16>(device, "power tables of the pass", entries),
               Buffer<Flux16>(device, "probabilities of escape", rows),
               Buffer<float>(device, "distance densities", entries),
               Buffer<float>(device, "distance distributions", entries)};
}

void ConservingTransport::prepare(const PassSpectra& spectra) {
    const SpectraLayout layout(scene_);
    for (const Owner& owner : owners_) {
        const std::uint32_t row = layout.sigma_row(owner.medium);
        resamplers_.at(owner.eta)->resample(owner.shape, owner.first_row, sixteen(spectra.rows[row]),
                                            sixteen(spectra.rows[row + 1]), tables_);
    }
}

std::vector<ExitTransport::ExitGroup> ConservingTransport::fluorescent_exits() const {
    return {{STOKES_MAP_FLUORESCENCE, STOKES_SAMPLER_DIRECT}, {STOKES_MAP_FLUORESCENCE, STOKES_SAMPLER_SCATTERED}};
}

std::vector<ExitTransport::ExitGroup> ConservingTransport::elastic_exits() const {
    return {{STOKES_MAP_SINGLE, STOKES_SAMPLER_DIRECT}, {STOKES_MAP_MULTIPLE, STOKES_SAMPLER_SCATTERED}};
}

Arguments ConservingTransport::tables() const {
    return Arguments("table_shapes", shapes_)
        .add("table16", tables_.table16)
        .add("mean_rows", tables_.mean_rows)
        .add("cumulative_rows", tables_.cumulative_rows);
}

// Exits beyond an edge are folded round it.
void ConservingTransport::mend_exits(const SubsurfaceEvent& event, std::uint32_t count) {
    if (owners_.empty()) return;
    fold_exits_.launch(count, Arguments("count", count), event.common, event.exits.arguments());
}

void ConservingTransport::retrace(const SubsurfaceEvent& event, const std::vector<EventRound>& rounds) {
    ExitGroups groups{};
    groups.count = static_cast<std::uint32_t>(rounds.size());
    for (std::size_t g = 0; g < rounds.size(); ++g) {
        groups.component[g] = rounds[g].component;
        groups.first_exit[g] = rounds[g].first_exit;
    }
    const EventRound& round = rounds.front();
    retrace_exits_.launch(round.count, Arguments("round", round).add("groups", groups), event.common,
                          event.exits.arguments());
}

}  // namespace stokes
