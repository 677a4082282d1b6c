#include "host/render/wavelength_importance.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "host/core/overloaded.hpp"
#include "host/image/colour.hpp"
#include "host/render/stokes_shift.hpp"

namespace stokes {

namespace {

constexpr double uniform_share = 0.1;
// X, Y and Z of the fluorescence all depend on what is taken up.
constexpr double excitation_share = 3.0;

using Values = std::vector<double>;  // by wavelength of the range

double total(const Values& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

class Range {
  public:
    explicit Range(const RenderSettings& render)
        : first_nm_(render.lambda_min_nm), size_(static_cast<std::size_t>(render.lambda_max_nm - first_nm_ + 1)) {
        const ColourMatching& observer = cie1931();
        for (const Spectrum* matching : {&observer.x, &observer.y, &observer.z}) eye_.push_back(of(*matching));
    }
    std::size_t size() const { return size_; }
    int first_nm() const { return first_nm_; }
    const std::vector<Values>& eye() const { return eye_; }
    Values of(const Spectrum& spectrum) const {
        Values result(size_);
        for (std::size_t i = 0; i < size_; ++i) result[i] = spectrum.at(first_nm_ + static_cast<double>(i));
        return result;
    }

  private:
    int first_nm_;
    std::size_t size_;
    std::vector<Values> eye_;
};

Values product(const Values& a, const Values& b) {
    Values result(a.size());
    std::transform(a.begin(), a.end(), b.begin(), result.begin(), std::multiplies<>());
    return result;
}

// Adds share times the square of what, brought to a sum of 1; nothing where there is none of it.
void add_square(Values& to, const Values& what, double share) {
    const double sum = total(what);
    if (!(sum > 0.0)) return;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += share * (what[i] / sum) * (what[i] / sum);
}

void add_observed_squares(Values& to, const Range& range, const Values& light, double share) {
    for (const Values& matching : range.eye()) add_square(to, product(light, matching), share);
}

// Light can be re-emitted only above where it was taken up.
Values below_emission(Values excitation, const Values& emission) {
    for (std::size_t i = excitation.size(); i-- > 0 && !(emission[i] > 0.0);) excitation[i] = 0.0;
    return excitation;
}

// What a fluorophore emits above where it takes light up, in proportion; the whole emission where no light is taken up.
Values emitted_by(const Values& taken_up, const Values& emission, const StokesFactor& stokes, int first_nm) {
    Values emitted(emission.size());
    double so_far = 0.0;  // taken up below, by what it counts
    for (std::size_t i = 0; i < emission.size(); ++i) {
        emitted[i] = emission[i] * so_far;
        so_far += taken_up[i] * stokes(first_nm + static_cast<int>(i));
    }
    return total(emitted) > 0.0 ? emitted : emission;
}

Values squares_of(const Scene& scene, const Range& range) {
    std::vector<Values> lamps, reflectances{Values(range.size(), 1.0)};
    for (const Light& light : scene.lights)
        if (lamps.emplace_back(range.of(light.flux)); !(total(lamps.back()) > 0.0)) lamps.pop_back();
    std::set<int> fluorophores;
    for (const Material& material : scene.materials) {
        const auto black = [](const BlackMaterial&) {};
        const auto diffuse = [&](const DiffuseMaterial& of) { reflectances.push_back(range.of(of.reflectance)); };
        const auto translucent = [&](const TranslucentMaterial& of) {
            for (const Dye& dye : of.dyes)
                if (dye.fraction > 0.0) fluorophores.insert(dye.fluorophore);
        };
        std::visit(Overloaded{black, diffuse, translucent}, material.kind);
    }
    const double lamp_share = 1.0 / static_cast<double>(lamps.size());
    Values squares(range.size(), 0.0);
    for (const Values& lamp : lamps)
        for (const Values& reflectance : reflectances)
            add_observed_squares(squares, range, product(lamp, reflectance),
                                 lamp_share / static_cast<double>(reflectances.size()));
    for (const int index : fluorophores) {
        const Fluorophore& fluorophore = scene.fluorophores[static_cast<std::size_t>(index)];
        const Values emission = range.of(fluorophore.emission);
        const Values excitation = below_emission(range.of(fluorophore.excitation), emission);
        const StokesFactor stokes(fluorophore.emission, stokes_rule_of(fluorophore, scene.render.transport));
        for (const Values& lamp : lamps) {
            const Values taken_up = product(lamp, excitation);
            add_square(squares, taken_up, excitation_share * lamp_share);
            add_observed_squares(squares, range, emitted_by(taken_up, emission, stokes, range.first_nm()), lamp_share);
        }
    }
    return squares;
}

// Brings the sum to 16 with no value above 1, the others in proportion.
void limit_to_one(Values& expected) {
    Values sorted = expected;
    std::sort(sorted.begin(), sorted.end());
    double rest = total(sorted), left = STOKES_WAVELENGTHS;  // of those that are not at 1
    while (left > 1.0 && sorted.back() * left > rest) {
        rest -= sorted.back();
        sorted.pop_back();
        left -= 1.0;
    }
    for (double& value : expected) value = std::min(value * left / rest, 1.0);
}

}  // namespace

Values wavelength_importance(const Scene& scene) {
    const Range range(scene.render);
    Values expected = squares_of(scene, range);
    for (double& value : expected) value = std::sqrt(value);
    const double sum = total(expected), uniform = 1.0 / static_cast<double>(range.size());
    for (double& value : expected)
        value = sum > 0.0 ? (1.0 - uniform_share) * value / sum + uniform_share * uniform : uniform;
    limit_to_one(expected);
    return expected;
}

std::optional<StratifiedWavelengths> stratified_wavelengths(const Scene& scene) {
    const RenderSettings& render = scene.render;
    if (resolved(render).wavelengths == Wavelengths::uniform ||
        render.lambda_max_nm - render.lambda_min_nm + 1 <= STOKES_WAVELENGTHS)
        return std::nullopt;
    return StratifiedWavelengths(render.lambda_min_nm, wavelength_importance(scene));
}

}  // namespace stokes
