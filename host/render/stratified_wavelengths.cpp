#include "host/render/stratified_wavelengths.hpp"

#include <algorithm>
#include <numeric>

#include "host/render/low_discrepancy.hpp"

namespace stokes {

namespace {

// In each block of 128 passes, each level has its share of 128.
constexpr int block_bits = 7;
constexpr std::uint32_t passes_per_block = 1u << block_bits;

std::uint32_t level_of(std::uint64_t seed, std::uint32_t position) {
    double place = low_discrepancy_cell(seed, position, block_bits);
    std::uint32_t level = 0;
    while (level + 1 < level_shares.size() && place >= level_shares[level] * passes_per_block)
        place -= level_shares[level++] * passes_per_block;
    return level;
}

struct Turn {
    std::uint32_t level;
    std::uint32_t index;  // how many passes of this level come before
};

Turn turn_of(std::uint64_t seed, std::uint32_t pass) {
    const std::uint32_t block = pass / passes_per_block, position = pass % passes_per_block;
    const std::uint64_t block_seed = derived_seed(seed, block);
    const std::uint32_t level = level_of(block_seed, position);
    std::uint32_t index = block * static_cast<std::uint32_t>(level_shares[level] * passes_per_block);
    for (std::uint32_t before = 0; before < position; ++before) index += level_of(block_seed, before) == level;
    return {level, index};
}

}  // namespace

double joint_ratio(std::vector<std::uint32_t> strata) {
    std::sort(strata.begin(), strata.end());
    double ratio = 0.0;
    for (std::uint32_t level = 0; level < level_shares.size(); ++level) {
        const std::uint32_t strata_per_band = STOKES_WAVELENGTHS >> level;  // and wavelengths
        double product = level_shares[level];
        std::uint32_t before = 0;
        for (std::size_t i = 1; i < strata.size(); ++i) {
            const bool same = strata[i] / strata_per_band == strata[i - 1] / strata_per_band;
            before = same ? before + 1 : 0;
            product *= 1.0 - static_cast<double>(std::min(before, strata_per_band)) / strata_per_band;
        }
        ratio += product;
    }
    return ratio;
}

double pair_ratio(std::uint32_t a, std::uint32_t b) {
    using Pairs = std::array<std::array<double, STOKES_WAVELENGTHS>, STOKES_WAVELENGTHS>;
    static const Pairs pairs = [] {
        Pairs result;
        for (std::uint32_t i = 0; i < result.size(); ++i)
            for (std::uint32_t j = 0; j < result.size(); ++j) result[i][j] = joint_ratio({i, j});
        return result;
    }();
    return pairs[a][b];
}

StratifiedWavelengths::StratifiedWavelengths(int first_nm, const std::vector<double>& expected)
    : first_nm_(first_nm), end_(expected.size()) {
    std::partial_sum(expected.begin(), expected.end(), end_.begin());
    const double factor = STOKES_WAVELENGTHS / end_.back();
    for (double& end : end_) end *= factor;
    end_.back() = STOKES_WAVELENGTHS;
}

double StratifiedWavelengths::begin(int lambda_nm) const {
    const auto i = static_cast<std::size_t>(lambda_nm - first_nm_);
    return i == 0 ? 0.0 : end_[i - 1];
}

double StratifiedWavelengths::expected(int lambda_nm) const {
    return end_[static_cast<std::size_t>(lambda_nm - first_nm_)] - begin(lambda_nm);
}

PassWavelengths StratifiedWavelengths::draw(std::uint32_t seed, std::uint32_t pass) const {
    const std::uint64_t own_seed = derived_seed(seed, 0x57a7a1u);
    const Turn turn = turn_of(derived_seed(own_seed, level_shares.size()), pass);
    const std::uint64_t level_seed = derived_seed(own_seed, turn.level);
    const std::uint32_t per_band = STOKES_WAVELENGTHS >> turn.level;
    std::array<double, STOKES_WAVELENGTHS> places;
    for (std::uint32_t i = 0; i < places.size(); ++i)
        places[i] =
            i / per_band * per_band + per_band * low_discrepancy_number(derived_seed(level_seed, i), turn.index);
    std::sort(places.begin(), places.end());

    PassWavelengths result{};
    result.stratified = true;
    result.pair_weight_nm = image_weight_nm(first_nm(), last_nm());
    for (std::size_t k = 0; k < places.size(); ++k) {
        const auto at = std::upper_bound(end_.begin(), end_.end() - 1, places[k]);
        result.set[k] = first_nm_ + static_cast<int>(at - end_.begin());
        result.strata[k] = std::min(static_cast<std::uint32_t>(places[k]), STOKES_WAVELENGTHS - 1u);
        result.rarity[k] = 1.0 / (expected(result.set[k]) * result.pair_weight_nm);
    }
    return result;
}

}  // namespace stokes
