// From spectra to the colours of a screen.
//
// Film values are XYZ with Y the luminance in cd/m^2: 683.002 lm/W times the integral over wavelength of
// radiance [W m^-2 sr^-1 nm^-1] times the colour matching functions. Linear Rec. 709 is scaled so that
// (1, 1, 1) is a white of 1 cd/m^2.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "host/core/spectrum.hpp"

namespace stokes {

// K_m of the standard observer [lm/W]: 683 lm/W at 540 THz, carried to the peak of V(lambda) (CIE 018).
inline constexpr double luminous_efficacy = 683.002;

struct ColourMatching {
    Spectrum x, y, z;  // dimensionless, 360..830 nm, zero outside
};

// The CIE 1931 2-degree standard observer, read once from the embedded tables.
const ColourMatching& cie1931();

// A column of an embedded CIE table, for example ("illuminants_1nm.csv", "D65"); zero outside its
// wavelengths. Throws InputError where there is no such file or column, or a line is not numbers.
Spectrum cie_spectrum(const std::string& file, const std::string& column);

// XYZ of a spectrum on the renderer's 1 nm grid, 300..830 nm; Y in cd/m^2 for spectral radiance in W m^-2
// sr^-1 nm^-1.
glm::dvec3 xyz_of(const Spectrum& radiance);

// Linear Rec. 709 of XYZ and back, from the primaries and the D65 white of ITU-R BT.709-6, item 1.3 and 1.4.
// Colours outside the gamut have negative components.
glm::dvec3 rec709_of_xyz(const glm::dvec3& xyz);
glm::dvec3 xyz_of_rec709(const glm::dvec3& rgb);
const glm::dmat3& rec709_from_xyz();  // the matrix itself, columns first as GLM has them

// Chromaticities (x, y).
struct Primaries {
    glm::dvec2 red, green, blue, white;
};
// XYZ of linear R, G, B where (1, 1, 1) is their white of luminance 1. None where they mix no such white. Primaries
// without luminance, y = 0, are allowed: ((1, 0), (0, 1), (0, 0), (1/3, 1/3)) are those of XYZ itself.
std::optional<glm::dmat3> xyz_from_primaries(const Primaries& primaries);

// Lightness L and the opponent axes a, b of linear Rec. 709 in Oklab, and back (B. Ottosson, "A perceptual
// color space for image processing", 2020). The angle of (a, b) is the hue; defined outside the gamut too.
glm::dvec3 oklab_of_rec709(const glm::dvec3& rgb);
glm::dvec3 rec709_of_oklab(const glm::dvec3& lab);

}  // namespace stokes
