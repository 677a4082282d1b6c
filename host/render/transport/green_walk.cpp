#include "host/render/transport/green_walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/error.hpp"
#include "host/subsurface/escape.hpp"

namespace stokes {
namespace {

constexpr std::uint32_t kItems = 256, kMostWalksPerItem = 256;
constexpr std::uint32_t kSeed = 4;
constexpr std::size_t kAlbedos = STOKES_GREEN_ALBEDOS;

// Walks go over to diffusion at this depth, or this far below a deeper source. [mfp]
constexpr double kDeep = 16.0, kDeepBelowSource = 8.0;

// What diffusion makes of light in the deep, from exact escape probabilities: a source at great depth z lets
// escape(a) exp(-kappa(a) z) leave.
struct DeepEscape {
    double offset = 0.0, spread = 0.0;
    std::vector<double> kappa, factor;

    DeepEscape(double eta, const std::vector<double>& albedos) {
        const HalfSpaceEscape solver(eta, {kDeep});
        const auto amplitude = [&](double a) { return solver.total(a)[0] * std::exp(diffusion_decay(a) * kDeep); };
        // -log(amplitude) = kappa z_e - kappa^2 spread^2 / 2 + ..: the mean and variance of the height above
        // the surface at which light of long diffusion length seems to be absorbed.
        const double near = 0.9999, far = 0.999;
        const double k1 = diffusion_decay(near), k2 = diffusion_decay(far);
        const double e1 = -std::log(amplitude(near)) / k1, e2 = -std::log(amplitude(far)) / k2;
        const double slope = (e2 - e1) / (k2 - k1);
        const double mean = e1 - slope * k1;
        spread = std::min(std::sqrt(std::max(-2.0 * slope, 0.0)), mean);
        offset = mean - spread;
        for (const double a : albedos) {
            const double k = diffusion_decay(a);
            kappa.push_back(k);
            factor.push_back(amplitude(a) * std::exp(k * offset) * (1.0 + k * spread));
        }
    }
};

void put_pair(std::vector<Flux16>& rows, std::size_t first, const std::vector<double>& values) {
    for (std::size_t i = 0; i < kAlbedos; ++i) rows[first + i / 16].v[i % 16] = static_cast<float>(values[i]);
}

// Walks from the deep take long, and their light leaves spread out and smooth: they are fewer.
std::uint64_t walks_from(double z, std::uint64_t walks) {
    return static_cast<std::uint64_t>(std::ceil(static_cast<double>(walks) / (1.0 + 0.25 * z)));
}

// Densities at the nodes from the escapes per bin. In bins of equal width in log(rho) the mean of the density
// m over log(rho) exceeds that at the centre by m''/24. Near the foot the density per area is flat over a
// small part of the depth, and few walks go there: it is taken from all of them.
void fill_row(GreenTable& table, std::size_t z, std::size_t a, const std::vector<double>& escape) {
    const std::size_t nodes = table.rho.size();
    const double width = octaves_per_node(table.rho) * std::log(2.0);
    const auto mass = [&](std::size_t bin) { return bin >= 1 && bin < nodes ? escape[bin * kAlbedos + a] : 0.0; };
    float* h = &table.h1[table.row(a, z)];
    h[0] = 0.0f;
    for (std::size_t i = 1; i < nodes; ++i) {
        const double before = i > 1 ? mass(i - 1) : mass(1), after = i + 1 < nodes ? mass(i + 1) : mass(i);
        const double sharpened = mass(i) - (after - 2.0 * mass(i) + before) / 24.0;
        h[i] = static_cast<float>(std::max(sharpened, 0.5 * mass(i)) / (width * table.rho[i]));
    }
    constexpr double flat = 0.1;
    double inside = escape[a];
    std::size_t last = 0;
    while (last + 1 < nodes && table.rho[last + 1] < flat * table.z[z]) inside += mass(++last);
    if (last == 0) return;
    const double edge = table.rho[last] * std::exp(0.5 * width);
    for (std::size_t i = 1; i <= last; ++i) h[i] = static_cast<float>(2.0 * table.rho[i] * inside / (edge * edge));
}

}  // namespace

GreenWalker::GreenWalker(const Device& device, const GreenTable& nodes)
    : bins_(nodes.rho.size()),
      kernel_(Program(device, "walk_green.cl").kernel("walk_green")),
      albedos_(device, "albedos of the random walk", 6),
      histograms_(device, "histograms of the random walk", kItems * bins_ * 2) {
    if (nodes.albedo.size() != kAlbedos)
        throw InputError(fmt::format("{} albedos: expected {}", nodes.albedo.size(), kAlbedos));
    const DeepEscape deep(nodes.eta, nodes.albedo);
    std::vector<Flux16> rows(6);
    put_pair(rows, 0, nodes.albedo);
    put_pair(rows, 2, deep.kappa);
    put_pair(rows, 4, deep.factor);
    albedos_.upload(rows);
    parameters_.eta = static_cast<float>(nodes.eta);
    parameters_.critical_cosine = static_cast<float>(std::sqrt(1.0 - 1.0 / (nodes.eta * nodes.eta)));
    parameters_.deep_offset = static_cast<float>(deep.offset);
    parameters_.deep_spread = static_cast<float>(deep.spread);
    parameters_.rho_first = static_cast<float>(nodes.rho[1]);
    parameters_.bins_per_octave = static_cast<float>(1.0 / octaves_per_node(nodes.rho));
    parameters_.bins = static_cast<unsigned>(bins_);
    parameters_.seed = kSeed;
    parameters_.items = kItems;
}

GreenScores GreenWalker::walk(double source_depth, std::uint32_t stream, std::uint64_t walks,
                              const std::function<void(std::uint64_t)>& done) {
    GreenWalk launch = parameters_;
    launch.source_depth = static_cast<float>(source_depth);
    launch.deep = static_cast<float>(std::max(kDeep, source_depth + kDeepBelowSource));
    launch.stream = stream;
    launch.walks_per_item =
        static_cast<unsigned>(std::clamp<std::uint64_t>((walks + kItems - 1) / kItems, 1, kMostWalksPerItem));
    const std::uint64_t per_launch = std::uint64_t{kItems} * launch.walks_per_item;

    GreenScores scores{std::vector<double>(bins_ * kAlbedos), std::vector<double>(kAlbedos),
                       std::vector<double>(kAlbedos)};
    std::vector<double> squares(kAlbedos);
    std::uint64_t walked = 0, items = 0;
    while (walked < walks) {
        launch.first_walk = static_cast<unsigned>(walked);
        kernel_.launch(kItems, Arguments("walk", launch).add("albedos", albedos_).add("histograms", histograms_));
        const std::vector<Flux16> histograms = histograms_.download();
        for (std::size_t item = 0; item < kItems; ++item) {
            double total[kAlbedos] = {};
            for (std::size_t bin = 0; bin < bins_; ++bin)
                for (std::size_t a = 0; a < kAlbedos; ++a) {
                    const double value = histograms[(item * bins_ + bin) * 2 + a / 16].v[a % 16];
                    scores.escape[bin * kAlbedos + a] += value;
                    total[a] += value;
                }
            for (std::size_t a = 0; a < kAlbedos; ++a) {
                scores.total[a] += total[a];
                squares[a] += total[a] * total[a];
            }
        }
        items += kItems;
        walked += per_launch;
        if (done) done(walked);
    }
    const auto n = static_cast<double>(items), per_walk = 1.0 / static_cast<double>(walked);
    for (double& value : scores.escape) value *= per_walk;
    for (std::size_t a = 0; a < kAlbedos; ++a) {
        const double variance = (squares[a] - scores.total[a] * scores.total[a] / n) / (n - 1.0);
        scores.standard_error[a] = std::sqrt(std::max(variance, 0.0) * n) * per_walk;
        scores.total[a] *= per_walk;
    }
    return scores;
}

GreenTable make_green_table(const Device& device, double eta, std::uint64_t walks, const GreenProgress& progress) {
    if (walks == 0 || walks > 0xffff0000u)
        throw InputError(fmt::format("{} walks: expected a number from 1 to {}", walks, 0xffff0000u));
    GreenTable table = green_table_nodes(eta);
    table.h1.assign(table.rho.size() * table.z.size() * table.albedo.size(), 0.0f);
    GreenWalker walker(device, table);
    double all = 0.0, before = 0.0;
    const auto cost_of = [](double z) { return (1.0 + z) / (1.0 + 0.25 * z); };  // roughly
    for (const double z : table.z) all += cost_of(z);
    for (std::size_t z = 0; z < table.z.size(); ++z) {
        const std::uint64_t count = walks_from(table.z[z], walks);
        const double cost = cost_of(table.z[z]);
        const auto done = [&](std::uint64_t walked) {
            const double share = std::min(static_cast<double>(walked) / static_cast<double>(count), 1.0);
            if (progress) progress((before + share * cost) / all);
        };
        const GreenScores scores = walker.walk(table.z[z], static_cast<std::uint32_t>(z), count, done);
        for (std::size_t a = 0; a < table.albedo.size(); ++a) fill_row(table, z, a, scores.escape);
        before += cost;
    }
    smooth_green_rows(table);
    normalise_green_rows(table);
    return table;
}

}  // namespace stokes
