// Significance of what samplers and estimators give.
//
// A test fixes its seeds, states how many comparisons it makes and how often all of them together may be
// wrong by chance, and compares each p-value with sidak_level().
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace stokes {

// The level of each of `comparisons` independent tests that are together wrong with probability family_level
// (Sidak 1967).
inline double sidak_level(double family_level, std::size_t comparisons) {
    return -std::expm1(std::log1p(-family_level) / static_cast<double>(comparisons));
}

// Probability that a chi-square variable with that many degrees of freedom exceeds the value: the regularised
// upper incomplete gamma function Q(freedom / 2, value / 2), by its series or its continued fraction
// (Abramowitz and Stegun 6.5.29 and 6.5.31).
inline double chi_square_tail(double value, double freedom) {
    const double a = 0.5 * freedom, x = 0.5 * value;
    if (!(x > 0.0)) return 1.0;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1.0) {
        double term = 1.0 / a, sum = term;
        for (double k = a + 1.0; term > 1e-16 * sum; k += 1.0) sum += term *= x / k;
        return 1.0 - front * sum;
    }
    const double tiny = std::numeric_limits<double>::min();
    double b = x + 1.0 - a, c = 1.0 / tiny, d = 1.0 / b, fraction = d, change = 0.0;
    for (double k = 1.0; std::abs(change - 1.0) > 1e-15 && k < 1e5; k += 1.0) {
        const double numerator = k * (a - k);
        b += 2.0;
        d = 1.0 / (b + numerator * d);
        c = b + numerator / c;
        change = c * d;
        fraction *= change;
    }
    return front * fraction;
}

// Probability that a standard normal variable lies further from 0 than z.
inline double normal_two_sided(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

// p-value of Pearson's test of counts against expected counts. Neighbouring cells are merged until each
// expects at least 5; constraints: degrees of freedom lost, 1 for a fixed total. NaN when fewer than two
// cells remain.
inline double chi_square_p_value(const std::vector<double>& observed, const std::vector<double>& expected,
                                 double constraints = 1.0) {
    std::vector<double> counts{0.0}, means{0.0};
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (means.back() >= 5.0) {
            counts.push_back(0.0);
            means.push_back(0.0);
        }
        counts.back() += observed[i];
        means.back() += expected[i];
    }
    if (means.size() > 1 && means.back() < 5.0) {
        counts[counts.size() - 2] += counts.back();
        means[means.size() - 2] += means.back();
        counts.pop_back();
        means.pop_back();
    }
    if (means.size() < 2) return std::numeric_limits<double>::quiet_NaN();
    double sum = 0.0;
    for (std::size_t i = 0; i < means.size(); ++i) sum += (counts[i] - means[i]) * (counts[i] - means[i]) / means[i];
    return chi_square_tail(sum, static_cast<double>(means.size()) - constraints);
}

// The same where all cells expect the same.
inline double chi_square_uniform(const std::vector<double>& observed) {
    double total = 0.0;
    for (const double count : observed) total += count;
    return chi_square_p_value(observed,
                              std::vector<double>(observed.size(), total / static_cast<double>(observed.size())));
}

// Mean and spread of a stream of numbers (Welford 1962).
class Sample {
  public:
    void add(double x) {
        ++count_;
        const double before = x - mean_;
        mean_ += before / static_cast<double>(count_);
        squares_ += before * (x - mean_);
    }
    std::size_t count() const { return count_; }
    double mean() const { return mean_; }
    double variance() const { return squares_ / static_cast<double>(count_ - 1); }
    double standard_error() const { return std::sqrt(variance() / static_cast<double>(count_)); }
    // Distance of the mean from what it should be, in standard errors. 0 / 0 counts as none.
    double z(double expected) const {
        const double difference = mean_ - expected;
        return difference == 0.0 ? 0.0 : difference / standard_error();
    }

  private:
    std::size_t count_ = 0;
    double mean_ = 0.0, squares_ = 0.0;
};

}  // namespace stokes
