#include "host/render/stokes_shift.hpp"

#include "host/render/transport/transport_model.hpp"

namespace stokes {

StokesRule stokes_rule_of(const Fluorophore& fluorophore, Transport transport) {
    return fluorophore.stokes_rule.value_or(transport_model(transport).stokes_rule());
}

StokesFactor::StokesFactor(const Spectrum& emission, StokesRule rule)
    : by_excitation_(static_cast<std::size_t>(last_lambda_nm - first_lambda_nm + 1)) {
    for (std::size_t i = by_excitation_.size(); i-- > 0;) {
        by_excitation_[i] = sum_;  // above this wavelength
        sum_ += emission.at(first_lambda_nm + static_cast<double>(i));
    }
    for (double& above : by_excitation_)
        above = above > 0.0 ? (rule == StokesRule::keep_yield ? sum_ / above : 1.0) : 0.0;
}

}  // namespace stokes
