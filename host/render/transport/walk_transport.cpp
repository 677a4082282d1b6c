#include "host/render/transport/walk_transport.hpp"

#include <algorithm>

namespace stokes {

WalkTransport::WalkTransport(const Device& device, const DeviceScene& on_device)
    : walk_(on_device.rays.kernels.program(device, "walk_photons.cl").kernel("walk_photons")) {}

// Each path that enters a medium leaves it at most once, in one of three maps; it takes a slot in all of them.
void WalkTransport::scatter(const SubsurfaceEvent& event) {
    const EventRound round = event.round_of(STOKES_TRANSPORT_WALK, STOKES_EVENT_ELASTIC);
    if (round.count == 0) return;
    static constexpr std::array<std::array<const char*, 2>, 3> names = {{{"fluorescence_heads", "fluorescence_flux"},
                                                                         {"single_heads", "single_flux"},
                                                                         {"multiple_heads", "multiple_flux"}}};
    WalkSlots slots{};
    Arguments maps;
    std::uint32_t refused = 0;  // at most: a path is in one of the maps, or in none
    for (std::size_t m = 0; m < names.size(); ++m) {
        PhotonMap& map = event.maps[m];
        const Slots taken = event.take_slots(map, round, 1);
        slots.first[m] = taken.first;
        slots.limit[m] = taken.limit;
        refused = std::max(refused, taken.refused);
        maps.add(names[m][0], map.heads()).add(names[m][1], map.flux());
    }
    walk_.launch(round.count, Arguments("round", round).add("slots", slots), event.common, maps);
    event.counts.deposits += round.count;
    event.counts.refused_slots += refused;
}

}  // namespace stokes
