#include "host/render/transport/paper_transport.hpp"

#include "host/render/transport/transport_model.hpp"
#include "host/subsurface/distance_mixture.hpp"
#include "host/subsurface/distance_sampler.hpp"
#include "host/subsurface/paper_transport.hpp"

namespace stokes {

namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
    to.insert(to.end(), more.begin(), more.end());
}

// By index of Scene::media: some material has it below its surface, in a body of this transport.
std::vector<bool> needed_media(const Scene& scene) {
    std::vector<bool> needed(scene.media.size(), false);
    for (const MaterialUse& use : material_uses(scene))
        if (const auto medium = medium_of(scene.materials[static_cast<std::size_t>(use.material)]))
            if (use.transport == Transport::paper) needed[static_cast<std::size_t>(*medium)] = true;
    return needed;
}

MediumSpectra spectra_of(const Medium& medium) {
    return {medium.name, medium.sigma_s, medium.sigma_a, medium.eta, medium.dipole_eta};
}

}  // namespace

PaperTransport::PaperTransport(const Device& device, const Scene& scene)
    : ExitTransport(device, STOKES_TRANSPORT_PAPER, 1),
      device_(device),
      scene_(scene),
      integrates_(!settings_of(scene.render, Transport::paper).tables),
      weighted_(settings_of(scene.render, Transport::paper).distances == Distances::importance),
      wavelengths_(device, "wavelengths of the pass", STOKES_WAVELENGTHS) {
    const Program going_on(device, "retrace_subsurface.cl");
    retrace_fluorescence_ = going_on.kernel("retrace_fluorescence");
    retrace_elastic_ = going_on.kernel("retrace_elastic");
    if (integrates_)
        make_mixtures();
    else
        make_tables();
}

void PaperTransport::make_mixtures() {
    const Program program(device_, "integrate_power.cl");
    draw_exits_ = program.kernel("draw_exits");
    integrate_ = program.kernel("integrate_power");
    const std::vector<bool> needed = needed_media(scene_);
    std::vector<DistanceMixture> mixtures(scene_.media.size());
    std::vector<float> rows;
    for (std::size_t m = 0; m < scene_.media.size(); ++m) {
        if (!needed[m]) continue;
        const MediumMixture mixture = make_medium_mixture(spectra_of(scene_.media[m]), rows.size());
        mixtures[m] = mixture.record;
        append(rows, mixture.rows);
    }
    mixtures_ = Buffer<DistanceMixture>(device_, "distance mixtures", mixtures);
    mixture_rows_ = Buffer<float>(device_, "distance mixture rows", rows);
    media_ = Buffer<PassMedium>(device_, "media of the pass", scene_.media.size());
    shapes_ = Buffer<TableShape>(device_, "power table shapes", 1);
    mean_rows_ = cumulative_rows_ = Buffer<float>(device_, "distance densities", 1);
}

void PaperTransport::make_tables() {
    resample_ = Program(device_, "resample_tables.cl").kernel("resample_table");
    const std::vector<bool> needed = needed_media(scene_);
    std::vector<TableShape> shapes;
    std::vector<float> values, mean_rows, cumulative_rows, weighted, weighted_cumulative;
    for (std::size_t m = 0; m < scene_.media.size(); ++m) {
        if (!needed[m]) {
            shapes.insert(shapes.end(), 3, TableShape{});
            continue;
        }
        const MediumSpectra spectra = spectra_of(scene_.media[m]);
        for (const PowerTable& table :
             {make_fluorescence_table(spectra), make_single_table(spectra), make_multiple_table(spectra)}) {
            const DistanceSampler sampler = make_distance_sampler(table, mean_rows.size());
            lambda_ = device_wavelengths(table);
            shapes.push_back(sampler.shape);
            append(values, device_layout(table));
            append(mean_rows, sampler.mean_rows);
            append(cumulative_rows, sampler.cumulative_rows);
            append(weighted, sampler.weighted_rows);
            append(weighted_cumulative, sampler.weighted_cumulative_rows);
        }
    }
    entries_ = static_cast<std::uint32_t>(mean_rows.size());
    append(mean_rows, weighted);
    append(cumulative_rows, weighted_cumulative);
    shapes_ = Buffer<TableShape>(device_, "power table shapes", shapes);
    values_ = Buffer<float>(device_, "power tables", values);
    mean_rows_ = Buffer<float>(device_, "distance densities", mean_rows);
    cumulative_rows_ = Buffer<float>(device_, "distance distributions", cumulative_rows);
    at_wavelengths_ = Buffer<Flux16>(device_, "power tables of the pass", entries_);
}

