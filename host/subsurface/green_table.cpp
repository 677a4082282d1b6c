#include "host/subsurface/green_table.hpp"

#include <algorithm>
#include <cmath>

#include "host/subsurface/escape.hpp"

namespace stokes {
namespace {

constexpr std::size_t kRhoNodes = 128, kZNodes = 41, kAlbedos = 32;
constexpr double kRhoFirst = 0.003, kRhoLast = 600.0;
constexpr double kZFirst = 0.01, kZLast = 32.0;
constexpr double kRootLast = 0.01;  // sqrt(1 - a) of the last albedo below 1

std::vector<double> logarithmic_axis(double first, double last, std::size_t nodes) {
    std::vector<double> axis{0.0};
    for (std::size_t i = 0; i + 1 < nodes; ++i)
        axis.push_back(first * std::pow(last / first, static_cast<double>(i) / static_cast<double>(nodes - 2)));
    return axis;
}

// Weights of the polynomial through up to four neighbours of x at x.
struct Cubic {
    std::size_t first = 0, count = 0;
    double weight[4] = {};

    // from: the first node that may be used. nodes ascending.
    Cubic(const std::vector<double>& nodes, double x, std::size_t from) {
        const auto above = std::upper_bound(nodes.begin(), nodes.end(), x) - nodes.begin();
        count = std::min<std::size_t>(4, nodes.size() - from);
        const std::ptrdiff_t start = above - 2, last = static_cast<std::ptrdiff_t>(nodes.size() - count);
        first = static_cast<std::size_t>(std::clamp(start, static_cast<std::ptrdiff_t>(from), last));
        for (std::size_t i = 0; i < count; ++i) {
            weight[i] = 1.0;
            for (std::size_t j = 0; j < count; ++j)
                if (j != i) weight[i] *= (x - nodes[first + j]) / (nodes[first + i] - nodes[first + j]);
        }
    }
};

// count values, each stride after the last, at evenly spaced places.
void smooth_line(float* line, std::size_t count, std::size_t stride) {
    constexpr double weight[5] = {-3.0 / 35.0, 12.0 / 35.0, 17.0 / 35.0, 12.0 / 35.0, -3.0 / 35.0};
    std::vector<double> logarithm;
    for (std::size_t i = 0; i < count; ++i) logarithm.push_back(std::log(double(line[i * stride])));
    for (std::size_t i = 2; i + 2 < count; ++i) {
        double sum = 0.0;
        for (std::size_t k = 0; k < 5; ++k) sum += weight[k] * logarithm[i + k - 2];
        if (std::isfinite(sum)) line[i * stride] = static_cast<float>(std::exp(sum));
    }
}

}  // namespace

GreenTable green_table_nodes(double eta) {
    GreenTable table;
    table.eta = eta;
    table.rho = logarithmic_axis(kRhoFirst, kRhoLast, kRhoNodes);
    table.z = logarithmic_axis(kZFirst, kZLast, kZNodes);
    for (std::size_t i = 0; i + 1 < kAlbedos; ++i) {
        const double root = std::pow(kRootLast, static_cast<double>(i) / static_cast<double>(kAlbedos - 2));
        table.albedo.push_back(1.0 - root * root);
    }
    table.albedo.push_back(1.0);
    const HalfSpaceEscape escape(eta, table.z);
    for (const double u0 : escape.unscattered()) table.u0.push_back(static_cast<float>(u0));
    for (const double a : table.albedo) {
        const std::vector<double> total = escape.total(a);
        for (std::size_t i = 0; i < table.z.size(); ++i)
            table.u1.push_back(static_cast<float>(std::max(total[i] - escape.unscattered()[i], 0.0)));
    }
    return table;
}

double octaves_per_node(const std::vector<double>& axis) {
    return std::log2(axis.back() / axis[1]) / static_cast<double>(axis.size() - 2);
}

double green_row_integral(const GreenTable& table, std::size_t a, std::size_t z_index) {
    const float* h = &table.h1[table.row(a, z_index)];
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < table.rho.size(); ++i)
        sum += 0.5 * (double(h[i]) + double(h[i + 1])) * (table.rho[i + 1] - table.rho[i]);
    return sum;
}

void normalise_green_rows(GreenTable& table) {
    for (std::size_t a = 0; a < table.albedo.size(); ++a)
        for (std::size_t i = 0; i < table.z.size(); ++i) {
            const double integral = green_row_integral(table, a, i);
            if (!(integral > 0.0)) continue;
            const double factor = table.u1[a * table.z.size() + i] / integral;
            float* h = &table.h1[table.row(a, i)];
            for (std::size_t r = 0; r < table.rho.size(); ++r) h[r] = static_cast<float>(h[r] * factor);
        }
}

void smooth_green_rows(GreenTable& table) {
    const std::size_t rhos = table.rho.size(), depths = table.z.size();
    for (std::size_t a = 0; a < table.albedo.size(); ++a)
        for (std::size_t z = 0; z < depths; ++z) smooth_line(&table.h1[table.row(a, z) + 1], rhos - 1, 1);
    for (std::size_t a = 0; a < table.albedo.size(); ++a)
        for (std::size_t r = 1; r < rhos; ++r)
            smooth_line(&table.h1[table.row(a, 1) + r], depths - 1, table.rho.size());
}

GreenTotals::GreenTotals(const GreenTable& table) : z_(table.z), u1_(table.u1.begin(), table.u1.end()) {
    for (const double z : z_) log_z_.push_back(std::log(z));
    for (const double a : table.albedo) {
        root_.push_back(-std::sqrt(1.0 - a));
        kappa_.push_back(diffusion_decay(a));
    }
}

double GreenTotals::at_node(std::size_t a, double z) const {
    const double* f = &u1_[a * z_.size()];
    if (z < z_[1]) {
        const double first = (f[1] - f[0]) / z_[1], second = (f[2] - f[0]) / z_[2];
        const double b = (second - first) / (log_z_[2] - log_z_[1]);
        return z > 0.0 ? f[0] + z * (first + b * std::log(z / z_[1])) : f[0];
    }
    const double last = z_.back();
    const Cubic cubic(log_z_, std::log(std::min(z, last)), 1);
    double sum = 0.0;
    for (std::size_t i = 0; i < cubic.count; ++i) sum += cubic.weight[i] * f[cubic.first + i];
    return z > last ? sum * std::exp(-kappa_[a] * (z - last)) : sum;
}

double GreenTotals::at(double z, double albedo) const {
    const Cubic cubic(root_, -std::sqrt(1.0 - albedo), 0);
    double sum = 0.0;
    for (std::size_t i = 0; i < cubic.count; ++i) sum += cubic.weight[i] * at_node(cubic.first + i, z);
    return std::clamp(sum, 0.0, 1.0);
}

}  // namespace stokes
