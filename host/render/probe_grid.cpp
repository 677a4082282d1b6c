#include "host/render/probe_grid.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "host/render/transport/transport_model.hpp"

namespace stokes {

ProbeGrids::ProbeGrids(const ProbeMaterial& material, const ProbeSettings& settings)
    : material_(material),
      settings_(settings),
      emission_(static_cast<std::size_t>(last_lambda_nm - first_lambda_nm + 1)) {
    for (int lambda = settings.lambda_min_nm; lambda <= settings.lambda_max_nm; lambda += settings.step_nm)
        read_nm_.push_back(lambda);
    for (const ProbeDye& dye : material.dyes) {
        const double share = dye.fraction / dye.fluorophore.emission.sum_1nm();
        for (std::size_t i = 0; i < emission_.size(); ++i)
            emission_[i] += share * dye.fluorophore.emission.at(first_lambda_nm + static_cast<double>(i));
    }
}

// The wavelength of the grid that a whole nanometre is read at: the nearest, the lower of two, and of those beyond its
// end the last. None below lambda_min_nm.
std::optional<int> ProbeGrids::read_at(int lambda_nm) const {
    const int above = lambda_nm - settings_.lambda_min_nm;
    if (above < 0) return std::nullopt;
    const auto nearest = static_cast<std::size_t>((2 * above + settings_.step_nm - 1) / (2 * settings_.step_nm));
    return read_nm_[std::min(nearest, read_nm_.size() - 1)];
}

// Whole nanometres above the excitation that emit make the steps of the grid. Where light may be re-radiated again each
// one is a step, since two of a step are never drawn together.
void ProbeGrids::add_steps(ProbeGrid& grid, bool again) const {
    grid.step_nm = again ? 1 : settings_.step_nm;
    std::optional<int> before;
    for (int lambda = grid.lambda_ex_nm + 1; lambda <= settings_.lambda_max_nm; ++lambda) {
        const std::optional<int> read = read_at(lambda);
        if (!(emission_at(lambda) > 0.0) || (!read && !again)) continue;
        if (again || grid.emitting.empty() || read != before) grid.emitting.emplace_back();
        before = read;
        ProbeStep& step = grid.emitting.back();
        if (read)
            step.read = static_cast<int>(std::lower_bound(grid.lambda_nm.begin(), grid.lambda_nm.end(), *read) -
                                         grid.lambda_nm.begin());
        step.lambda_nm.push_back(lambda);
        step.emission.push_back(emission_at(lambda));
    }
}

// Whether light that is emitted above the excitation can be taken up there.
bool ProbeGrids::is_taken_up_again(int lambda_ex_nm) const {
    if (!transport_model(settings_.transport).takes_up_again(settings_.first_collision_only)) return false;
    for (int lambda = lambda_ex_nm + 1; lambda <= settings_.lambda_max_nm; ++lambda)
        if (emission_at(lambda) > 0.0 && is_taken_up(lambda)) return true;
    return false;
}

bool ProbeGrids::is_taken_up(int lambda_nm) const {
    return std::any_of(material_.dyes.begin(), material_.dyes.end(), [&](const ProbeDye& dye) {
        return dye.fraction > 0.0 && dye.fluorophore.excitation.at(lambda_nm) > 0.0;
    });
}

ProbeGrid ProbeGrids::at(int lambda_ex_nm) const {
    ProbeGrid grid;
    grid.lambda_ex_nm = lambda_ex_nm;
    grid.step_nm = settings_.step_nm;
    grid.lambda_nm = read_nm_;
    const auto place = std::lower_bound(grid.lambda_nm.begin(), grid.lambda_nm.end(), lambda_ex_nm);
    if (place == grid.lambda_nm.end() || *place != lambda_ex_nm) grid.lambda_nm.insert(place, lambda_ex_nm);

    // Light that one dye emits may be taken up by another.
    const bool fluoresces = is_taken_up(lambda_ex_nm), again = fluoresces && is_taken_up_again(lambda_ex_nm);
    if (fluoresces) add_steps(grid, again);

    const int last_nm = grid.emitting.empty() ? 0 : grid.emitting.back().lambda_nm.back();
    for (int lambda = first_lambda_nm; lambda <= last_lambda_nm; ++lambda) {
        const bool inert = !again || lambda < lambda_ex_nm || lambda > last_nm || !(emission_at(lambda) > 0.0);
        if (lambda != lambda_ex_nm && inert) grid.spare.push_back(lambda);
    }
    // The nearest have the most similar mean free paths, which keeps weights near one.
    std::stable_sort(grid.spare.begin(), grid.spare.end(),
                     [&](int a, int b) { return std::abs(a - lambda_ex_nm) < std::abs(b - lambda_ex_nm); });
    return grid;
}

}  // namespace stokes
