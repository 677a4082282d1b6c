// How light travels below translucent surfaces: one interface, a class for each transport model.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "host/device/kernel.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/pass_spectra.hpp"
#include "host/render/photon_map.hpp"
#include "host/scene/scene.hpp"
#include "kernels/shared/path.h"

namespace stokes {

using PhotonMaps = std::array<PhotonMap, STOKES_MAP_COUNT>;  // by STOKES_MAP_*

// How the photons of a pass are sampled. Trial passes switch off what the transports' settings may ask for.
struct PathSampling {
    bool both_branches = true;       // light below a surface may go both ways, by a fluorophore and past it
    bool many_exits = true;          // an event may have more than one exit of each component
    bool weighted_distances = true;  // distances may be drawn where more light leaves
    bool store_direct = true;        // photons straight from a light are stored at diffuse surfaces
};

// The settings of a render as the bodies of a transport have them.
ResolvedSettings settings_of(const RenderSettings& render, Transport transport);

// What a pass's events did beside their kernels.
struct DepositCounts {
    std::uint64_t probes = 0;         // rays that looked for the surface at an exit
    std::uint64_t deposits = 0;       // stored or refused, missed exits included
    std::uint64_t refused_slots = 0;  // deposits that a full map had no slot for
};

// Consecutive slots of a map; those at limit and beyond, `refused` of them, are not there.
struct Slots {
    std::uint32_t first = 0, limit = 0, refused = 0;
};

// Where light leaves a body: found on the surface from places of the tangent plane at its entry.
class SubsurfaceExits {
  public:
    SubsurfaceExits(const Device& device, const RayKernels& kernels);
    // Room for this many exits; what is there may be lost.
    void reserve(std::uint32_t count);
    // Puts the first count exits, which are sampled, onto the surface of their body. Asynchronous.
    void find_surfaces(std::uint32_t count, const Arguments& common) const;
    // exits, probes, probe_hits and exit_flux [exits].
    const Arguments& arguments() const { return arguments_; }
    std::size_t size() const { return exits_.size(); }

  private:
    Device device_;
    Kernel trace_probe_, place_exits_;
    Buffer<ExitPoint> exits_;
    Buffer<Probe> probes_;
    Buffer<Hit> probe_hits_;
    Buffer<Flux16> flux_;
    Arguments arguments_;
};

// What one round of events hands to the transports.
struct SubsurfaceEvent {
    const EventRound& round;  // its event, last and branches hold for all lists
    const ListCounts& lists;
    const PathSampling& sampling;
    const Arguments& common;  // of the scene, the pass and the paths
    PhotonMaps& maps;
    SubsurfaceExits& exits;
    DepositCounts& counts;

    // The round of one of its lists, STOKES_EVENT_FLUORESCENCE, ELASTIC or BRANCHES of a transport STOKES_TRANSPORT_*.
    EventRound round_of(std::uint32_t transport, std::uint32_t event) const;
    // Slots of the map for that many deposits of each event of a round.
    Slots take_slots(PhotonMap& map, const EventRound& of, std::uint32_t deposits_each) const;
};

class SubsurfaceTransport {
  public:
    virtual ~SubsurfaceTransport() = default;

    // Brings its tables to the wavelengths of a pass.
    virtual void prepare(const PassSpectra& spectra) = 0;

    // Scatters the paths that its bodies took in: stores what leaves in the maps, and sends each path on, or ends it.
    virtual void scatter(const SubsurfaceEvent& event) = 0;

    // STOKES_TRANSPORT_*, and whether it scatters events of that kind (STOKES_EVENT_FLUORESCENCE, ELASTIC, BRANCHES).
    virtual std::uint32_t code() const = 0;
    virtual bool scatters(std::uint32_t event) const = 0;
};

// One for each transport model that some material of the scene needs, in the order in which they store.
std::vector<std::unique_ptr<SubsurfaceTransport>> make_transports(const Device& device, const Scene& scene,
                                                                  const DeviceScene& on_device);

}  // namespace stokes
