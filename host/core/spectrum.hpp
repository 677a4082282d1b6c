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
    // Scaled so that the largest sample from first_lambda_nm to last_lambda_nm is 1; where none of them is above 0, the
    // same.
    Spectrum with_maximum_1() const;
    // Sum of at() over the integer wavelengths first_nm..last_nm: the integral on the renderer's 1 nm grid.
    double sum_1nm(int first_nm = first_lambda_nm, int last_nm = last_lambda_nm) const;

    // Mean over the nanometre about a wavelength, so that at whole nanometres no line is lost between them. Where the
    // table ends within that nanometre, outside its table zero, its last value holds to the end of that nanometre if
    // the table covers half of it or more. A single sample stands for the nanometre about it.
    double mean_1nm(double wavelength_nm) const;
    // Those means as samples at whole nanometres, first_lambda_nm to last_lambda_nm. A constant stays as it is.
    Spectrum at_whole_nanometres() const;

    static Spectrum constant(double value);

  private:
    double integral(double from_nm, double to_nm) const;
};

}  // namespace stokes
