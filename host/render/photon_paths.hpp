// The photons of a pass under way: the state of each path, and lists of paths by what happens to them.
#pragma once

#include <array>
#include <cstdint>

#include "host/device/kernel.hpp"
#include "kernels/shared/path.h"
#include "kernels/shared/ray.h"

namespace stokes {

// Sums over a pass's photons and wavelengths, in the order of LedgerSums, of flux [W/nm] and of flux times
// wavelength [W].
struct PhotonAccount {
    std::array<double, 8> energy{}, photons{};
    std::array<std::uint64_t, STOKES_FATE_COUNT> fates{};  // paths by STOKES_FATE_*
    std::uint64_t rays = 0;                                // photon rays and probes
    std::uint64_t missed_exits = 0;                        // deposits whose exit point found no surface
    std::uint64_t refused_slots = 0;                       // deposits a full map had no slot for
    std::uint64_t deposits = 0;                            // stored or refused, missed exits included
    std::uint64_t reflections = 0;                         // specular
};

class PhotonPaths {
  public:
    // Room for this many paths.
    PhotonPaths(const Device& device, std::uint32_t paths);

    // PATH_ARGUMENTS; hits, points and event_samples, by path; event_lists and entry_lists.
    const Arguments& arguments() const { return arguments_; }

    // The paths that are under way, in order: where emission writes them, and what a round goes through.
    Arguments list() const { return Arguments("list", alive_); }

    // Lists the paths of a round of count events by what classify_photons wrote into entry_lists, which is part of
    // arguments(). Waits for the device.
    ListCounts make_lists(std::uint32_t count);

    // Makes the paths that go on the list of the next round.
    void end_round();

    // Adds up the accounts of the first count paths. Waits for the device.
    PhotonAccount sum_ledgers(std::uint32_t count) const;

  private:
    Kernel count_, scan_, write_, sum_;
    Buffer<Ray> rays_;
    Buffer<Departure> departures_;
    Buffer<Hit> hits_;
    Buffer<Flux16> flux_;
    Buffer<PathLedger> ledgers_;
    Buffer<SurfacePoint> points_;
    Buffer<EventSample> event_samples_;
    Buffer<std::uint32_t> alive_, next_alive_, event_lists_;
    Buffer<std::uint8_t> entry_lists_;
    Buffer<ListCounts> chunk_counts_, totals_;
    Buffer<LedgerSums> sums_;
    Arguments arguments_;
};

}  // namespace stokes
