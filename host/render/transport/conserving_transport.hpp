// The transport that conserves energy, PHYSICS section 4: exits by the Green's function of a half-space. Light of
// surfaces without a medium, which leaves where it came in, is scattered here too, for `walk` as well.
#pragma once

#include <map>
#include <memory>

#include "host/render/transport/exit_transport.hpp"
#include "host/render/transport/green_resampler.hpp"

namespace stokes {

class ConservingTransport : public ExitTransport {
  public:
    // The scene outlives it.
    ConservingTransport(const Device& device, const Scene& scene, const DeviceScene& on_device);

    void prepare(const PassSpectra& spectra) override;
    Arguments tables() const override;

  protected:
    std::vector<ExitGroup> fluorescent_exits() const override;
    std::vector<ExitGroup> elastic_exits() const override;
    void mend_exits(const SubsurfaceEvent& event, std::uint32_t count) override;
    void retrace(const SubsurfaceEvent& event, const std::vector<EventRound>& rounds) override;

  private:
    // A medium's Green's function tables with or without a reflecting surface. They are made anew for every pass.
    struct Owner {
        int medium;             // index into Scene::media
        double eta;             // of the tables: 1 where the surface does not reflect
        std::size_t first_row;  // in the probabilities of escape
        TableShape shape;
    };
    void reserve_tables(const Device& device, const Scene& scene);

    const Scene& scene_;
    Kernel fold_exits_, retrace_exits_;
    std::vector<Owner> owners_;
    std::map<double, std::unique_ptr<GreenResampler>> resamplers_;  // by refractive index
    Buffer<TableShape> shapes_;  // [medium][without, with Fresnel reflection][component]
    GreenPassTables tables_;
};

}  // namespace stokes
