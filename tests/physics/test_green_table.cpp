#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "host/render/transport/green_resampler.hpp"
#include "host/render/transport/green_walk.hpp"
#include "host/subsurface/escape.hpp"
#include "host/subsurface/quadrature.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/half_space.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

// A random walk of its own kind: photons that are absorbed or go on, reflected or let out, in double
// precision. Counts those that left after a collision, by lateral distance; the last cell is everything
// beyond the last edge.
struct DirectWalk {
    double eta, z, albedo;
    std::mt19937_64 generator;

    double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(generator); }

    // Lateral distance of the escape, or -1.
    double photon() {
        double x = 0.0, y = 0.0, depth = z;
        for (bool collided = false;; collided = true) {
            const double mu = 2.0 * uniform() - 1.0, sine = std::sqrt(1.0 - mu * mu);
            const double azimuth = 2.0 * M_PI * uniform();
            double flight = -std::log(1.0 - uniform());
            if (mu > 0.0 && flight * mu > depth) {
                const double to_surface = depth / mu;
                if (uniform() >= internal_reflectance(mu, eta)) {
                    if (!collided) return -1.0;
                    x += to_surface * sine * std::cos(azimuth);
                    y += to_surface * sine * std::sin(azimuth);
                    return std::hypot(x, y);
                }
                depth = flight * mu - depth;
            } else {
                depth -= flight * mu;
            }
            x += flight * sine * std::cos(azimuth);
            y += flight * sine * std::sin(azimuth);
            if (uniform() >= albedo) return -1.0;
        }
    }

    std::vector<double> counts(const std::vector<double>& edges, std::size_t photons) {
        std::vector<double> result(edges.size(), 0.0);
        for (std::size_t i = 0; i < photons; ++i) {
            const double rho = photon();
            if (rho < 0.0) continue;
            const auto above = std::upper_bound(edges.begin(), edges.end(), rho) - edges.begin();
            result[std::max<std::ptrdiff_t>(above - 1, 0)] += 1.0;
        }
        return result;
    }
};

constexpr double kSigma = 1.3;  // [1/mm]

// Table rows for sixteen albedos at one extinction coefficient, as a pass has them.
struct PassRows {
    TableShape shape;
    std::vector<Flux16> values;

    PassRows(const GreenTable& table, const GreenResampler::Sixteen& albedo) {
        Device& device = test_device();
        shape = green_medium_shape(table, 0.9, 1.9);
        const std::size_t entries = std::size_t{shape.row_count} * shape.r_count;
        const GreenPassTables pass{
            Buffer<Flux16>(device, "table", entries), Buffer<Flux16>(device, "u1", shape.row_count),
            Buffer<float>(device, "mean", entries), Buffer<float>(device, "cumulative", entries)};
        GreenResampler::Sixteen sigma_t;
        sigma_t.fill(kSigma);
        GreenResampler(device, table).resample(shape, 0, sigma_t, albedo, pass);
        values = pass.table16.download();
    }
    static double node(double first, double octaves, std::size_t i) {
        return i == 0 ? 0.0 : first * std::exp2(octaves * static_cast<double>(i - 1));
    }
    double r_mm(std::size_t i) const { return node(shape.r_first, shape.r_step, i); }

    // Escapes between the distances edges [mm], the last cell beyond the last edge; linear in z between rows
    // and piecewise linear in r, as the renderer reads it. edges: nodes of the r axis.
    std::vector<double> masses(double z_mm, std::size_t lane, const std::vector<std::size_t>& edges) const {
        std::size_t row = 0;
        while (row + 2 < shape.row_count && node(shape.row_first, shape.row_step, row + 1) < z_mm) ++row;
        const double low = node(shape.row_first, shape.row_step, row),
                     high = node(shape.row_first, shape.row_step, row + 1);
        const double w = (z_mm - low) / (high - low);
        const auto density = [&](std::size_t i) {
            return (1.0 - w) * double(values[row * shape.r_count + i].v[lane]) +
                   w * double(values[(row + 1) * shape.r_count + i].v[lane]);
        };
        std::vector<double> result;
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const std::size_t end = e + 1 < edges.size() ? edges[e + 1] : shape.r_count - 1;
            double sum = 0.0;
            for (std::size_t i = edges[e]; i < end; ++i)
                sum += 0.5 * (density(i) + density(i + 1)) * (r_mm(i + 1) - r_mm(i));
            result.push_back(sum);
        }
        return result;
    }
};

