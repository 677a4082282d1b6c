// The paper's transport, PHYSICS section 3: photon power tables, or in place of them every photon's own integrals.
#pragma once

#include <optional>

#include "host/render/transport/exit_transport.hpp"
#include "host/subsurface/device_table.hpp"
#include "kernels/shared/integrated_power.h"

namespace stokes {

class PaperTransport : public ExitTransport {
  public:
    // The scene outlives it.
    PaperTransport(const Device& device, const Scene& scene);

    void prepare(const PassSpectra& spectra) override;
    Arguments tables() const override;

  protected:
    std::vector<ExitGroup> fluorescent_exits() const override;
    std::vector<ExitGroup> elastic_exits() const override;
    void sample(const SubsurfaceEvent& event, const EventRound& round) override;
    void retrace(const SubsurfaceEvent& event, const std::vector<EventRound>& rounds) override;
    std::uint32_t drawn_rows(const PathSampling& sampling) const override;

  private:
    void make_tables();
    void make_mixtures();
    std::uint32_t sampler() const { return integrates_ ? STOKES_SAMPLER_INTEGRATED : STOKES_SAMPLER_PAPER; }

    Device device_;
    const Scene& scene_;
    bool integrates_, weighted_;  // weighted_: distances are drawn where more light leaves
    Kernel retrace_fluorescence_, retrace_elastic_;

    // Tables, three a medium: fluorescence, single and multiple scattering.
    Kernel resample_;
    Buffer<TableShape> shapes_;                  // [3 media]
    Buffer<float> values_;                       // [entry][lambda]
    Buffer<float> mean_rows_, cumulative_rows_;  // [entry] of the distances, then as many, DistanceSampler's weighted
    Buffer<Flux16> at_wavelengths_;              // [entry]; integrating: what each exit lets through
    Buffer<float> wavelengths_;                  // of the pass [nm]
    UniformAxis lambda_;                         // of values_ [nm]
    std::uint32_t entries_ = 0;

    // Integrating: what distances are drawn from, by medium; all 0 for media that no material needs.
    Kernel draw_exits_, integrate_;
    Buffer<DistanceMixture> mixtures_;
    Buffer<float> mixture_rows_;
    Buffer<PassMedium> media_;  // at the pass's wavelengths
};

}  // namespace stokes
