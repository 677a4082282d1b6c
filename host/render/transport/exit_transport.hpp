// What the transports that find exits by tables share: an event's exits are sampled, put onto the surface, stored, and
// the path goes on from one of them.
#pragma once

#include <vector>

#include "host/render/transport/subsurface_transport.hpp"

namespace stokes {

class ExitTransport : public SubsurfaceTransport {
  public:
    void scatter(const SubsurfaceEvent& event) override;
    std::uint32_t code() const override { return code_; }
    bool scatters(std::uint32_t) const override { return true; }

    // TABLE_ARGUMENTS, and table16.
    virtual Arguments tables() const = 0;

  protected:
    // exits: of an event and component, where a pass lets it have more than one.
    ExitTransport(const Device& device, std::uint32_t code, int exits);

    // Exits of one map and sampler, STOKES_SAMPLER_*, of each event of a list.
    struct ExitGroup {
        std::uint32_t component, sampler;
    };
    // Those of light that meets a fluorophore, and of light that scatters.
    virtual std::vector<ExitGroup> fluorescent_exits() const = 0;
    virtual std::vector<ExitGroup> elastic_exits() const = 0;

    // Samples the exits of one group.
    virtual void sample(const SubsurfaceEvent& event, const EventRound& round);
    // Looks after exits that found no surface. Most models drop them.
    virtual void mend_exits(const SubsurfaceEvent&, std::uint32_t) {}
    // Sends the paths of one list of events on; rounds: of its groups, in the order of the groups.
    virtual void retrace(const SubsurfaceEvent& event, const std::vector<EventRound>& rounds) = 0;
    // Of a table from whose densities distances are drawn in place of its own; 0 for its own.
    virtual std::uint32_t drawn_rows(const PathSampling&) const { return 0; }

  private:
    std::vector<ExitGroup> groups_of(std::uint32_t event) const;
    void deposit(const SubsurfaceEvent& event, EventRound round);

    std::uint32_t code_, exits_;
    Kernel sample_exits_, deposit_exits_;
};

}  // namespace stokes
