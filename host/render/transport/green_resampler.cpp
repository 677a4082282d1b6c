#include "host/render/transport/green_resampler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/error.hpp"

namespace stokes {
namespace {

constexpr std::size_t kRows = 96, kEntries = 128;

// Stands for the logarithm of nothing.
constexpr double kLeast = 1e-30;

GreenShape universal_shape(const GreenTable& table) {
    GreenShape shape{};
    shape.rho_first = static_cast<float>(table.rho[1]);
    shape.rho_step = static_cast<float>(octaves_per_node(table.rho));
    shape.rho_count = static_cast<unsigned>(table.rho.size());
    shape.z_first = static_cast<float>(table.z[1]);
    shape.z_step = static_cast<float>(octaves_per_node(table.z));
    shape.z_count = static_cast<unsigned>(table.z.size());
    return shape;
}

// log(H1/a) as [z][rho][albedo]. H1/a has a limit for a = 0, for which the first albedo above stands, and one
// for rho = 0, for which the first distance does: what reads it scales it by rho.
std::vector<float> logarithms(const GreenTable& table) {
    std::vector<float> result;
    result.reserve(table.h1.size());
    for (std::size_t z = 0; z < table.z.size(); ++z)
        for (std::size_t r = 0; r < table.rho.size(); ++r)
            for (std::size_t i = 0; i < table.albedo.size(); ++i) {
                const std::size_t a = std::max<std::size_t>(i, 1);
                const double h = table.h1[table.row(a, z) + std::max<std::size_t>(r, 1)];
                result.push_back(static_cast<float>(std::log(std::max(h / table.albedo[a], kLeast))));
            }
    return result;
}

// Depth of each row [mm].
std::vector<double> row_depths(const TableShape& shape) {
    std::vector<double> depth{0.0};
    for (std::size_t row = 1; row < shape.row_count; ++row)
        depth.push_back(static_cast<double>(shape.row_first) *
                        std::exp2(static_cast<double>(row - 1) * static_cast<double>(shape.row_step)));
    return depth;
}

// The straight lines that the kernels draw between rows lie below the probability of leaving scattered where it is
// concave over depth, near the surface, and above it where it is convex. Each value is moved by a twelfth of the second
// difference, so that every stretch of two rows holds what it should; deep down, where hardly any light comes from and
// the rows are too far apart for that, it stays.
constexpr double most_bend = 0.003;  // of a value

void bend_to_straight_lines(const std::vector<double>& depth, std::vector<Flux16>& u1) {
    const std::vector<Flux16> exact = u1;
    for (std::size_t row = 1; row + 1 < u1.size(); ++row) {
        const double d0 = depth[row] - depth[row - 1], d1 = depth[row + 1] - depth[row];
        for (std::size_t j = 0; j < STOKES_WAVELENGTHS; ++j) {
            const auto at = [&](std::size_t i) { return static_cast<double>(exact[i].v[j]); };
            const double bend =
                ((at(row + 1) - at(row)) / d1 - (at(row) - at(row - 1)) / d0) * d0 * d1 / (6.0 * (d0 + d1));
            if (std::abs(bend) < most_bend * at(row)) u1[row].v[j] = static_cast<float>(at(row) - bend);
        }
    }
}

}  // namespace

TableShape green_medium_shape(const GreenTable& table, double sigma_t_min, double sigma_t_max, std::size_t offset) {
    if (!(sigma_t_min > 0.0 && sigma_t_max >= sigma_t_min && std::isfinite(sigma_t_max)))
        throw InputError(fmt::format("extinction coefficients from {} to {} per mm: expected positive numbers",
                                     sigma_t_min, sigma_t_max));
    const auto octaves = [&](const std::vector<double>& axis, std::size_t nodes) {
        return std::log2(axis.back() / sigma_t_min / (axis[1] / sigma_t_max)) / static_cast<double>(nodes - 2);
    };
    TableShape shape{};
    shape.offset = static_cast<unsigned>(offset);
    shape.row_count = kRows;
    shape.row_first = static_cast<float>(table.z[1] / sigma_t_max);
    shape.row_step = static_cast<float>(octaves(table.z, kRows));
    shape.r_count = kEntries;
    shape.r_first = static_cast<float>(table.rho[1] / sigma_t_max);
    shape.r_step = static_cast<float>(octaves(table.rho, kEntries));
    shape.log_axes = STOKES_LOG_ROWS | STOKES_LOG_R;
    return shape;
}

GreenResampler::GreenResampler(const Device& device, const GreenTable& table)
    : universal_(universal_shape(table)),
      totals_(table),
      log_h_(device, "Green's function, logarithms", logarithms(table)),
      sigma_t_(device, "extinction coefficients of the pass", STOKES_WAVELENGTHS),
      fraction_(device, "albedo fractions of the pass", STOKES_WAVELENGTHS),
      lower_(device, "albedo nodes of the pass", STOKES_WAVELENGTHS),
      blended_(device, "Green's function of the pass", table.z.size() * table.rho.size()) {
    for (const double a : table.albedo) root_.push_back(std::sqrt(1.0 - a));
    const Program program(device, "resample_green.cl");
    blend_ = program.kernel("blend_green");
    resample_ = program.kernel("resample_green");
    normalise_ = program.kernel("normalise_green");
}

std::vector<Flux16> GreenResampler::exact_totals(const TableShape& shape, const Sixteen& sigma_t,
                                                 const Sixteen& albedo) const {
    const std::vector<double> depth = row_depths(shape);
    std::vector<Flux16> u1(depth.size());
    for (std::size_t row = 0; row < u1.size(); ++row)
        for (std::size_t j = 0; j < STOKES_WAVELENGTHS; ++j)
            u1[row].v[j] = sigma_t[j] > 0.0 ? static_cast<float>(totals_.at(sigma_t[j] * depth[row], albedo[j])) : 0.0f;
    return u1;
}

void GreenResampler::resample(const TableShape& shape, std::size_t first_row, const Sixteen& sigma_t,
                              const Sixteen& albedo, const GreenPassTables& tables) {
    std::vector<std::uint32_t> lower;
    std::vector<float> fraction, sigma(sigma_t.begin(), sigma_t.end());
    for (const double a : albedo) {
        const double root = std::sqrt(1.0 - a);
        const auto above = std::lower_bound(root_.begin(), root_.end(), root, std::greater<double>());
        const auto i =
            std::clamp<std::ptrdiff_t>(above - root_.begin() - 1, 0, static_cast<std::ptrdiff_t>(root_.size()) - 2);
        lower.push_back(static_cast<std::uint32_t>(i));
        fraction.push_back(static_cast<float>((root_[i] - root) / (root_[i] - root_[i + 1])));
    }
    std::vector<Flux16> u1 = exact_totals(shape, sigma_t, albedo);
    bend_to_straight_lines(row_depths(shape), u1);
    lower_.upload(lower);
    fraction_.upload(fraction);
    sigma_t_.upload(sigma);
    tables.u1.upload(u1.data(), u1.size(), first_row);
    const Arguments all = Arguments("shape", universal_)
                              .add("target", shape)
                              .add("first_row", static_cast<std::uint32_t>(first_row))
                              .add("log_h", log_h_)
                              .add("lower", lower_)
                              .add("fraction", fraction_)
                              .add("sigma_t", sigma_t_)
                              .add("u1", tables.u1)
                              .add("table16", tables.table16)
                              .add("mean_rows", tables.mean_rows)
                              .add("cumulative_rows", tables.cumulative_rows);
    blend_.launch(blended_.size(), all, Arguments("blended", blended_));
    resample_.launch(std::size_t{shape.row_count} * shape.r_count, all, Arguments().add("blended", blended_, "float"));
    normalise_.launch(shape.row_count, all);
}

}  // namespace stokes
