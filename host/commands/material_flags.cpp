#include "host/commands/material_flags.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <system_error>
#include <vector>

#include "host/commands/number_in.hpp"
#include "host/core/csv_headings.hpp"
#include "host/core/csv_spectrum.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/media_limits.hpp"
#include "host/core/text_input.hpp"
#include "host/scene/settings/domain.hpp"

namespace stokes {

namespace {

const char* const material_flags[] = {"--sigma-s",     "--sigma-a",         "--eta",      "--fresnel",
                                      "--fraction",    "--excitation",      "--emission", "--quantum-yield",
                                      "--stokes-rule", "--wavelength-unit", "--per",      "--negative"};
const char* const spectrum_type = "NUMBER|FILE.csv[:COLUMN]";

bool is_density(std::string_view flag) { return flag == "--emission"; }

SampleRules rules_of(const char* flag, const MaterialFlags& flags) {
    SampleRules rules;
    rules.unit = value_of_word<WavelengthUnit>(flags.wavelength_unit);
    if (is_density(flag)) rules.per = value_of_word<Per>(flags.per);
    rules.negative = value_of_word<Negative>(flags.negative);
    return rules;
}

void warn_of_headings(std::string_view flag, const CsvTable& table, std::size_t column) {
    const std::string& name = table.columns[column];
    if (const std::string said = percent_above(table, column); flag == "--excitation" && !said.empty())
        warn(fmt::format("{}: {}", flag, doubt_of_percent(name, said)));
    if (const std::string said = per_cm_above(table, column); flag.rfind("--sigma", 0) == 0 && !said.empty())
        warn(fmt::format("{}: {}", flag, doubt_of_per_cm(name, said)));
}

// FILE, or FILE:COLUMN where there is no file of the whole name; without a column the first after the
// wavelengths.
Spectrum csv_column_of(const char* flag, const std::string& text, Outside outside, const SampleRules& rules) {
    std::error_code ignored;
    const std::size_t colon = text.rfind(':');
    const bool named = colon != std::string::npos && !std::filesystem::exists(text, ignored);
    const CsvTable table = read_csv(named ? text.substr(0, colon) : text);
    const std::string column = named ? text.substr(colon + 1) : "2";
    ColumnSpectrum read = read_column(table, column, outside, rules);
    for (const std::string& remark : read.remarks) warn(fmt::format("{}: {}", flag, remark));
    warn_of_headings(flag, table, csv_column(table, column));
    if (is_density(flag) && !read.density_doubt.empty()) warn(fmt::format("{}: {}", flag, read.density_doubt));
    return std::move(read.spectrum);
}

// As given, not yet at whole nanometres.
Spectrum spectrum_of(const char* flag, const std::string& text, Outside outside, double maximum,
                     const MaterialFlags& flags) {
    const auto number = parse_double(text);
    Spectrum spectrum;
    if (number) {
        spectrum = Spectrum::constant(*number);
    } else {
        try {
            spectrum = csv_column_of(flag, text, outside, rules_of(flag, flags));
        } catch (const InputError& error) {
            throw InputError(fmt::format("{}: {}", flag, error.what()));
        }
    }
    for (const double value : spectrum.value)
        if (!(value >= 0.0 && value <= maximum))
            throw InputError(fmt::format("{}: expected {} in [0, {:g}], got {}", flag, number ? "a number" : "values",
                                         maximum, value));
    return spectrum;
}

Medium medium_of(const MaterialFlags& flags) {
    Medium medium;
    medium.name = "command line";
    medium.sigma_s =
        spectrum_of("--sigma-s", flags.sigma_s, Outside::hold, largest_spectrum_value, flags).at_whole_nanometres();
    medium.sigma_a =
        spectrum_of("--sigma-a", flags.sigma_a, Outside::hold, largest_spectrum_value, flags).at_whole_nanometres();
    medium.eta = flags.eta;
    for (int lambda = first_lambda_nm; lambda <= last_lambda_nm; ++lambda) {
        const double sigma_t = medium.sigma_s.at(lambda) + medium.sigma_a.at(lambda);
        if (!(sigma_t >= smallest_sigma_t_per_mm && sigma_t <= largest_sigma_t_per_mm))
            throw InputError(fmt::format(
                "--sigma-s, --sigma-a: expected a sum in [{:g}, {:g}] 1/mm from {} to {} nm, got {} at {} nm",
                smallest_sigma_t_per_mm, largest_sigma_t_per_mm, first_lambda_nm, last_lambda_nm, sigma_t, lambda));
    }
    return medium;
}

Fluorophore fluorophore_of(const MaterialFlags& flags) {
    Fluorophore fluorophore;
    fluorophore.name = "command line";
    fluorophore.excitation =
        spectrum_of("--excitation", flags.excitation, Outside::zero, 1.0, flags).at_whole_nanometres();
    if (const std::string doubt = doubt_of_probability(fluorophore.excitation); !doubt.empty())
        warn("--excitation: " + doubt);
    fluorophore.emission = spectrum_of("--emission", flags.emission, Outside::zero, largest_spectrum_value, flags)
                               .with_maximum_1()
                               .at_whole_nanometres();
    if (!(fluorophore.emission.sum_1nm() > 0.0))
        throw InputError(
            fmt::format("--emission: expected some from {} to {} nm, got none", first_lambda_nm, last_lambda_nm));
    fluorophore.quantum_yield = flags.quantum_yield;
    fluorophore.stokes_rule = value_of_word<StokesRule>(flags.stokes_rule);
    return fluorophore;
}

// All of them or none; whether they are there.
bool together(const CLI::App& command, const std::vector<const char*>& flags) {
    const char* given = nullptr;
    const char* missing = nullptr;
    for (const char* flag : flags) (command.count(flag) ? given : missing) = flag;
    if (given != nullptr && missing != nullptr)
        throw InputError(fmt::format("{}: expected {} as well", given, missing));
    return given != nullptr;
}

void add_word_flags(CLI::App& command, MaterialFlags& flags) {
    const auto words = [&](const char* flag, std::string& text, const Words& of, const char* what) {
        command.add_option(flag, text, what)
            ->type_name(fmt::format("{}", fmt::join(of, "|")))
            ->check(CLI::IsMember(of))
            ->group("Material");
    };
    words("--stokes-rule", flags.stokes_rule, words_of<StokesRule>,
          "What becomes of the emission at and below the exciting wavelength: brought back above it, or cut off");
    words("--wavelength-unit", flags.wavelength_unit, words_of<WavelengthUnit>,
          "Unit of the wavelengths of all files; default: as the name of their first column says, or nm");
    words("--per", flags.per, words_of<Per>, "What an emission is a density over: nm, or the unit of its wavelengths");
    words(
        "--negative", flags.negative, words_of<Negative>,
        "What becomes of values below zero; default: zero with a warning down to -0.02 of the largest, else an error");
}

}  // namespace

void add_material_flags(CLI::App& command, MaterialFlags& flags) {
    const auto spectrum = [&](const char* flag, std::string& text, const char* what) {
        command.add_option(flag, text, what)->type_name(spectrum_type)->group("Material");
    };
    spectrum("--sigma-s", flags.sigma_s, "Scattering coefficient [1/mm]");
    spectrum("--sigma-a", flags.sigma_a, "Absorption coefficient [1/mm]");
    command.add_option("--eta", flags.eta, "Refractive index; default 1")
        ->check(number_in(1.0, largest_green_eta))
        ->group("Material");
    command.add_flag("--fresnel", flags.fresnel, "The surface reflects")->group("Material");
    command.add_option("--fraction", flags.fraction, "Share of collisions that meet a fluorophore, where E is 1")
        ->type_name("C")
        ->check(number_in(0.0, 1.0))
        ->group("Material");
    spectrum("--excitation", flags.excitation, "Excitation E, 0 to 1");
    spectrum("--emission", flags.emission, "Emission, relative, of any scale");
    command.add_option("--quantum-yield", flags.quantum_yield, "Photons emitted for each taken up; default 1")
        ->type_name("Q")
        ->check(number_in(0.0, 1.0))
        ->group("Material");
    add_word_flags(command, flags);
}

bool has_material_flags(const CLI::App& command) {
    for (const char* flag : material_flags)
        if (command.count(flag)) return true;
    return false;
}

ProbeMaterial material_of(const CLI::App& command, const MaterialFlags& flags) {
    ProbeMaterial material;
    material.name = "command line";
    if (!together(command, {"--sigma-s", "--sigma-a"})) throw InputError("probe: expected --sigma-s and --sigma-a");
    if (command.count("--per") && parse_double(flags.emission))
        throw InputError("--per: expected a file in --emission; a number is no table over wavelength");
    material.medium = medium_of(flags);
    material.fresnel = flags.fresnel;
    if (together(command, {"--fraction", "--excitation", "--emission"})) {
        material.dyes = {{fluorophore_of(flags), flags.fraction}};
    } else {
        for (const char* flag : {"--quantum-yield", "--stokes-rule", "--per"})
            if (command.count(flag))
                throw InputError(fmt::format("{}: expected --fraction, --excitation and --emission as well", flag));
    }
    return material;
}

}  // namespace stokes
