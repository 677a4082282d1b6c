#include "host/core/spectrum.hpp"

#include <algorithm>
#include <cstddef>

namespace stokes {

double Spectrum::at(double wavelength_nm) const {
    if (value.empty()) return 0.0;
    if (wavelength_nm < lambda_nm.front()) return outside == Outside::hold ? value.front() : 0.0;
    if (wavelength_nm > lambda_nm.back()) return outside == Outside::hold ? value.back() : 0.0;
    const auto above = std::upper_bound(lambda_nm.begin(), lambda_nm.end(), wavelength_nm);
    if (above == lambda_nm.end()) return value.back();
    const auto i = static_cast<std::size_t>(above - lambda_nm.begin());
    const double t = (wavelength_nm - lambda_nm[i - 1]) / (lambda_nm[i] - lambda_nm[i - 1]);
    return value[i - 1] + t * (value[i] - value[i - 1]);
}

Spectrum Spectrum::scaled(double factor) const {
    Spectrum result = *this;
    for (double& v : result.value) v *= factor;
    return result;
}

double Spectrum::maximum() const { return value.empty() ? 0.0 : *std::max_element(value.begin(), value.end()); }

double Spectrum::sum_1nm(int first_nm, int last_nm) const {
    double sum = 0.0;
    for (int lambda = first_nm; lambda <= last_nm; ++lambda) sum += at(lambda);
    return sum;
}

Spectrum Spectrum::constant(double value) { return {{550.0}, {value}, Outside::hold}; }

}  // namespace stokes
