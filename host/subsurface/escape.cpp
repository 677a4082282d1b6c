#include "host/subsurface/escape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/error.hpp"
#include "host/subsurface/quadrature.hpp"

namespace stokes {
namespace {

// Panels [0, 2^kFirst], [2^kFirst, 2^(kFirst+1)] .. 2^kLast, with kOrder nodes each.
constexpr int kFirst = -26, kLast = 14, kOrder = 10;

// Beyond this optical distance a kernel is left out: exp(-40) = 4e-18.
constexpr double kReach = 40.0;

double exponential_integral_1(double x) { return -std::expint(-x); }

double critical_cosine(double eta) { return std::sqrt(1.0 - 1.0 / (eta * eta)); }

// Cosines between the critical angle and the normal; denser toward the former, where R has a root.
struct OpenCone {
    std::vector<double> mu, weight, reflectance;

    explicit OpenCone(double eta) {
        static const GaussLegendre rule(64);
        const double critical = critical_cosine(eta);
        for (std::size_t i = 0; i < rule.node.size(); ++i) {
            const double v = rule.node[i];
            mu.push_back(critical + (1.0 - critical) * v * v);
            weight.push_back(2.0 * v * rule.weight[i] * (1.0 - critical));
            reflectance.push_back(internal_reflectance(mu.back(), eta));
        }
    }
};

// Piecewise polynomials over the panels, each given by its values at the panels' Gauss nodes.
class PanelBasis {
  public:
    PanelBasis() : rule_(kOrder), edges_{0.0} {
        for (int k = kFirst; k <= kLast; ++k) edges_.push_back(std::ldexp(1.0, k));
        for (std::size_t p = 0; p + 1 < edges_.size(); ++p)
            for (int i = 0; i < kOrder; ++i) nodes_.push_back(edges_[p] + (edges_[p + 1] - edges_[p]) * rule_.node[i]);
        for (int i = 0; i < kOrder; ++i) {
            double product = 1.0;
            for (int j = 0; j < kOrder; ++j)
                if (j != i) product *= rule_.node[i] - rule_.node[j];
            barycentric_.push_back(1.0 / product);
        }
    }
    const std::vector<double>& nodes() const { return nodes_; }
    const std::vector<double>& edges() const { return edges_; }

    // row[j] += integral f L_j between low and high, both in the same panel, where f is smooth.
    template <class Function>
    void integrate(std::size_t panel, double low, double high, double* row, Function&& f) const {
        static const GaussLegendre fine(12);
        const double width = edges_[panel + 1] - edges_[panel];
        double* out = row + panel * kOrder;
        for (std::size_t q = 0; q < fine.node.size(); ++q) {
            const double z = low + (high - low) * fine.node[q];
            const double value = (high - low) * fine.weight[q] * f(z);
            const double x = (z - edges_[panel]) / width;
            double terms[kOrder], sum = 0.0;
            for (int i = 0; i < kOrder; ++i) sum += terms[i] = barycentric_[i] / (x - rule_.node[i] + 1e-300);
            for (int i = 0; i < kOrder; ++i) out[i] += value * terms[i] / sum;
        }
    }

    // row[j] += integral f L_j over all depths, cut at the panels' edges and at the given points.
    template <class Function>
    void integrate(std::vector<double> cuts, double* row, Function&& f) const {
        cuts.insert(cuts.end(), edges_.begin(), edges_.end());
        std::sort(cuts.begin(), cuts.end());
        std::size_t panel = 0;
        const double low = std::max(cuts.front(), 0.0);
        for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
            if (cuts[i] < low || cuts[i + 1] > edges_.back() || !(cuts[i + 1] > cuts[i])) continue;
            const double middle = 0.5 * (cuts[i] + cuts[i + 1]);
            while (middle > edges_[panel + 1]) ++panel;
            integrate(panel, cuts[i], cuts[i + 1], row, f);
        }
    }

  private:
    GaussLegendre rule_;
    std::vector<double> edges_, nodes_, barycentric_;
};

const PanelBasis& basis() {
    static const PanelBasis panels;
    return panels;
}

// Cuts that double their distance from z, up to the reach; from 2^-30 on when z is itself a singularity.
std::vector<double> graded_cuts(double z, double unit) {
    std::vector<double> cuts{z};
    for (int k = -30; k <= 0; ++k)
        for (const double sign : {-1.0, 1.0}) cuts.push_back(z + sign * std::ldexp(unit, k));
    for (double distance = 2.0; distance <= kReach; distance += 1.0)
        for (const double sign : {-1.0, 1.0}) cuts.push_back(z + sign * distance * unit);
    cuts.erase(std::remove_if(cuts.begin(), cuts.end(), [](double c) { return c < 0.0; }), cuts.end());
    return cuts;
}

// The rows integral K(z, z') L_j(z') dz' for a list of z.
class KernelRows {
  public:
    explicit KernelRows(double eta) : eta_(eta), cone_(eta), count_(basis().nodes().size()) {
        if (eta_ == 1.0) return;
        moments_.resize(cone_.mu.size() * count_);
        for (std::size_t k = 0; k < cone_.mu.size(); ++k)
            basis().integrate(graded_cuts(0.0, 1.0), &moments_[k * count_],
                              [&](double z) { return z > kReach ? 0.0 : std::exp(-z / cone_.mu[k]); });
    }

    std::vector<double> rows(const std::vector<double>& depths) const {
        std::vector<double> all(depths.size() * count_);
        for (std::size_t i = 0; i < depths.size(); ++i) {
            double* row = &all[i * count_];
            add_direct(depths[i], row);
            if (eta_ > 1.0) add_reflected(depths[i], row);
            for (std::size_t j = 0; j < count_; ++j) row[j] *= 0.5;
        }
        return all;
    }

