#include "host/render/probe_sets.hpp"

#include <algorithm>
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

// The wavelengths from first to last of order are read; others of it, then spare ones fill the set.
ProbeSet make_set(const ProbeGrid& grid, const std::vector<int>& order, std::size_t first, std::size_t last) {
    ProbeSet result{};
    result.wavelengths.pair_weight_nm = probe_pair_weight_nm(grid);
    result.wavelengths.chain = chain_weights(grid);
    std::vector<int> members{grid.lambda_ex_nm};
    members.insert(members.end(), order.begin() + first, order.begin() + last);
    for (std::size_t i = 0; i < first && members.size() < STOKES_WAVELENGTHS; ++i) members.push_back(order[i]);
    for (std::size_t i = 0; i < grid.spare.size() && members.size() < STOKES_WAVELENGTHS; ++i)
        members.push_back(grid.spare[i]);
    if (members.size() < STOKES_WAVELENGTHS)
        throw InputError("a measurement at " + std::to_string(grid.lambda_ex_nm) + " nm: expected at least " +
                         std::to_string(STOKES_WAVELENGTHS) + " wavelengths, got " + std::to_string(members.size()) +
                         "; a smaller step or a wider range has more");
    std::sort(members.begin(), members.end());
    std::copy(members.begin(), members.end(), result.wavelengths.set.begin());
    const auto place = [](const std::vector<int>& list, int lambda) {
        return std::lower_bound(list.begin(), list.end(), lambda) - list.begin();
    };
    result.excitation = static_cast<std::size_t>(place(members, grid.lambda_ex_nm));
    result.read.fill(-1);
    for (std::size_t i = first; i < last; ++i)
        result.read[static_cast<std::size_t>(place(members, order[i]))] =
            static_cast<int>(place(grid.lambda_nm, order[i]));
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
    std::vector<int> order = grid.emitting;
    for (std::size_t i = 0; i + 1 < order.size(); ++i)
        std::swap(order[i], order[i + uniform_below(generator, order.size() - i)]);
    std::vector<ProbeSet> sets;
    for (std::size_t first = 0; sets.size() < probe_set_count(grid); first += read_per_set)
        sets.push_back(
            make_set(grid, order, std::min(first, order.size()), std::min(first + read_per_set, order.size())));
    return sets;
}

}  // namespace stokes
