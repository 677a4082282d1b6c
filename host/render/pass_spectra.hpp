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

// Where rows of the pass's spectra stand: a row is one Flux16.
// [0, materials): reflectance; then one excitation row and 16 re-radiation rows a fluorophore; then sigma_t
// [1/mm] and albedo of each medium; then the white reflectance of each material that has a texture.
struct SpectraLayout {
    explicit SpectraLayout(const Scene& scene);
    std::uint32_t excitation_row(int fluorophore) const {
        return materials + static_cast<std::uint32_t>(fluorophore) * 17;
    }
    std::uint32_t reradiation_row(int fluorophore) const { return excitation_row(fluorophore) + 1; }
    std::uint32_t sigma_row(int medium) const {
        return materials + fluorophores * 17 + static_cast<std::uint32_t>(medium) * 2;
    }
    // texture: number of the material among those with a texture.
    std::uint32_t white_row(std::uint32_t texture) const { return materials + fluorophores * 17 + media * 2 + texture; }
    std::uint32_t row_count() const { return white_row(textures); }
    std::uint32_t materials, fluorophores, media, textures;
};

// Those of a render's pass: drawn uniformly, PHYSICS section 2.
PassWavelengths pass_wavelengths(const RenderSettings& render, std::uint32_t pass);

struct PassSpectra {
    PassConstants constants;   // all but offset_mm
    std::vector<Flux16> rows;  // SpectraLayout::row_count() rows
    // Per light, times the wavelengths' rarity: flux of one photon [W/nm], all lights' probabilities included, and
    // radiance of its surface [W mm^-2 sr^-1 nm^-1], for beams the irradiance across them [W mm^-2 nm^-1].
    std::vector<Flux16> photon_flux, radiance;
};

// Chance that a photon starts at each light: proportional to its power in the render's wavelength range.
// InputError when no light has any power there.
std::vector<double> light_probabilities(const Scene& scene);

// surface_area_mm2: per light, of its emitting surface (beams: unused).
PassSpectra make_pass_spectra(const Scene& scene, const std::vector<double>& probabilities,
                              const std::vector<double>& surface_area_mm2, std::uint32_t pass, std::uint32_t photons);
PassSpectra make_pass_spectra(const Scene& scene, const std::vector<double>& probabilities,
                              const std::vector<double>& surface_area_mm2, const PassWavelengths& wavelengths,
                              std::uint32_t pass, std::uint32_t photons);

// Re-radiation matrix at a wavelength set: [ex][em], 0 unless em > ex (Stokes). Flux at ex [W/nm] times it is flux at
// em [W/nm]. Model `paper`, eq. 1-2: conversion E(ex) F(em) pair weight.
// The others: quantum yield E(ex) f(em) ex/em pair weight, f the emission as photons per nm, its sum over 300..830 nm
// one (PHYSICS section 4, without c).
std::array<Flux16, STOKES_WAVELENGTHS> reradiation_rows(const Fluorophore& fluorophore, Transport transport,
                                                        const PassWavelengths& wavelengths);
// The same where all pairs weigh alike.
std::array<Flux16, STOKES_WAVELENGTHS> reradiation_rows(const Fluorophore& fluorophore, Transport transport,
                                                        const WavelengthSet& set, double pair_weight_nm);

}  // namespace stokes
