#include "host/render/transport/exit_transport.hpp"

#include "host/core/error.hpp"

namespace stokes {

namespace {

// Exits are counted in 32 bits.
constexpr std::uint64_t most_exits_at_once = 0x7fffffff;

}  // namespace

ExitTransport::ExitTransport(const Device& device, std::uint32_t code, int exits)
    : code_(code), exits_(static_cast<std::uint32_t>(exits)) {
    const Program program(device, "deposit_subsurface.cl");
    sample_exits_ = program.kernel("sample_exits");
    deposit_exits_ = program.kernel("deposit_exits");
}

void ExitTransport::scatter(const SubsurfaceEvent& event) {
    std::vector<std::vector<EventRound>> lists;
    std::uint64_t all_exits = 0;
    for (const std::uint32_t kind : {STOKES_EVENT_FLUORESCENCE, STOKES_EVENT_ELASTIC, STOKES_EVENT_BRANCHES}) {
        lists.emplace_back();
        for (const ExitGroup& group : groups_of(kind)) {
            EventRound round = event.round_of(code_, kind);
            round.component = group.component;
            round.sampler = group.sampler;
            round.exits = event.sampling.many_exits ? exits_ : 1;
            round.drawn_rows = drawn_rows(event.sampling);
            round.first_exit = static_cast<std::uint32_t>(all_exits);
            all_exits += std::uint64_t{round.count} * round.exits;
            lists.back().push_back(round);
        }
    }
    if (all_exits == 0) return;
    if (all_exits > most_exits_at_once)
        throw RunError("too many exit points at once: expected fewer photons per pass, or fewer exits");
    const auto count = static_cast<std::uint32_t>(all_exits);
    event.exits.reserve(count);
    for (const auto& rounds : lists)
        for (const EventRound& round : rounds) sample(event, round);
    event.exits.find_surfaces(count, event.common);
    mend_exits(event, count);
    for (const auto& rounds : lists)
        for (const EventRound& round : rounds) deposit(event, round);
    event.counts.probes += count;
    for (const auto& rounds : lists) retrace(event, rounds);
}

std::vector<ExitTransport::ExitGroup> ExitTransport::groups_of(std::uint32_t event) const {
    std::vector<ExitGroup> groups;
    if (event != STOKES_EVENT_ELASTIC) groups = fluorescent_exits();
    if (event == STOKES_EVENT_FLUORESCENCE) return groups;
    for (const ExitGroup& group : elastic_exits()) groups.push_back(group);
    return groups;
}

void ExitTransport::sample(const SubsurfaceEvent& event, const EventRound& round) {
    sample_exits_.launch(round.count, Arguments("round", round), event.common, tables(), event.exits.arguments());
}

void ExitTransport::deposit(const SubsurfaceEvent& event, EventRound round) {
    PhotonMap& map = event.maps[round.component];
    const Slots slots = event.take_slots(map, round, round.exits);
    round.first_slot = slots.first;
    round.slot_limit = slots.limit;
    deposit_exits_.launch(round.count, Arguments("round", round), event.common, tables(), event.exits.arguments(),
                          map.arguments());
    event.counts.deposits += std::uint64_t{round.count} * round.exits;
    event.counts.refused_slots += slots.refused;
}

}  // namespace stokes
