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

PhotonTracer::PhotonTracer(const Device& device, std::uint32_t paths)
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
    const Program tracing(device, "trace_rays.cl");
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
    sum_ = Program(device, "sum_ledgers.cl").kernel("sum_ledgers");
}

PhotonAccount PhotonTracer::trace(const DeviceScene& scene, const PassBuffers& pass, std::uint32_t photons,
                                  PhotonMaps& maps) {
    probes_traced_ = refused_slots_ = deposits_ = 0;
    emit_.launch(photons, pass.constants, scene.light_count, scene.lights, scene.light_areas, scene.triangles,
                 pass.photon_flux, rays_, flux_, ledgers_, alive_);
    std::uint32_t count = photons, event = 0;
    for (; count > 0; ++event) {
        trace_.launch(count, alive_, count, scene.nodes, scene.blocks, scene.grid, rays_, hits_);
        const ListCounts lists = make_lists(scene, pass, count, event);
        EventRound round{};
        round.event = event;
        round.last = event + 1 >= round_limit ? 1 : 0;
        round.count = lists.diffuse;
        scatter_at_surfaces(pass, round, maps[STOKES_MAP_SURFACE]);
        scatter_below_surfaces(scene, pass, round, lists, maps);
        std::swap(alive_, next_alive_);
        count = lists.alive;
    }
    return close_account(photons);
}

// Sorts the arrived photons into the lists alive, diffuse, fluorescence, elastic; the rest has ended.
ListCounts PhotonTracer::make_lists(const DeviceScene& scene, const PassBuffers& pass, std::uint32_t count,
                                    std::uint32_t event) {
    const std::uint32_t chunks = chunks_of(count);
    EventRound round{};
    round.count = count;
    round.event = event;
    classify_.launch(count, round, pass.constants, alive_, rays_, hits_, flux_, scene.triangles, scene.materials,
                     scene.shapes, points_, ledgers_, kinds_);
    count_.launch(chunks, count, chunk_size, kinds_, chunk_counts_);
    scan_.launch(1, chunks, chunk_counts_, totals_);
    write_.launch(chunks, count, chunk_size, alive_, kinds_, chunk_counts_, next_alive_, diffuse_, fluorescence_,
                  elastic_);
    return totals_.download(1).front();
}

void PhotonTracer::scatter_at_surfaces(const PassBuffers& pass, EventRound round, PhotonMap& map) {
    if (round.count == 0) return;
    map.reserve(round.count);
    round.first_slot = map.used();
    round.slot_limit = map.capacity();
    scatter_.launch(round.count, round, pass.constants, diffuse_, points_, pass.rows, rays_, flux_, ledgers_, map.heads(),
                    map.flux());
    deposits_ += round.count;
    refused_slots_ += map.advance(round.count);
}

// Exits stand in the order fluorescence, single, multiple.
void PhotonTracer::scatter_below_surfaces(const DeviceScene& scene, const PassBuffers& pass, const EventRound& round,
                                          const ListCounts& lists, PhotonMaps& maps) {
    const std::array<std::uint32_t, 3> counts = {lists.fluorescence, lists.elastic, lists.elastic};
    const std::array<std::uint32_t, 3> first = {0, lists.fluorescence, lists.fluorescence + lists.elastic};
    const std::uint32_t exits = lists.fluorescence + 2 * lists.elastic;
    if (exits == 0) return;
    std::array<EventRound, 3> rounds;
    for (std::uint32_t c = 0; c < 3; ++c) {
        maps[c].reserve(counts[c]);
        rounds[c] = round;
        rounds[c].count = counts[c];
        rounds[c].component = c;
        rounds[c].first_exit = first[c];
        rounds[c].second_exit = first[STOKES_MAP_MULTIPLE];
        rounds[c].first_slot = maps[c].used();
        rounds[c].slot_limit = maps[c].capacity();
        sample_exits_.launch(counts[c], rounds[c], pass.constants, c == STOKES_MAP_FLUORESCENCE ? fluorescence_ : elastic_,
                             points_, rays_, scene.materials, scene.tables.shapes, scene.tables.mean_rows,
                             scene.tables.cumulative_rows, exits_, probes_);
    }
    trace_probe_.launch(exits, exits, scene.nodes, scene.blocks, scene.grid, scene.triangles, probes_, probe_hits_);
    place_exits_.launch(exits, exits, probes_, probe_hits_, scene.triangles, exits_);
    for (std::uint32_t c = 0; c < 3; ++c) {
        deposit_.launch(counts[c], rounds[c], pass.constants, scene.materials, pass.rows, scene.tables.shapes, scene.tables.at_wavelengths,
                        exits_, flux_, ledgers_, maps[c].heads(), maps[c].flux());
        deposits_ += counts[c];
        refused_slots_ += maps[c].advance(counts[c]);
    }
    retrace_fluorescence_.launch(counts[STOKES_MAP_FLUORESCENCE], rounds[STOKES_MAP_FLUORESCENCE], pass.constants, exits_,
                                 scene.materials, pass.rows, maps[STOKES_MAP_FLUORESCENCE].flux(), rays_, flux_, ledgers_);
    retrace_elastic_.launch(counts[STOKES_MAP_SINGLE], rounds[STOKES_MAP_SINGLE], pass.constants, exits_, rays_, flux_,
                            ledgers_);
    probes_traced_ += exits;
}

PhotonAccount PhotonTracer::close_account(std::uint32_t photons) {
    const std::uint32_t chunks = chunks_of(photons);
    sum_.launch(chunks, photons, chunk_size, ledgers_, sums_);
    PhotonAccount account;
    for (const LedgerSums& sums : sums_.download(chunks)) {
        for (std::size_t k = 0; k < account.flux.size(); ++k) account.flux[k] += static_cast<double>(sums.flux[k]);
        for (std::size_t k = 0; k < account.fates.size(); ++k) account.fates[k] += sums.fates[k];
        account.rays += sums.rays;
        account.missed_exits += sums.missed_exits;
    }
    account.rays += probes_traced_;
    account.refused_slots = refused_slots_;
    account.deposits = deposits_;
    return account;
}

}  // namespace stokes