  private:
    void add_direct(double z, double* row) const {
        basis().integrate(graded_cuts(z, 1.0), row, [z](double to) {
            const double distance = std::abs(to - z);
            return distance > kReach || distance == 0.0 ? 0.0 : exponential_integral_1(distance);
        });
    }
    // R = 1 up to the critical angle gives E_1((z + z') / mu_c); the rest is a sum over cosines.
    void add_reflected(double z, double* row) const {
        const double critical = critical_cosine(eta_);
        basis().integrate(graded_cuts(0.0, critical), row, [z, critical](double to) {
            const double distance = (z + to) / critical;
            return distance > kReach ? 0.0 : exponential_integral_1(distance);
        });
        for (std::size_t k = 0; k < cone_.mu.size(); ++k) {
            const double factor = cone_.weight[k] * cone_.reflectance[k] / cone_.mu[k] * std::exp(-z / cone_.mu[k]);
            const double* moment = &moments_[k * count_];
            for (std::size_t j = 0; j < count_; ++j) row[j] += factor * moment[j];
        }
    }

    double eta_;
    OpenCone cone_;
    std::size_t count_;
    std::vector<double> moments_;  // [cosine][node]: integral exp(-z/mu) L_j
};

// Solves matrix x = x's right-hand side, in place, by elimination with row exchanges. matrix [n][n].
void solve(std::vector<double> matrix, std::vector<double>& x) {
    const std::size_t n = x.size();
    for (std::size_t column = 0; column < n; ++column) {
        std::size_t pivot = column;
        for (std::size_t row = column + 1; row < n; ++row)
            if (std::abs(matrix[row * n + column]) > std::abs(matrix[pivot * n + column])) pivot = row;
        if (pivot != column) {
            std::swap_ranges(&matrix[column * n], &matrix[column * n] + n, &matrix[pivot * n]);
            std::swap(x[column], x[pivot]);
        }
        for (std::size_t row = column + 1; row < n; ++row) {
            const double factor = matrix[row * n + column] / matrix[column * n + column];
            if (factor == 0.0) continue;
            for (std::size_t k = column; k < n; ++k) matrix[row * n + k] -= factor * matrix[column * n + k];
            x[row] -= factor * x[column];
        }
    }
    for (std::size_t row = n; row-- > 0;) {
        for (std::size_t k = row + 1; k < n; ++k) x[row] -= matrix[row * n + k] * x[k];
        x[row] /= matrix[row * n + row];
    }
}

}  // namespace

double internal_reflectance(double mu, double eta) {
    const double sine2_out = eta * eta * (1.0 - mu * mu);
    if (eta == 1.0) return 0.0;
    if (sine2_out >= 1.0) return 1.0;
    const double mu_out = std::sqrt(1.0 - sine2_out);
    const double s = (eta * mu - mu_out) / (eta * mu + mu_out);
    const double p = (mu - eta * mu_out) / (mu + eta * mu_out);
    return 0.5 * (s * s + p * p);
}

double diffusion_decay(double albedo) {
    if (albedo >= 1.0) return 0.0;
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 200; ++i) {
        const double kappa = 0.5 * (low + high);
        const bool below =
            kappa < 1e-4 ? albedo * (1.0 + kappa * kappa / 3.0) < 1.0 : albedo * std::atanh(kappa) < kappa;
        (below ? low : high) = kappa;
    }
    return 0.5 * (low + high);
}

double unscattered_escape(double z, double eta) {
    if (eta == 1.0) return z > 0.0 ? 0.5 * (std::exp(-z) - z * exponential_integral_1(z)) : 0.5;
    const OpenCone cone(eta);
    double sum = 0.0;
    for (std::size_t i = 0; i < cone.mu.size(); ++i)
        sum += 0.5 * cone.weight[i] * (1.0 - cone.reflectance[i]) * std::exp(-z / cone.mu[i]);
    return sum;
}

HalfSpaceEscape::HalfSpaceEscape(double eta, std::vector<double> depths)
    : eta_(eta), depths_(std::move(depths)), nodes_(basis().nodes()) {
    if (!(eta >= 1.0 && eta <= 4.0))
        throw InputError(fmt::format("eta {}: expected a refractive index from 1 to 4", eta));
    for (const double z : depths_) unscattered_.push_back(unscattered_escape(z, eta_));
    for (const double z : nodes_) node_unscattered_.push_back(unscattered_escape(z, eta_));
    const KernelRows kernel(eta_);
    node_kernel_ = kernel.rows(nodes_);
    depth_kernel_ = kernel.rows(depths_);
}

std::vector<double> HalfSpaceEscape::total(double albedo) const {
    if (!(albedo >= 0.0 && albedo <= 1.0))
        throw InputError(fmt::format("albedo {}: expected a number from 0 to 1", albedo));
    if (albedo == 1.0) return std::vector<double>(depths_.size(), 1.0);
    const std::size_t n = nodes_.size();
    std::vector<double> matrix(n * n), at_nodes = node_unscattered_;
    for (std::size_t i = 0; i < n * n; ++i) matrix[i] = -albedo * node_kernel_[i];
    for (std::size_t i = 0; i < n; ++i) matrix[i * n + i] += 1.0;
    solve(std::move(matrix), at_nodes);
    std::vector<double> result;
    for (std::size_t d = 0; d < depths_.size(); ++d) {
        double sum = 0.0;
        for (std::size_t j = 0; j < n; ++j) sum += depth_kernel_[d * n + j] * at_nodes[j];
        result.push_back(unscattered_[d] + albedo * sum);
    }
    return result;
}

}  // namespace stokes
