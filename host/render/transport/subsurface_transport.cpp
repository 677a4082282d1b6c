#include "host/render/transport/subsurface_transport.hpp"

namespace stokes {

ResolvedSettings settings_of(const RenderSettings& render, Transport transport) {
    RenderSettings own = render;
    own.transport = transport;
    return resolved(own);
}

SubsurfaceExits::SubsurfaceExits(const Device& device, const RayKernels& kernels)
    : device_(device),
      trace_probe_(kernels.program(device, "trace_rays.cl").kernel("trace_probe")),
      place_exits_(Program(device, "deposit_subsurface.cl").kernel("place_exits")) {}

void SubsurfaceExits::reserve(std::uint32_t count) {
    if (count <= exits_.size()) return;
    exits_ = {};
    probes_ = {};
    probe_hits_ = {};
    flux_ = {};
    arguments_ = {};
    const std::size_t room = std::size_t{count} + count / 4;
    exits_ = Buffer<ExitPoint>(device_, "subsurface exits", room);
    probes_ = Buffer<Probe>(device_, "exit probes", room);
    probe_hits_ = Buffer<Hit>(device_, "exit hits", room);
    flux_ = Buffer<Flux16>(device_, "flux at exits", room);
    arguments_.add("exits", exits_).add("probes", probes_).add("probe_hits", probe_hits_).add("exit_flux", flux_);
}

void SubsurfaceExits::find_surfaces(std::uint32_t count, const Arguments& common) const {
    trace_probe_.launch(count, Arguments("n", count), common, arguments_);
    place_exits_.launch(count, Arguments("count", count), common, arguments_);
}

EventRound SubsurfaceEvent::round_of(std::uint32_t transport, std::uint32_t event) const {
    const std::uint32_t list = STOKES_LIST_BELOW(transport, event);
    EventRound result = round;
    result.count = lists.count[list];
    result.first_entry = lists.first[list];
    result.branches = event == STOKES_EVENT_BRANCHES ? 1 : 0;
    return result;
}

Slots SubsurfaceEvent::take_slots(PhotonMap& map, const EventRound& of, std::uint32_t deposits_each) const {
    const std::uint32_t deposits = of.count * deposits_each;
    map.reserve(deposits);
    Slots slots;
    slots.first = map.used();
    slots.limit = deposits > 0 ? map.capacity() : 0;
    map.note_paths(common, of.first_entry, of.count, deposits_each);
    slots.refused = map.advance(deposits);
    return slots;
}

}  // namespace stokes
