#include "host/render/photon_tracer.hpp"

#include <algorithm>
#include <utility>

#include "host/core/error.hpp"

namespace stokes {

namespace {

// Paths or list entries that one work-item counts; fixed, so that results do not depend on the device.
constexpr std::uint32_t chunk_size = 512;

// Rounds of events after which the remaining paths are cut and counted. Roulette ends nearly all long before.
constexpr std::uint32_t round_limit = 1000;

// Exits are counted in 32 bits.
constexpr std::uint64_t most_exits_at_once = 0x7fffffff;

std::uint32_t chunks_of(std::uint32_t count) { return (count + chunk_size - 1) / chunk_size; }

}  // namespace

PhotonTracer::PhotonTracer(const Device& device, const RayKernels& kernels, std::uint32_t paths)
    : device_(device),
      rays_(device, "photon rays", paths),
      hits_(device, "photon hits", paths),
      flux_(device, "photon flux", paths),
      ledgers_(device, "photon ledgers", paths),
      points_(device, "surface points", paths),
      event_words_(device, "event words", paths),
      alive_(device, "photon list", paths),
      next_alive_(device, "next photon list", paths),
      diffuse_(device, "diffuse list", paths),
      fluorescence_(device, "fluorescence list", paths),
      elastic_(device, "elastic list", paths),
      branches_(device, "list of both branches", paths),
      kinds_(device, "photon events", paths),
      chunk_counts_(device, "list counts", chunks_of(paths)),
      totals_(device, "list totals", 1),
      sums_(device, "ledger sums", chunks_of(paths)) {
    const Program emission(device, "emit_photons.cl");
    emit_ = emission.kernel("emit_photons");
    emit_stratified_ = emission.kernel("emit_stratified");
    const Program tracing = kernels.program(device, "trace_rays.cl");
    trace_ = tracing.kernel("trace_closest");
    trace_probe_ = tracing.kernel("trace_probe");
    const Program lists(device, "classify_photons.cl");
    classify_ = lists.kernel("classify_photons");
    count_ = lists.kernel("count_lists");
    scan_ = lists.kernel("scan_lists");
    write_ = lists.kernel("write_lists");
    scatter_ = Program(device, "scatter_photons.cl").kernel("scatter_diffuse");
    const Program subsurface(device, "deposit_subsurface.cl");
    sample_exits_ = subsurface.kernel("sample_exits");
    place_exits_ = subsurface.kernel("place_exits");
    deposit_ = subsurface.kernel("deposit_exits");
    const Program going_on(device, "retrace_subsurface.cl");
    retrace_fluorescence_ = going_on.kernel("retrace_fluorescence");
    retrace_elastic_ = going_on.kernel("retrace_elastic");
    retrace_exits_ = going_on.kernel("retrace_exits");
    fold_exits_ = kernels.program(device, "fold_exits.cl").kernel("fold_exits");
    sum_ = Program(device, "sum_ledgers.cl").kernel("sum_ledgers");
}

PhotonAccount PhotonTracer::trace(const DeviceScene& scene, const PassBuffers& pass, std::uint32_t photons,
                                  PhotonMaps& maps) {
    probes_traced_ = refused_slots_ = deposits_ = 0;
    emit(scene, pass, photons);
    std::uint32_t count = photons, event = 0;
    for (; count > 0; ++event) {
        trace_.launch(count, alive_, count, scene.rays.nodes, scene.rays.blocks, scene.rays.grid, rays_, hits_);
        EventRound round{};
        round.event = event;
        round.last = event + 1 >= round_limit ? 1 : 0;
        round.exits = pass.exits;
        round.branches = pass.both_branches ? 1 : 0;
        round.count = count;
        const ListCounts lists = make_lists(scene, pass, round);
        round.count = lists.diffuse;
        scatter_at_surfaces(scene, pass, round, maps[STOKES_MAP_SURFACE]);
        scatter_below_surfaces(scene, pass, round, lists, maps);
        std::swap(alive_, next_alive_);
        count = lists.alive;
    }
    return close_account(photons);
}

void PhotonTracer::emit(const DeviceScene& scene, const PassBuffers& pass, std::uint32_t photons) {
    if (pass.cell_count > 0)
        emit_stratified_.launch(photons, pass.constants, pass.cell_count, pass.cells, pass.first_photons, scene.lights,
                                scene.light_areas, scene.triangles, pass.photon_flux, rays_, flux_, ledgers_, alive_,
                                event_words_);
    else
        emit_.launch(photons, pass.constants, scene.light_count, scene.lights, scene.light_areas, scene.triangles,
                     pass.photon_flux, rays_, flux_, ledgers_, alive_);
}

// Sorts the arrived photons into the lists alive, diffuse, fluorescence, elastic, branches; the rest has ended.
ListCounts PhotonTracer::make_lists(const DeviceScene& scene, const PassBuffers& pass, const EventRound& round) {
    const std::uint32_t count = round.count, chunks = chunks_of(count);
    classify_.launch(count, round, pass.constants, alive_, rays_, hits_, flux_, scene.triangles, scene.materials,
                     scene.shapes, pass.rows, points_, ledgers_, kinds_);
    count_.launch(chunks, count, chunk_size, kinds_, chunk_counts_);
    scan_.launch(1, chunks, chunk_counts_, totals_);
    write_.launch(chunks, count, chunk_size, alive_, kinds_, chunk_counts_, next_alive_, diffuse_, fluorescence_,
                  elastic_, branches_);
    return totals_.download(1).front();
}

void PhotonTracer::scatter_at_surfaces(const DeviceScene& scene, const PassBuffers& pass, EventRound round,
                                       PhotonMap& map) {
    if (round.count == 0) return;
    const std::uint32_t slots = round.event > 0 || pass.store_direct ? round.count : 0;
    map.reserve(slots);
    round.first_slot = map.used();
    round.slot_limit = slots > 0 ? map.capacity() : 0;
    map.note_paths(diffuse_, slots, 1);
    scatter_.launch(round.count, round, pass.constants, diffuse_, points_, hits_, pass.rows, scene.textures.records,
                    scene.textures.texels, scene.textures.uv, rays_, flux_, ledgers_, map.heads(), map.flux());
    deposits_ += slots;
    refused_slots_ += map.advance(slots);
}

namespace {

// The exits of an event of both branches, by the map they go to; those of fluorescence first. Events of one branch have
// its exits alone.
struct ExitGroup {
    std::uint32_t component, sampler;
};

std::vector<ExitGroup> exit_groups(const DeviceScene& scene) {
    const std::uint32_t paper = scene.integrated ? STOKES_SAMPLER_INTEGRATED : STOKES_SAMPLER_PAPER;
    if (scene.transport == Transport::paper)
        return {{STOKES_MAP_FLUORESCENCE, paper}, {STOKES_MAP_SINGLE, paper}, {STOKES_MAP_MULTIPLE, paper}};
    return {{STOKES_MAP_FLUORESCENCE, STOKES_SAMPLER_DIRECT},
            {STOKES_MAP_FLUORESCENCE, STOKES_SAMPLER_SCATTERED},
            {STOKES_MAP_SINGLE, STOKES_SAMPLER_DIRECT},
            {STOKES_MAP_MULTIPLE, STOKES_SAMPLER_SCATTERED}};
}

bool fluoresces(const EventRound& round) { return round.component == STOKES_MAP_FLUORESCENCE; }

}  // namespace

// The list that the events of a round of exits stand in.
const Buffer<std::uint32_t>& PhotonTracer::list_of(const EventRound& round) const {
    return round.branches != 0 ? branches_ : fluoresces(round) ? fluorescence_ : elastic_;
}

// Room for this many exits; what is there may be lost.
void PhotonTracer::reserve_exits(std::uint32_t count) {
    if (count <= exits_.size()) return;
    exits_ = {};
    probes_ = {};
    probe_hits_ = {};
    powers_ = {};
    const std::size_t room = std::size_t{count} + count / 4;
    exits_ = Buffer<ExitPoint>(device_, "subsurface exits", room);
    probes_ = Buffer<Probe>(device_, "exit probes", room);
    probe_hits_ = Buffer<Hit>(device_, "exit hits", room);
}

void PhotonTracer::scatter_below_surfaces(const DeviceScene& scene, const PassBuffers& pass, const EventRound& round,
                                          const ListCounts& lists, PhotonMaps& maps) {
    const bool walking = scene.transport == Transport::walk;
    if (walking) {
        EventRound walk = round;
        walk.count = lists.elastic;
        walk_below_surfaces(scene, pass, walk, maps);
    }
    std::vector<EventRound> rounds;
    std::uint64_t all_exits = 0;
    for (const std::uint32_t branches : {0u, 1u})
        for (const ExitGroup& group : exit_groups(scene)) {
            EventRound r = round;
            r.branches = branches;
            r.component = group.component;
            r.drawn_rows = pass.weighted_distances ? scene.tables.entries : 0;
            r.sampler = group.sampler;
            r.count = branches != 0 ? lists.branches : fluoresces(r) ? lists.fluorescence : walking ? 0 : lists.elastic;
            r.first_exit = static_cast<std::uint32_t>(all_exits);
            all_exits += std::uint64_t{r.count} * r.exits;
            rounds.push_back(r);
        }
    if (all_exits == 0) return;
    if (all_exits > most_exits_at_once)
        throw RunError("too many exit points at once: expected fewer photons or exits an entry");
    const auto exits = static_cast<std::uint32_t>(all_exits);
    reserve_exits(exits);
    for (const EventRound& r : rounds) sample_exits(scene, pass, r);
    const RayScene& rays = scene.rays;
    trace_probe_.launch(exits, exits, rays.nodes, rays.blocks, rays.grid, scene.triangles, probes_, probe_hits_);
    place_exits_.launch(exits, exits, probes_, probe_hits_, scene.triangles, exits_);
    if (scene.transport == Transport::conserving)
        fold_exits_.launch(exits, exits, pass.constants, rays.nodes, rays.blocks, rays.grid, scene.triangles, probes_,
                           exits_);
    for (EventRound& r : rounds) deposit(scene, pass, r, maps[r.component]);
    probes_traced_ += exits;
    trace_on(scene, pass, rounds, maps);
}

// One group's deposits; writes its slots into the round.
void PhotonTracer::deposit(const DeviceScene& scene, const PassBuffers& pass, EventRound& round, PhotonMap& map) {
    const std::uint32_t slots = round.count * round.exits;
    map.reserve(slots);
    round.first_slot = map.used();
    round.slot_limit = map.capacity();
    map.note_paths(list_of(round), round.count, round.exits);
    deposit_.launch(round.count, round, pass.constants, points_, scene.materials, pass.rows, scene.tables.shapes,
                    scene.integrated ? powers_ : scene.tables.at_wavelengths, exits_, flux_, ledgers_, map.heads(),
                    map.flux());
    deposits_ += slots;
    refused_slots_ += map.advance(slots);
}

// One group's exits; without power tables also what leaves there.
void PhotonTracer::sample_exits(const DeviceScene& scene, const PassBuffers& pass, const EventRound& round) {
    const Buffer<std::uint32_t>& list = list_of(round);
    if (!scene.integrated) {
        sample_exits_.launch(round.count, round, pass.constants, list, points_, rays_, scene.materials, pass.rows,
                             scene.tables.shapes, scene.tables.mean_rows, scene.tables.cumulative_rows, event_words_,
                             exits_, probes_);
        return;
    }
    if (!draw_exits_) {
        const Program program(device_, "integrate_power.cl");
        draw_exits_.emplace(program.kernel("draw_exits"));
        integrate_.emplace(program.kernel("integrate_power"));
    }
    if (powers_.size() < exits_.size()) powers_ = Buffer<Flux16>(device_, "powers at exits", exits_.size());
    draw_exits_->launch(round.count, round, pass.constants, list, points_, rays_, scene.materials,
                        scene.integrated->mixtures, scene.integrated->mixture_rows, exits_, probes_);
    integrate_->launch(round.count, round, exits_, scene.materials, scene.integrated->at_wavelengths, powers_);
}

// Each path that enters a medium leaves it at most once, in one of three maps; it takes a slot in all of them.
void PhotonTracer::walk_below_surfaces(const DeviceScene& scene, const PassBuffers& pass, EventRound round,
                                       PhotonMaps& maps) {
    if (round.count == 0) return;
    if (!walk_) walk_.emplace(scene.rays.kernels.program(device_, "walk_photons.cl").kernel("walk_photons"));
    WalkSlots slots{};
    for (std::uint32_t m = 0; m < 3; ++m) {
        maps[m].reserve(round.count);
        maps[m].note_paths(elastic_, round.count, 1);
        slots.first[m] = maps[m].used();
        slots.limit[m] = maps[m].capacity();
    }
    walk_->launch(round.count, round, slots, pass.constants, elastic_, points_, scene.bodies, scene.rays.nodes,
                  scene.rays.blocks, scene.rays.grid, scene.triangles, scene.materials, pass.rows, rays_, flux_,
                  ledgers_, maps[0].heads(), maps[0].flux(), maps[1].heads(), maps[1].flux(), maps[2].heads(),
                  maps[2].flux());
    deposits_ += round.count;
    std::uint32_t refused = 0;  // the maps are of one size and grow together; a path is in one of them
    for (std::uint32_t m = 0; m < 3; ++m) refused = std::max(refused, maps[m].advance(round.count));
    refused_slots_ += refused;
}

namespace {

ExitGroups groups_of(const std::vector<EventRound>& rounds, std::size_t first, std::uint32_t count) {
    ExitGroups groups{};
    groups.count = count;
    for (std::uint32_t g = 0; g < count; ++g) {
        const EventRound& round = rounds[first + g];
        groups.component[g] = round.component;
        groups.first_exit[g] = round.first_exit;
        groups.first_slot[g] = round.first_slot;
        groups.slot_limit[g] = round.slot_limit;
    }
    return groups;
}

}  // namespace

// Sends on what left: rounds as scatter_below_surfaces made them.
void PhotonTracer::trace_on(const DeviceScene& scene, const PassBuffers& pass, const std::vector<EventRound>& rounds,
                            const PhotonMaps& maps) {
    if (scene.transport == Transport::paper) {
        for (const std::size_t first : {std::size_t{0}, std::size_t{3}}) {  // of one branch, of both
            const EventRound& fluorescence = rounds[first];
            EventRound elastic = rounds[first + 1];
            elastic.second_exit = rounds[first + 2].first_exit;
            retrace_fluorescence_.launch(fluorescence.count, fluorescence, pass.constants, exits_, scene.materials,
                                         pass.rows, maps[STOKES_MAP_FLUORESCENCE].flux(), rays_, flux_, ledgers_);
            retrace_elastic_.launch(elastic.count, elastic, pass.constants, exits_, scene.materials, rays_, flux_,
                                    ledgers_);
        }
        return;
    }
    const auto retrace = [&](std::size_t first, std::uint32_t groups) {
        const EventRound& round = rounds[first];
        retrace_exits_.launch(round.count, round, groups_of(rounds, first, groups), pass.constants, exits_,
                              scene.materials, maps[STOKES_MAP_FLUORESCENCE].flux(), maps[STOKES_MAP_SINGLE].flux(),
                              maps[STOKES_MAP_MULTIPLE].flux(), rays_, flux_, ledgers_);
    };
    retrace(0, 2);  // fluorescence
    retrace(2, 2);  // elastic
    retrace(4, 4);  // both branches
}

PhotonAccount PhotonTracer::close_account(std::uint32_t photons) {
    const std::uint32_t chunks = chunks_of(photons);
    sum_.launch(chunks, photons, chunk_size, ledgers_, sums_);
    PhotonAccount account;
    for (const LedgerSums& sums : sums_.download(chunks)) {
        for (std::size_t k = 0; k < account.energy.size(); ++k) {
            account.energy[k] += static_cast<double>(sums.light[k].energy);
            account.photons[k] += static_cast<double>(sums.light[k].photons);
        }
        for (std::size_t k = 0; k < account.fates.size(); ++k) account.fates[k] += sums.fates[k];
        account.rays += sums.rays;
        account.missed_exits += sums.missed_exits;
        account.reflections += sums.reflections;
    }
    account.rays += probes_traced_;
    account.refused_slots = refused_slots_;
    account.deposits = deposits_;
    return account;
}

}  // namespace stokes
