#include "host/commands/probe_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "host/core/json_text.hpp"

namespace stokes {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, probe_component_count> names = {"specular", "single", "multiple", "fluorescence",
                                                                  "total"};

const std::string& model_of(const ProbeSettings& settings) { return word_of(settings.transport); }

std::string share_line(const char* name, const Measured& m, const char* unit = "") {
    return fmt::format("  {:<22}{:>9.5f} +- {:.5f}{}\n", name, m.value, m.standard_error, unit);
}

std::string spectrum_table(const ProbeResult& result) {
    std::string text;
    for (std::size_t i = 0; i < result.lambda_nm.size(); ++i) {
        const Measured& m = result.reflectance[probe_fluorescence][i];
        if (m.value != 0.0)
            text += fmt::format("  {:>8}  {:>12.4e} +- {:.1e}\n", result.lambda_nm[i], m.value, m.standard_error);
    }
    return text.empty() ? text : "\nfluorescence [1/nm] by wavelength [nm]\n" + text;
}

std::string radial_table(const ProbeResult& result) {
    std::string text =
        fmt::format("\nexitance [1/mm^2] by distance from the beam [mm]\n  {:>10}  {:>10}", "from", "to");
    for (const std::size_t c : {probe_single, probe_multiple, probe_fluorescence, probe_total})
        text += fmt::format("  {:>12}", names[c]);
    text += "\n";
    for (std::size_t bin = 0; bin + 1 < result.r_mm.size(); ++bin) {
        const Measured& total = result.radial[probe_total][bin];
        if (total.value == 0.0) continue;
        text += fmt::format("  {:>10.4g}  {:>10.4g}", result.r_mm[bin], result.r_mm[bin + 1]);
        for (const std::size_t c : {probe_single, probe_multiple, probe_fluorescence})
            text += fmt::format("  {:>12.4e}", result.radial[c][bin].value);
        text += fmt::format("  {:>12.4e} +- {:.1e}\n", total.value, total.standard_error);
    }
    return text;
}

Json part_of(const Measured& m, double Measured::*part) { return m.*part; }

Json part_of(const std::vector<Measured>& list, double Measured::*part) {
    Json values = Json::array();
    for (const Measured& m : list) values.push_back(m.*part);
    return values;
}

// Adds every component from the first one on: of each measurement its value or its standard error.
template <class Measurements>
Json by_component(const Measurements& measurements, double Measured::*part, std::size_t first = probe_specular,
                  Json members = Json::object()) {
    for (std::size_t c = first; c < probe_component_count; ++c) members[names[c]] = part_of(measurements[c], part);
    return members;
}

}  // namespace

std::string probe_table(const ProbeResult& result, const ProbeMaterial& material, const ProbeSettings& settings) {
    std::string text =
        fmt::format("{}, {}{}: {} nm at {:g} deg, {} photons for each of {} set{} of wavelengths\n\n", material.name,
                    model_of(settings), settings.first_collision_only ? " (first collision)" : "", result.lambda_ex_nm,
                    settings.angle_deg, result.photons, result.sets, result.sets == 1 ? "" : "s");
    text += "energy leaving per energy arriving\n";
    for (std::size_t c = 0; c < probe_component_count; ++c) text += share_line(names[c], result.totals[c]);
    const auto& emission = result.reflectance[probe_fluorescence];
    const auto brightest = std::max_element(emission.begin(), emission.end(),
                                            [](const auto& a, const auto& b) { return a.value < b.value; });
    if (brightest->value > 0.0) {
        text += share_line("fluorescence", result.emitted_photons, " photons leaving per photon arriving");
        text += share_line(
            "brightest", *brightest,
            fmt::format(" per nm, at {} nm", result.lambda_nm[static_cast<std::size_t>(brightest - emission.begin())])
                .c_str());
    }
    return text + spectrum_table(result) + radial_table(result);
}

std::string probe_json(const ProbeResult& result, const ProbeMaterial& material, const ProbeSettings& settings) {
    constexpr auto value = &Measured::value, error = &Measured::standard_error;
    return json_text({
        {"model", model_of(settings)},
        {"first_collision", settings.first_collision_only},
        {"material", material.name},
        {"lambda_ex_nm", result.lambda_ex_nm},
        {"angle_deg", settings.angle_deg},
        {"photons", result.photons},
        {"wavelength_sets", result.sets},
        {"batches", result.batches},
        {"seed", settings.seed},
        {"step_nm", settings.step_nm},
        {"lambda_nm", result.lambda_nm},
        {"reflectance", by_component(result.reflectance, value)},
        {"standard_error", by_component(result.reflectance, error)},
        {"totals", by_component(result.totals, value)},
        {"totals_standard_error", by_component(result.totals, error)},
        {"emitted_photons", result.emitted_photons.value},
        {"emitted_photons_standard_error", result.emitted_photons.standard_error},
        {"radial", by_component(result.radial, value, probe_single, {{"r_mm", result.r_mm}})},
        {"radial_standard_error", by_component(result.radial, error, probe_single)},
        {"beyond", by_component(result.beyond, value, probe_single)},
        {"dropped", result.dropped},
    });
}

std::string probe_matrix_csv(const std::vector<ProbeResult>& results, const ProbeMaterial& material,
                             const ProbeSettings& settings) {
    std::string text = fmt::format(
        "# Effective re-radiation matrix of {}: stokes probe, model {}{}, angle of incidence {:g} deg,\n"
        "# {} photons for each excitation and set of wavelengths, seed {}.\n"
        "# A row is an excitation wavelength. elastic: energy leaving at that wavelength per energy arriving "
        "(specular,\n"
        "# single and multiple scattering); the columns after it: fluorescence at their wavelength [nm], "
        "energy leaving\n"
        "# per nm and per energy arriving [1/nm].\n",
        material.name, model_of(settings), settings.first_collision_only ? " (first collision)" : "",
        settings.angle_deg, results.front().photons, settings.seed);
    text += "lambda_ex_nm,elastic";
    for (const int lambda : results.front().lambda_nm) text += fmt::format(",{}", lambda);
    text += "\n";
    for (const ProbeResult& result : results) {
        const double elastic = result.totals[probe_specular].value + result.totals[probe_single].value +
                               result.totals[probe_multiple].value;
        text += fmt::format("{},{:.6g}", result.lambda_ex_nm, elastic);
        for (const Measured& m : result.reflectance[probe_fluorescence]) text += fmt::format(",{:.6g}", m.value);
        text += "\n";
    }
    return text;
}

}  // namespace stokes
