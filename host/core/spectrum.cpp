#include "host/core/spectrum.hpp"

#include <algorithm>
#include <cmath>
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

Spectrum Spectrum::with_maximum_1() const {
    double largest = 0.0;
    for (std::size_t i = 0; i < value.size(); ++i)
        if ((lambda_nm[i] >= first_lambda_nm && lambda_nm[i] <= last_lambda_nm) || value.size() == 1)
            largest = std::max(largest, value[i]);
    largest = std::max({largest, at(first_lambda_nm), at(last_lambda_nm)});
    return largest > 0.0 && std::isfinite(1.0 / largest) ? scaled(1.0 / largest) : *this;
}

double Spectrum::sum_1nm(int first_nm, int last_nm) const {
    double sum = 0.0;
    for (int lambda = first_nm; lambda <= last_nm; ++lambda) sum += at(lambda);
    return sum;
}

// Of the straight lines, exactly: from_nm <= to_nm lie within the table.
double Spectrum::integral(double from_nm, double to_nm) const {
    double sum = 0.0, before_nm = from_nm, before = at(from_nm);
    const auto add = [&](double lambda, double v) {
        sum += 0.5 * (before + v) * (lambda - before_nm);
        before_nm = lambda;
        before = v;
    };
    const auto first = std::upper_bound(lambda_nm.begin(), lambda_nm.end(), from_nm);
    for (auto i = static_cast<std::size_t>(first - lambda_nm.begin()); i < value.size() && lambda_nm[i] < to_nm; ++i)
        add(lambda_nm[i], value[i]);
    add(to_nm, at(to_nm));
    return sum;
}

double Spectrum::mean_1nm(double wavelength_nm) const {
    if (value.empty()) return 0.0;
    const double from = wavelength_nm - 0.5, to = wavelength_nm + 0.5;
    if (outside == Outside::zero && value.size() == 1)
        return value[0] * std::max(0.0, 1.0 - std::abs(wavelength_nm - lambda_nm[0]));
    const double first = lambda_nm.front(), last = lambda_nm.back();
    const double low = std::clamp(from, first, last), high = std::clamp(to, first, last), covered = high - low;
    const double within = integral(low, high);
    if (outside == Outside::hold)
        return within + value.front() * std::max(0.0, std::min(first, to) - from) +
               value.back() * std::max(0.0, to - std::max(last, from));
    constexpr double rounding = 1e-9;
    return covered < 0.5 - rounding ? within : within + value.front() * (low - from) + value.back() * (to - high);
}

Spectrum Spectrum::at_whole_nanometres() const {
    if (value.size() == 1 && outside == Outside::hold) return *this;
    Spectrum result;
    result.outside = outside;
    for (int lambda = first_lambda_nm; lambda <= last_lambda_nm; ++lambda) {
        result.lambda_nm.push_back(lambda);
        result.value.push_back(mean_1nm(lambda));
    }
    return result;
}

Spectrum Spectrum::constant(double value) { return {{550.0}, {value}, Outside::hold}; }

}  // namespace stokes
