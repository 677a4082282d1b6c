#include "host/render/photon_tracer.hpp"

#include <algorithm>
#include <utility>

namespace stokes {

namespace {

// Paths or list entries that one work-item counts; fixed, so that results do not depend on the device.
constexpr std::uint32_t chunk_size = 512;

// Rounds of events after which the remaining paths are cut and counted. Roulette ends nearly all long before.
constexpr std::uint32_t round_limit = 1000;

std::uint32_t chunks_of(std::uint32_t count) { return (count + chunk_size - 1) / chunk_size; }

}  // namespace

PhotonTracer::PhotonTracer(const Device& device, const RayKernels& kernels, std::uint32_t paths)
    : device_(device),
      rays_(device, "photon rays", paths),
      hits_(device, "photon hits", paths),
      flux_(device, "photon flux", paths),
      ledgers_(device, "photon ledgers", paths),
      points_(device, "surface points", paths),
      alive_(device, "photon list", paths),
      next_alive_(device, "next photon list", paths),
      diffuse_(device, "diffuse list", paths),
      fluorescence_(device, "fluorescence list", paths),
      elastic_(device, "elastic list", paths),
      kinds_(device, "photon events", paths),
      chunk_counts_(device, "list counts", chunks_of(paths)),
      totals_(device, "list totals", 1),
      exits_(device, "subsurface exits", std::size_t{2} * paths),
      probes_(device, "exit probes", std::size_t{2} * paths),
      probe_hits_(device, "exit hits", std::size_t{2} * paths),
      sums_(device, "ledger sums", chunks_of(paths)) {
    emit_ = Program(device, "emit_photons.cl").kernel("emit_photons");
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
    retrace_fluorescence_ = subsurface.kernel("retrace_fluorescence");
    retrace_elastic_ = subsurface.kernel("retrace_elastic");
    retrace_exits_ = subsurface.kernel("retrace_exits");
    fold_exits_ = kernels.program(device, "fold_exits.cl").kernel("fold_exits");
    sum_ = Program(device, "sum_ledgers.cl").kernel("sum_ledgers");
}

PhotonAccount PhotonTracer::trace(const DeviceScene& scene, const PassBuffers& pass, std::uint32_t photons,
                                  PhotonMaps& maps) {
    probes_traced_ = refused_slots_ = deposits_ = 0;
    emit_.launch(photons, pass.constants, scene.light_count, scene.lights, scene.light_areas, scene.triangles,
                 pass.photon_flux, rays_, flux_, ledgers_, alive_);
    std::uint32_t count = photons, event = 0;
    for (; count > 0; ++event) {
        trace_.launch(count, alive_, count, scene.rays.nodes, scene.rays.blocks, scene.rays.grid, rays_, hits_);
        EventRound round{};
        round.event = event;
        round.last = event + 1 >= round_limit ? 1 : 0;
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

// Sorts the arrived photons into the lists alive, diffuse, fluorescence, elastic; the rest has ended.
ListCounts PhotonTracer::make_lists(const DeviceScene& scene, const PassBuffers& pass, const EventRound& round) {
    const std::uint32_t count = round.count, chunks = chunks_of(count);
    classify_.launch(count, round, pass.constants, alive_, rays_, hits_, flux_, scene.triangles, scene.materials,
                     scene.shapes, pass.rows, points_, ledgers_, kinds_);
    count_.launch(chunks, count, chunk_size, kinds_, chunk_counts_);
    scan_.launch(1, chunks, chunk_counts_, totals_);
    write_.launch(chunks, count, chunk_size, alive_, kinds_, chunk_counts_, next_alive_, diffuse_, fluorescence_,
                  elastic_);
    return totals_.download(1).front();
}

void PhotonTracer::scatter_at_surfaces(const DeviceScene& scene, const PassBuffers& pass, EventRound round,
                                       PhotonMap& map) {
    if (round.count == 0) return;
    map.reserve(round.count);
    round.first_slot = map.used();
    round.slot_limit = map.capacity();
    scatter_.launch(round.count, round, pass.constants, diffuse_, points_, hits_, pass.rows,
                    scene.textures.records, scene.textures.texels, scene.textures.uv, rays_, flux_, ledgers_,
                    map.heads(), map.flux());
    deposits_ += round.count;
    refused_slots_ += map.advance(round.count);
}

namespace {

// The exits of one list of events that go to one map.
struct ExitGroup {
    std::uint32_t component, sampler;
    bool fluorescent;  // of the list of fluorescence, else of the elastic one
};

// A list's groups follow each other, those of fluorescence first.
std::vector<ExitGroup> exit_groups(const DeviceScene& scene) {
    const std::uint32_t paper = scene.integrated ? STOKES_SAMPLER_INTEGRATED : STOKES_SAMPLER_PAPER;
    if (scene.transport == Transport::paper)
        return {{STOKES_MAP_FLUORESCENCE, paper, true},
                {STOKES_MAP_SINGLE, paper, false},
                {STOKES_MAP_MULTIPLE, paper, false}};
    return {{STOKES_MAP_FLUORESCENCE, STOKES_SAMPLER_DIRECT, true},
            {STOKES_MAP_FLUORESCENCE, STOKES_SAMPLER_SCATTERED, true},
            {STOKES_MAP_SINGLE, STOKES_SAMPLER_DIRECT, false},
            {STOKES_MAP_MULTIPLE, STOKES_SAMPLER_SCATTERED, false}};
}

}  // namespace

void PhotonTracer::scatter_below_surfaces(const DeviceScene& scene, const PassBuffers& pass, const EventRound& round,
                                          const ListCounts& lists, PhotonMaps& maps) {
    const bool walking = scene.transport == Transport::walk;
    if (walking) {
        EventRound walk = round;
        walk.count = lists.elastic;
        walk_below_surfaces(scene, pass, walk, maps);
    }
    const std::vector<ExitGroup> groups = exit_groups(scene);
    std::vector<EventRound> rounds;
    std::uint32_t exits = 0;
    for (const ExitGroup& group : groups) {
        EventRound r = round;
        r.count = group.fluorescent ? lists.fluorescence : walking ? 0 : lists.elastic;
        r.component = group.component;
        r.sampler = group.sampler;
        r.first_exit = exits;
        exits += r.count;
        rounds.push_back(r);
    }
    if (exits == 0) return;
    for (const EventRound& r : rounds) sample_exits(scene, pass, r);
    trace_probe_.launch(exits, exits, scene.rays.nodes, scene.rays.blocks, scene.rays.grid, scene.triangles, probes_, probe_hits_);
    place_exits_.launch(exits, exits, probes_, probe_hits_, scene.triangles, exits_);
    if (scene.transport == Transport::conserving)
        fold_exits_.launch(exits, exits, pass.constants, scene.rays.nodes, scene.rays.blocks, scene.rays.grid, scene.triangles, probes_,
                           exits_);
    for (EventRound& r : rounds) {
        PhotonMap& map = maps[r.component];
        map.reserve(r.count);
        r.first_slot = map.used();
        r.slot_limit = map.capacity();
        deposit_.launch(r.count, r, pass.constants, scene.materials, pass.rows, scene.tables.shapes,
                        scene.integrated ? powers_ : scene.tables.at_wavelengths, exits_, flux_, ledgers_, map.heads(),
                        map.flux());
        deposits_ += r.count;
        refused_slots_ += map.advance(r.count);
    }
    probes_traced_ += exits;
    trace_on(scene, pass, rounds, maps);
}

// One group's exits; without power tables also what leaves there.
void PhotonTracer::sample_exits(const DeviceScene& scene, const PassBuffers& pass, const EventRound& round) {
    const Buffer<std::uint32_t>& list = round.component == STOKES_MAP_FLUORESCENCE ? fluorescence_ : elastic_;
    if (!scene.integrated) {
        sample_exits_.launch(round.count, round, pass.constants, list, points_, rays_, scene.materials, pass.rows,
                             scene.tables.shapes, scene.tables.mean_rows, scene.tables.cumulative_rows, exits_,
                             probes_);
        return;
    }
    if (!draw_exits_) {
        const Program program(device_, "integrate_power.cl");
        draw_exits_.emplace(program.kernel("draw_exits"));
        integrate_.emplace(program.kernel("integrate_power"));
        powers_ = Buffer<Flux16>(device_, "powers at exits", exits_.size());
    }
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
        slots.first[m] = maps[m].used();
        slots.limit[m] = maps[m].capacity();
    }
    walk_->launch(round.count, round, slots, pass.constants, elastic_, points_, scene.bodies, scene.rays.nodes,
                  scene.rays.blocks, scene.rays.grid, scene.triangles, scene.materials, pass.rows, rays_, flux_, ledgers_, maps[0].heads(),
                  maps[0].flux(), maps[1].heads(), maps[1].flux(), maps[2].heads(), maps[2].flux());
    deposits_ += round.count;
    std::uint32_t refused = 0;  // the maps are of one size and grow together; a path is in one of them
    for (std::uint32_t m = 0; m < 3; ++m) refused = std::max(refused, maps[m].advance(round.count));
    refused_slots_ += refused;
}

// Sends on what left: rounds as scatter_below_surfaces made them.
void PhotonTracer::trace_on(const DeviceScene& scene, const PassBuffers& pass, std::vector<EventRound> rounds,
                            const PhotonMaps& maps) {
    const auto pair = [&](std::size_t first, std::size_t second) {
        EventRound r = rounds[first];
        r.second_exit = rounds[second].first_exit;
        r.second_slot = rounds[second].first_slot;
        r.second_limit = rounds[second].slot_limit;
        return r;
    };
    if (scene.transport == Transport::paper) {
        retrace_fluorescence_.launch(rounds[0].count, rounds[0], pass.constants, exits_, scene.materials, pass.rows,
                                     maps[STOKES_MAP_FLUORESCENCE].flux(), rays_, flux_, ledgers_);
        retrace_elastic_.launch(rounds[1].count, pair(1, 2), pass.constants, exits_, rays_, flux_, ledgers_);
        return;
    }
    for (const std::size_t first : {std::size_t{0}, std::size_t{2}})
        retrace_exits_.launch(rounds[first].count, pair(first, first + 1), pass.constants, exits_, scene.materials,
                              maps[rounds[first].component].flux(), maps[rounds[first + 1].component].flux(), rays_,
                              flux_, ledgers_);
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
