// What a pass's sixteen wavelengths make of the scene's spectra.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/device/device.hpp"
#include "host/render/wavelengths.hpp"
#include "host/scene/scene.hpp"
#include "kernels/shared/pass.h"

namespace stokes {

// Where rows of the pass's spectra stand: a row is one Flux16. Row i is the reflectance of the
// material of index i among material_uses().
struct SpectraLayout {
    explicit SpectraLayout(const Scene& scene);
    // Of sigma_t [1/mm]; the albedo stands in the next one.
    std::uint32_t sigma_row(int medium) const { return first_sigma_row + 2 * static_cast<std::uint32_t>(medium); }
    // By that index. Of its fluorophores together the excitation, before 16 rows of re-radiation; of its texture the
    // white reflectance. Void where it has none.
    std::vector<std::uint32_t> excitation_row, white_row;
    std::uint32_t first_sigma_row = 0, row_count = 0;
};

// Those of a render's pass: drawn uniformly, PHYSICS section 2.
PassWavelengths pass_wavelengths(const RenderSettings& render, std::uint32_t pass);

struct PassSpectra {
    PassConstants constants;   // all but offset_mm
    std::vector<Flux16> rows;  // as SpectraLayout has them
    // Per light, times the wavelengths' rarity: flux of one photon [W/nm], all lights' probabilities included, and
    // radiance of its surface [W mm^-2 sr^-1 nm^-1], for beams the irradiance across them [W mm^-2 nm^-1].
    std::vector<Flux16> photon_flux, radiance;
};

// Chance that a photon starts at each light: proportional to its power in the render's wavelength range.
// InputError when no light has any power there.
std::vector<double> light_probabilities(const Scene& scene);

// light_spread: per light, LightTables::spread.
PassSpectra make_pass_spectra(const Scene& scene, const std::vector<double>& probabilities,
                              const std::vector<double>& light_spread, std::uint32_t pass, std::uint32_t photons);
PassSpectra make_pass_spectra(const Scene& scene, const std::vector<double>& probabilities,
                              const std::vector<double>& light_spread, const PassWavelengths& wavelengths,
                              std::uint32_t pass, std::uint32_t photons);

// Each dye's share of what meets the fluorophores of a material: c_k/c, which add up to 1.
std::vector<double> dye_weights(const std::vector<Dye>& dyes);

// Re-radiation matrix at a wavelength set: [ex][em], 0 unless em > ex (Stokes). Flux at ex [W/nm] times it is flux at
// em [W/nm]: E(ex) TransportModel::reradiated_per_nm() StokesFactor pair weight.
std::array<Flux16, STOKES_WAVELENGTHS> reradiation_rows(const Fluorophore& fluorophore, Transport transport,
                                                        const PassWavelengths& wavelengths);
// The same where all pairs weigh alike.
std::array<Flux16, STOKES_WAVELENGTHS> reradiation_rows(const Fluorophore& fluorophore, Transport transport,
                                                        const WavelengthSet& set, double pair_weight_nm);

}  // namespace stokes
