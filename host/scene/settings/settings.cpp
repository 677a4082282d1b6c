#include "host/scene/settings/settings.hpp"

#include <limits>
#include <utility>

#include "host/scene/settings/setting_row.hpp"

namespace stokes {
namespace {

using Given = RenderSettings;
using Resolved = ResolvedSettings;

constexpr IntegerRange lambda_range{first_lambda_nm, last_lambda_nm};
constexpr IntegerRange pixel_range{1, 16384};
constexpr Transport paper = Transport::paper, conserving = Transport::conserving, walk = Transport::walk;

template <class Enum>
OneWord one_word() {
    return {words_of<Enum>};
}

SettingTraits only(std::vector<Transport> transports) { return {std::move(transports), false, false, {}}; }

SettingTraits sampler(std::vector<Transport> transports = all_transports, bool needs_tables = false) {
    return {std::move(transports), needs_tables, true, {}};
}

SettingTraits found(std::string how) { return {all_transports, false, false, std::move(how)}; }

bool plain(const Resolved& s) { return s.sampling == Sampling::plain; }

std::vector<Setting> make_settings() {
    return {
        row(&Given::transport, &Resolved::transport,
            {"", "transport", "--transport,--model", one_word<Transport>(),
             "How light travels below translucent surfaces: by the source paper's tables, by tables that conserve "
             "energy, or step by step, slowly, through closed meshes and below flat sheets"}),
        row(&Given::sampling, &Resolved::sampling,
            {"render", "sampling", "--sampling", one_word<Sampling>(),
             "Which samplers are used where they are not named one by one: plain ones, or those with the least noise; "
             "the means are the same"}),
        row(&Given::passes, &Resolved::passes,
            {"render", "passes", "--passes", IntegerRange{1, 100'000'000}, "Passes, whose mean is the picture"}),
        row(&Given::photons_per_pass, &Resolved::photons_per_pass,
            {"render", "photons_per_pass", "--photons", IntegerRange{1, most_photons_per_pass},
             "Photons that leave the lights in each pass"}),
        row(&Given::seed, &Resolved::seed,
            {"render", "seed", "--seed", IntegerRange{0, std::numeric_limits<std::uint32_t>::max()},
             "Seed of the random numbers"}),
        row(&Given::alpha, &Resolved::alpha,
            {"render", "alpha", "--alpha", NumberRange{0.0, 1.0, true},
             "How slowly the radius of the density estimate shrinks from pass to pass; 1 keeps it"}),
        row(&Given::radius_mm, &Resolved::radius_mm,
            {"render", "radius_mm", "--radius", length_range, "Radius of the density estimate in the first pass [mm]",
             found("derived from the scene")}),
        row(&Given::lambda_min_nm, &Resolved::lambda_min_nm,
            {"render", "lambda_min_nm", "--lambda-min", lambda_range, "First wavelength [nm]"}),
        row(&Given::lambda_max_nm, &Resolved::lambda_max_nm,
            {"render", "lambda_max_nm", "--lambda-max", lambda_range, "Last wavelength [nm], itself included"}),
        row(&Given::tables, &Resolved::tables,
            {"render", "tables", "--tables,!--no-tables", YesNo{},
             "Whether light below surfaces is looked up in power tables, or every photon integrates its own",
             only({paper})},
            [](const Resolved& s) { return s.transport != walk; }),
        row(&Given::first_collision_only, &Resolved::first_collision_only,
            {"render", "first_collision_only", "--first-collision,!--no-first-collision", YesNo{},
             "Whether fluorophores take light up at its first collision only, as the other transports have it",
             only({walk})},
            [](const Resolved&) { return false; }),
        row(&Given::wavelengths, &Resolved::wavelengths,
            {"render", "wavelengths", "--wavelengths", one_word<Wavelengths>(),
             "How each pass draws its wavelengths: evenly, or where lamps, fluorophores and the eye have most",
             sampler()},
            [](const Resolved& s) {
                return plain(s) || s.transport == paper ? Wavelengths::uniform : Wavelengths::importance;
            }),
        row(&Given::branches, &Resolved::branches,
            {"render", "branches", "--branches", one_word<Branches>(),
             "What a photon stores where it enters a translucent material: light of one branch, drawn, or of both, "
             "fluorescence and elastic scattering",
             sampler({paper, conserving})},
            [](const Resolved& s) {
                return plain(s) || s.transport != conserving ? Branches::roulette : Branches::both;
            }),
        row(&Given::distances, &Resolved::distances,
            {"render", "distances", "--distances", one_word<Distances>(),
             "How far from its entry light leaves: drawn from the power table as the paper has it, or where more of it "
             "leaves, with the same mean",
             sampler({paper}, true)},
            [](const Resolved& s) {
                return plain(s) || s.transport != paper || !s.tables ? Distances::table : Distances::importance;
            }),
        row(&Given::exits, &Resolved::exits,
            {"render", "exits", "--exits", IntegerRange{1, 64},
             "Exit points at which each photon that enters a translucent material is stored, per component; more pay "
             "in close-ups of such materials",
             sampler({conserving})},
            [](const Resolved&) { return 1; }),
        row(&Given::emission, &Resolved::emission,
            {"render", "emission", "--emission", one_word<Emission>(),
             "Where photons start: anywhere on the lights at random, evenly spread over them, or aimed, evenly spread "
             "and most where a trial pass found that the camera sees their light; unless at random, the exits of "
             "their first event are spread evenly too",
             sampler()},
            [](const Resolved& s) { return plain(s) ? Emission::random : Emission::aimed; }),
        row(&Given::direct, &Resolved::direct,
            {"render", "direct", "--direct", one_word<Direct>(),
             "Light that falls straight from the lights onto diffuse surfaces: from the photons stored there, or by "
             "shadow rays from what the camera sees, free of the photons' noise and blur",
             sampler()},
            [](const Resolved& s) { return plain(s) ? Direct::photons : Direct::rays; }),
        row(&Given::radii, &Resolved::radii,
            {"render", "radii", "--radii", one_word<Radii>(),
             "The radius of the density estimate: one for the whole picture, or local, up to four times as large where "
             "a trial pass found few photons, pixel by pixel",
             sampler()},
            [](const Resolved&) { return Radii::one; }),
        row(&Film::width, {"film", "width", "--width", pixel_range, "Width of the picture in pixels"}),
        row(&Film::height, {"film", "height", "--height", pixel_range, "Height of the picture in pixels"}),
        row(&Film::exposure_ev, {"film", "exposure_ev", "--exposure", NumberOrAuto{{-100.0, 100.0}},
                                 "Exposure of the PNG in stops", found("auto")}),
    };
}

}  // namespace

const std::vector<Setting>& settings() {
    static const std::vector<Setting> rows = make_settings();
    return rows;
}

ResolvedSettings resolved(const RenderSettings& given) {
    ResolvedSettings result;
    for (const Setting& setting : settings()) setting.resolve(given, result);
    return result;
}

}  // namespace stokes
