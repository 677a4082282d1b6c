// A quantity tabulated over wavelength.
#pragma once

#include <vector>

namespace stokes {

// Whole nanometres at which the renderer may ask for a spectrum.
inline constexpr int first_lambda_nm = 300, last_lambda_nm = 830;

// What a spectrum is outside the wavelengths of its table.
enum class Outside { zero, hold };

// Piecewise linear between strictly increasing wavelengths [nm]; both vectors have the same length >= 1.
// A constant is one sample with Outside::hold.
struct Spectrum {
    std::vector<double> lambda_nm;
    std::vector<double> value;
    Outside outside = Outside::zero;

    double at(double wavelength_nm) const;
    Spectrum scaled(double factor) const;
    double maximum() const;
    // Sum of at() over the integer wavelengths first_nm..last_nm: the integral on the renderer's 1 nm grid.
    double sum_1nm(int first_nm = first_lambda_nm, int last_nm = last_lambda_nm) const;

    static Spectrum constant(double value);
};

}  // namespace stokes
