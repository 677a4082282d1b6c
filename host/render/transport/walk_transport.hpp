// Random walks below surfaces, collision by collision, PHYSICS section 5. It has no tables.
#pragma once

#include "host/render/transport/subsurface_transport.hpp"

namespace stokes {

class WalkTransport : public SubsurfaceTransport {
  public:
    WalkTransport(const Device& device, const DeviceScene& on_device);

    void prepare(const PassSpectra&) override {}
    void scatter(const SubsurfaceEvent& event) override;
    std::uint32_t code() const override { return STOKES_TRANSPORT_WALK; }
    bool scatters(std::uint32_t event) const override { return event == STOKES_EVENT_ELASTIC; }

  private:
    Kernel walk_;
};

}  // namespace stokes