const GreenResampler::Sixteen kAlbedos{0.3,  0.5,  0.7,  0.8,   0.85,  0.9,   0.93,  0.95,
                                       0.97, 0.98, 0.99, 0.993, 0.996, 0.997, 0.998, 0.999};

// Pearson's p-value of a direct walk's distances against the table, totals included.
double p_value(const PassRows& rows, double eta, double z, std::size_t lane, std::size_t photons) {
    std::vector<std::size_t> nodes{0};
    for (std::size_t i = 1; i < rows.shape.r_count; i += 3) nodes.push_back(i);
    std::vector<double> edges;
    for (const std::size_t i : nodes) edges.push_back(rows.r_mm(i) * kSigma);
    DirectWalk walk{eta, z, kAlbedos[lane], std::mt19937_64(1000 * lane + static_cast<std::size_t>(100.0 * z))};
    std::vector<double> observed = walk.counts(edges, photons);
    std::vector<double> expected = rows.masses(z / kSigma, lane, nodes);
    double left = static_cast<double>(photons), rest = left;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        expected[i] *= static_cast<double>(photons);
        left -= observed[i];
        rest -= expected[i];
    }
    observed.push_back(left);
    expected.push_back(rest);
    return chi_square_p_value(observed, expected);
}

void compare_with_direct_walk(std::size_t photons) {
    const double level = sidak_level(1e-3, 36);
    for (const double eta : {1.0, 1.33, 1.5}) {
        const PassRows rows(green_table_for(test_device(), eta), kAlbedos);
        for (const std::size_t lane : {5u, 10u, 14u})
            for (const double z : {0.05, 0.4, 1.3, 4.5}) {
                CAPTURE(eta, kAlbedos[lane], z, photons);
                CHECK(p_value(rows, eta, z, lane, photons) > level);
            }
    }
}

}  // namespace

// PHYSICS section 4: the first collision at depth t mu, density exp(-t); what leaves is u0 + u1. By the
// table's rows, linear in depth between them as the renderer reads them.
TEST_CASE("the table's totals give the exact reflectance", "[green_table]") {
    const GreenTable table = green_table_for(test_device(), 1.0);
    const GreenTotals totals(table);
    const TableShape shape = green_medium_shape(table, 0.9, 1.9);
    std::vector<double> depths;
    for (std::size_t i = 0; i < shape.row_count; ++i)
        depths.push_back(PassRows::node(shape.row_first, shape.row_step, i) * kSigma);
    for (const auto& c : chandrasekhar) {
        CAPTURE(c.albedo, c.mu);
        double sum = 0.0;
        for (std::size_t i = 0; i + 1 < depths.size(); ++i) {
            const double low = depths[i], high = depths[i + 1];
            const double u_low = totals.at(low, c.albedo), u_high = totals.at(high, c.albedo);
            sum += GaussLegendre(8).integral(low / c.mu, high / c.mu, [&](double t) {
                const double w = (t * c.mu - low) / (high - low);
                const double u1 = (1.0 - w) * u_low + w * u_high;
                return c.albedo * std::exp(-t) * (u1 + unscattered_escape(t * c.mu, 1.0));
            });
        }
        CHECK(sum == Approx(c.expected).margin(1e-4));
    }
}

// 36 comparisons, together wrong once in 1000.
TEST_CASE("the table agrees with a direct random walk, bin by bin", "[green_table]") {
    compare_with_direct_walk(20000);
}

TEST_CASE("the table agrees with a long direct random walk, bin by bin", "[green_table][.long]") {
    compare_with_direct_walk(1000000);
}
