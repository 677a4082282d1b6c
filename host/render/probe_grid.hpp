// Which wavelengths a virtual spectrofluorometer reads, by excitation.
#pragma once

#include <optional>
#include <vector>

#include "host/render/probe.hpp"
#include "host/render/probe_sets.hpp"

namespace stokes {

class ProbeGrids {
  public:
    // Both outlive it.
    ProbeGrids(const ProbeMaterial& material, const ProbeSettings& settings);

    // lambda_min_nm + n step_nm, up to lambda_max_nm.
    const std::vector<int>& read_nm() const { return read_nm_; }

    // The grid of a beam of one wavelength, which it reads too. Every whole nanometre of the range that can fluoresce
    // is in one of its steps.
    ProbeGrid at(int lambda_ex_nm) const;

  private:
    std::optional<int> read_at(int lambda_nm) const;
    void add_steps(ProbeGrid& grid, bool again) const;
    bool is_taken_up(int lambda_nm) const;
    bool is_taken_up_again(int lambda_ex_nm) const;
    double emission_at(int lambda_nm) const { return emission_[static_cast<std::size_t>(lambda_nm - first_lambda_nm)]; }

    const ProbeMaterial& material_;
    const ProbeSettings& settings_;
    std::vector<int> read_nm_;
    std::vector<double> emission_;  // of the dyes together, from first_lambda_nm on: shares of their emissions
};

}  // namespace stokes