void PaperTransport::prepare(const PassSpectra& spectra) {
    const auto& lambda_nm = spectra.constants.lambda_nm;
    if (integrates_) {
        std::vector<PassMedium> media(scene_.media.size(), PassMedium{});
        for (std::size_t m = 0; m < media.size(); ++m) {
            const Medium& medium = scene_.media[m];
            for (std::size_t i = 0; i < STOKES_WAVELENGTHS; ++i) {
                media[m].sigma_s[i] = static_cast<float>(medium.sigma_s.at(static_cast<double>(lambda_nm[i])));
                media[m].sigma_a[i] = static_cast<float>(medium.sigma_a.at(static_cast<double>(lambda_nm[i])));
            }
            media[m].dipole_a = static_cast<float>(dipole_boundary(medium.dipole_eta));
        }
        media_.upload(media);
        return;
    }
    wavelengths_.upload(lambda_nm, STOKES_WAVELENGTHS);
    resample_.launch(entries_, Arguments("count", entries_)
                                   .add("full", values_)
                                   .add("n_lambda", static_cast<std::uint32_t>(lambda_.count))
                                   .add("lambda_first_nm", static_cast<float>(lambda_.first))
                                   .add("lambda_step_nm", static_cast<float>(lambda_.step))
                                   .add("lambda_nm16", wavelengths_)
                                   .add("table16", at_wavelengths_));
}

std::vector<ExitTransport::ExitGroup> PaperTransport::fluorescent_exits() const {
    return {{STOKES_MAP_FLUORESCENCE, sampler()}};
}

std::vector<ExitTransport::ExitGroup> PaperTransport::elastic_exits() const {
    return {{STOKES_MAP_SINGLE, sampler()}, {STOKES_MAP_MULTIPLE, sampler()}};
}

Arguments PaperTransport::tables() const {
    return Arguments("table_shapes", shapes_)
        .add("table16", at_wavelengths_)
        .add("mean_rows", mean_rows_)
        .add("cumulative_rows", cumulative_rows_);
}

std::uint32_t PaperTransport::drawn_rows(const PathSampling& sampling) const {
    return weighted_ && sampling.weighted_distances ? entries_ : 0;
}

void PaperTransport::sample(const SubsurfaceEvent& event, const EventRound& round) {
    if (!integrates_) return ExitTransport::sample(event, round);
    if (at_wavelengths_.size() < event.exits.size())
        at_wavelengths_ = Buffer<Flux16>(device_, "powers at exits", event.exits.size());
    const Arguments own = Arguments("mixtures", mixtures_)
                              .add("mix_rows", mixture_rows_)
                              .add("media", media_)
                              .add("exit_powers", at_wavelengths_);
    draw_exits_.launch(round.count, Arguments("round", round), event.common, own, event.exits.arguments());
    integrate_.launch(round.count, Arguments("round", round), event.common, own, event.exits.arguments());
}

// STEP 4: fluorescence goes on with the flux that left, elastic light as single or as multiple scattering.
void PaperTransport::retrace(const SubsurfaceEvent& event, const std::vector<EventRound>& rounds) {
    for (std::size_t i = 0; i < rounds.size(); ++i) {
        EventRound round = rounds[i];
        if (round.component == STOKES_MAP_FLUORESCENCE)
            retrace_fluorescence_.launch(round.count, Arguments("round", round), event.common, event.exits.arguments());
        if (round.component != STOKES_MAP_SINGLE) continue;
        round.second_exit = rounds[i + 1].first_exit;
        retrace_elastic_.launch(round.count, Arguments("round", round), event.common, event.exits.arguments());
    }
}

}  // namespace stokes
