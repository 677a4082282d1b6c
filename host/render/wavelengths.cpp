#include "host/render/wavelengths.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "host/core/error.hpp"
#include "host/render/stratified_wavelengths.hpp"

namespace stokes {

std::uint64_t uniform_below(std::mt19937_64& generator, std::uint64_t bound) {
    const std::uint64_t limit = generator.max() - generator.max() % bound;
    std::uint64_t draw = generator();
    while (draw >= limit) draw = generator();
    return draw % bound;
}

WavelengthSet draw_wavelengths(std::uint32_t seed, std::uint32_t pass, int first_nm, int last_nm) {
    if (last_nm - first_nm + 1 < STOKES_WAVELENGTHS)
        throw InputError("wavelength range " + std::to_string(first_nm) + ".." + std::to_string(last_nm) +
                         " nm: expected at least " + std::to_string(STOKES_WAVELENGTHS) + " integers");
    std::seed_seq sequence{seed, pass, 0x5707e5u};
    std::mt19937_64 generator(sequence);
    std::vector<int> all(static_cast<std::size_t>(last_nm - first_nm + 1));
    std::iota(all.begin(), all.end(), first_nm);
    WavelengthSet set;
    for (std::size_t i = 0; i < set.size(); ++i) {  // Fisher-Yates, as far as needed
        std::swap(all[i], all[i + uniform_below(generator, all.size() - i)]);
        set[i] = all[i];
    }
    std::sort(set.begin(), set.end());
    return set;
}

double image_weight_nm(int first_nm, int last_nm) { return double(last_nm - first_nm + 1) / STOKES_WAVELENGTHS; }

double pair_weight_nm(int first_nm, int last_nm) { return double(last_nm - first_nm) / (STOKES_WAVELENGTHS - 1); }

// Light at a wavelength has the rarity of that one already: of the pair's weight, 1/(m m joint_ratio) where they are
// stratified, the emitted one's share is left.
double PassWavelengths::weight_nm(std::size_t ex, std::size_t em) const {
    return pair_weight_nm * rarity[em] / (stratified ? pair_ratio(strata[ex], strata[em]) : 1.0);
}

}  // namespace stokes
