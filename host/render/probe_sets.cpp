#include "host/render/probe_sets.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <string>

#include "host/core/error.hpp"

namespace stokes {

namespace {

constexpr std::size_t read_per_set = STOKES_WAVELENGTHS - 1;

std::array<double, STOKES_WAVELENGTHS> chain_weights(const ProbeGrid& grid) {
    const double emitting = static_cast<double>(grid.emitting.size()), drawn = read_per_set;
    std::array<double, STOKES_WAVELENGTHS> chain{};
    chain[0] = 1.0;
    for (std::size_t i = 1; i < chain.size(); ++i) {
        const double k = static_cast<double>(i);
        const double weight = emitting > drawn && k < drawn ? (emitting - k) / (drawn - k) : 1.0;
        chain[i] = weight * grid.step_nm / probe_pair_weight_nm(grid);
    }
    return chain;
}

// The nanometre that stands for a step in a batch.
struct Drawn {
    int lambda_nm;
    double rarity;
    int read;
};

Drawn draw_nanometre(const ProbeStep& step, int step_nm, std::mt19937_64& generator) {
    const double sum = std::accumulate(step.emission.begin(), step.emission.end(), 0.0);
    std::size_t i = 0;
    if (step.lambda_nm.size() > 1) {
        constexpr double draws = 9007199254740992.0;  // 2^53
        double place = sum * (static_cast<double>(generator() >> 11) / draws);
        while (i + 1 < step.lambda_nm.size() && place >= step.emission[i]) place -= step.emission[i++];
    }
    return {step.lambda_nm[i], sum / step.emission[i] / step_nm, step.read};
}

// Those from first to last of order are read; others of it, then spare wavelengths fill the set.
ProbeSet make_set(const ProbeGrid& grid, const std::vector<Drawn>& order, std::size_t first, std::size_t last) {
    ProbeSet result{};
    result.wavelengths.pair_weight_nm = probe_pair_weight_nm(grid);
    result.wavelengths.chain = chain_weights(grid);
    std::vector<Drawn> members{{grid.lambda_ex_nm, 1.0, -1}};
    for (std::size_t i = first; i < last; ++i) members.push_back(order[i]);
    for (std::size_t i = 0; i < first && members.size() < STOKES_WAVELENGTHS; ++i)
        members.push_back({order[i].lambda_nm, order[i].rarity, -1});
    const auto is_member = [&](int lambda) {
        return std::any_of(members.begin(), members.end(),
                           [&](const Drawn& member) { return member.lambda_nm == lambda; });
    };
    for (std::size_t i = 0; i < grid.spare.size() && members.size() < STOKES_WAVELENGTHS; ++i)
        if (!is_member(grid.spare[i])) members.push_back({grid.spare[i], 1.0, -1});
    if (members.size() < STOKES_WAVELENGTHS)
        throw InputError("a measurement at " + std::to_string(grid.lambda_ex_nm) + " nm: expected at least " +
                         std::to_string(STOKES_WAVELENGTHS) + " wavelengths, got " + std::to_string(members.size()) +
                         "; a smaller step or a wider range has more");
    std::sort(members.begin(), members.end(), [](const Drawn& a, const Drawn& b) { return a.lambda_nm < b.lambda_nm; });
    for (std::size_t i = 0; i < members.size(); ++i) {
        result.wavelengths.set[i] = members[i].lambda_nm;
        result.wavelengths.rarity[i] = members[i].rarity;
        result.read[i] = members[i].read;
        if (members[i].lambda_nm == grid.lambda_ex_nm) result.excitation = i;
    }
    return result;
}

}  // namespace

std::size_t probe_set_count(const ProbeGrid& grid) {
    return std::max<std::size_t>((grid.emitting.size() + read_per_set - 1) / read_per_set, 1);
}

double probe_pair_weight_nm(const ProbeGrid& grid) {
    return grid.step_nm * std::max(static_cast<double>(grid.emitting.size()) / read_per_set, 1.0);
}

std::vector<ProbeSet> probe_sets(const ProbeGrid& grid, std::uint32_t seed, std::uint32_t batch) {
    std::seed_seq sequence{seed, batch, 0x9120beu};
    std::mt19937_64 generator(sequence);
    std::vector<Drawn> order;
    for (const ProbeStep& step : grid.emitting) order.push_back(draw_nanometre(step, grid.step_nm, generator));
    for (std::size_t i = 0; i + 1 < order.size(); ++i)
        std::swap(order[i], order[i + uniform_below(generator, order.size() - i)]);
    std::vector<ProbeSet> sets;
    for (std::size_t first = 0; sets.size() < probe_set_count(grid); first += read_per_set)
        sets.push_back(
            make_set(grid, order, std::min(first, order.size()), std::min(first + read_per_set, order.size())));
    return sets;
}

}  // namespace stokes
