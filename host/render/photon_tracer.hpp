// The photon half of a pass: emission, events below and on surfaces, deposits into the maps.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/device/device.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/photon_map.hpp"
#include "kernels/shared/pass.h"
#include "kernels/shared/path.h"

namespace stokes {

// The pass's spectra on the device; rows as SpectraLayout has them.
struct PassBuffers {
    Buffer<PassConstants> constants;  // [1]
    Buffer<Flux16> rows;
    Buffer<Flux16> photon_flux;       // [lights]
    Buffer<Flux16> radiance;          // [lights]; of beams the irradiance across them
    bool both_branches = false;       // light below a surface goes both ways, by fluorophore and past it
    std::uint32_t exits = 1;          // of an event and component
    bool weighted_distances = false;  // `paper`: Distances::importance
    bool store_direct = true;         // false: photons straight from a light are not stored at diffuse surfaces
    // Where photons start; without cells anywhere on the lights, at random.
    std::uint32_t cell_count = 0;
    Buffer<EmissionCell> cells = {};
    Buffer<std::uint32_t> first_photons = {};  // [cell_count + 1]
};

using PhotonMaps = std::array<PhotonMap, STOKES_MAP_COUNT>;  // by STOKES_MAP_*

// What became of a pass's photons. Sums over the pass's wavelengths, in the order of LedgerSums, of flux [W/nm] and of
// flux times wavelength [W].
struct PhotonAccount {
    std::array<double, 8> energy{}, photons{};
    std::array<std::uint64_t, STOKES_FATE_COUNT> fates{};  // paths by STOKES_FATE_*
    std::uint64_t rays = 0;                                // photon rays and probes
    std::uint64_t missed_exits = 0;                        // deposits whose exit point found no surface
    std::uint64_t refused_slots = 0;                       // deposits a full map had no slot for
    std::uint64_t deposits = 0;                            // stored or refused, missed exits included
    std::uint64_t reflections = 0;                         // specular
};

class PhotonTracer {
  public:
    // Room for this many paths. Compiles the photon kernels.
    PhotonTracer(const Device& device, const RayKernels& kernels, std::uint32_t paths);

    // Follows all photons of a pass to their ends; the maps must have been cleared, their deposits are left in them.
    PhotonAccount trace(const DeviceScene& scene, const PassBuffers& pass, std::uint32_t photons, PhotonMaps& maps);

  private:
    void emit(const DeviceScene& scene, const PassBuffers& pass, std::uint32_t photons);
    ListCounts make_lists(const DeviceScene& scene, const PassBuffers& pass, const EventRound& round);
    void scatter_at_surfaces(const DeviceScene& scene, const PassBuffers& pass, EventRound round, PhotonMap& map);
    void scatter_below_surfaces(const DeviceScene& scene, const PassBuffers& pass, const EventRound& round,
                                const ListCounts& lists, PhotonMaps& maps);
    void reserve_exits(std::uint32_t count);
    const Buffer<std::uint32_t>& list_of(const EventRound& round) const;
    void sample_exits(const DeviceScene& scene, const PassBuffers& pass, const EventRound& round);
    void deposit(const DeviceScene& scene, const PassBuffers& pass, EventRound& round, PhotonMap& map);
    void walk_below_surfaces(const DeviceScene& scene, const PassBuffers& pass, EventRound round, PhotonMaps& maps);
    void trace_on(const DeviceScene& scene, const PassBuffers& pass, const std::vector<EventRound>& rounds,
                  const PhotonMaps& maps);
    PhotonAccount close_account(std::uint32_t photons);

    Device device_;
    Kernel emit_, emit_stratified_, trace_, trace_probe_, classify_, count_, scan_, write_, scatter_;
    Kernel sample_exits_, place_exits_, deposit_, retrace_fluorescence_, retrace_elastic_, retrace_exits_, fold_exits_,
        sum_;
    std::optional<Kernel> walk_, draw_exits_, integrate_;  // compiled when they are first needed
    Buffer<Ray> rays_;
    Buffer<Hit> hits_;
    Buffer<Flux16> flux_;
    Buffer<PathLedger> ledgers_;
    Buffer<SurfacePoint> points_;
    Buffer<EventSample> event_words_;
    Buffer<std::uint32_t> alive_, next_alive_, diffuse_, fluorescence_, elastic_, branches_;
    Buffer<std::uint8_t> kinds_;
    Buffer<ListCounts> chunk_counts_, totals_;
    Buffer<ExitPoint> exits_;
    Buffer<Probe> probes_;
    Buffer<Hit> probe_hits_;
    Buffer<Flux16> powers_;  // by exit; empty until it is first needed
    Buffer<LedgerSums> sums_;
    std::uint64_t probes_traced_ = 0, refused_slots_ = 0, deposits_ = 0;
};

}  // namespace stokes
