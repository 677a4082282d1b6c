// Stokes' law: light is emitted only at longer wavelengths than it was taken up at.
#pragma once

#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

// The fluorophore's own rule, or that of the transport.
StokesRule stokes_rule_of(const Fluorophore& fluorophore, Transport transport);

// How much the emission above an exciting wavelength counts, over what it would without Stokes' law: 1 where it is cut
// only; where the yield is kept, its sum over all whole nanometres over the sum above. 0 where there is none above.
// Sums are over first_lambda_nm to last_lambda_nm, whatever the render's wavelengths and the set that was drawn.
class StokesFactor {
  public:
    StokesFactor(const Spectrum& emission, StokesRule rule);
    // lambda_ex_nm: in first_lambda_nm to last_lambda_nm.
    double operator()(int lambda_ex_nm) const {
        return by_excitation_[static_cast<std::size_t>(lambda_ex_nm - first_lambda_nm)];
    }
    // The emission's sum.
    double sum() const { return sum_; }

  private:
    std::vector<double> by_excitation_;
    double sum_ = 0.0;
};

}  // namespace stokes
