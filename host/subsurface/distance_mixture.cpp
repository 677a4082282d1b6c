#include "host/subsurface/distance_mixture.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/subsurface/paper_transport.hpp"

namespace stokes {
namespace {

// The sums of weights up to each wavelength over that of all; of equal weights where all are 0.
std::vector<double> cumulative(std::vector<double> weights) {
    if (!(std::accumulate(weights.begin(), weights.end(), 0.0) > 0.0)) weights.assign(weights.size(), 1.0);
    std::partial_sum(weights.begin(), weights.end(), weights.begin());
    const double total = weights.back();
    for (double& w : weights) w /= total;
    return weights;
}

// Weights of the wavelengths for dense and for thin media; see kernels/lib/integrated_distance.clh.
struct Envelope {
    std::vector<double> dense, thin;

    void add(double factor, double sigma_t) {
        thin.push_back(factor / sigma_t);
        dense.push_back(factor / sigma_t / sigma_t);
    }
    // 0 where all weights are 0.
    double reach_mm() const {
        const double all = std::accumulate(thin.begin(), thin.end(), 0.0);
        return all > 0.0 ? std::accumulate(dense.begin(), dense.end(), 0.0) / all : 0.0;
    }
};

}  // namespace

MediumMixture make_medium_mixture(const MediumSpectra& medium, std::size_t first, const TableGrid& grid) {
    const TableMedium at = table_medium(medium, grid.lambda_nm);
    const double dipole_a = dipole_boundary(medium.dipole_eta), r_max = grid.r_mm.back();
    std::vector<std::vector<double>> rows(STOKES_MIX_ROWS);
    Envelope fluorescence, single;
    std::vector<double> multiple;
    for (std::size_t i = 0; i < grid.lambda_nm.size(); ++i) {
        const double sigma_t = at.sigma_s[i] + at.sigma_a[i], sigma_tr = std::sqrt(3.0 * at.sigma_a[i] * sigma_t);
        const double v_high = std::asinh(r_max * sigma_t);
        const double v_low = std::asinh(r_max * sigma_t / (1.0 + 4.0 / 3.0 * dipole_a));
        rows[STOKES_MIX_SIGMA_T].push_back(sigma_t);
        rows[STOKES_MIX_SIGMA_TR].push_back(sigma_tr);
        rows[STOKES_MIX_V_LOW].push_back(v_low);
        rows[STOKES_MIX_V_HIGH].push_back(v_high);
        fluorescence.add(1.0, sigma_t);
        single.add(at.sigma_s[i], sigma_t);
        const double a = sigma_tr / sigma_t;
        multiple.push_back(sigma_t * (v_high - v_low) * (1.0 + a) * std::exp(-a));
    }
    rows[STOKES_MIX_F_DENSE] = cumulative(fluorescence.dense);
    rows[STOKES_MIX_F_THIN] = cumulative(fluorescence.thin);
    rows[STOKES_MIX_S_DENSE] = cumulative(single.dense);
    rows[STOKES_MIX_S_THIN] = cumulative(single.thin);
    rows[STOKES_MIX_M] = cumulative(multiple);

    MediumMixture result;
    result.record.first = static_cast<unsigned>(first);
    result.record.count = static_cast<unsigned>(grid.lambda_nm.size());
    result.record.r_max_mm = static_cast<float>(r_max);
    result.record.theta_max_deg = static_cast<float>(grid.theta_deg.back());
    result.record.reach_f_mm = static_cast<float>(fluorescence.reach_mm());
    result.record.reach_s_mm = static_cast<float>(single.reach_mm());
    for (const std::vector<double>& row : rows)
        for (const double value : row) result.rows.push_back(static_cast<float>(value));
    return result;
}

}  // namespace stokes
