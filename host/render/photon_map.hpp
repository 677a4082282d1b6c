// Slots for the photons of a pass.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "host/device/kernel.hpp"
#include "host/render/spatial_hash.hpp"
#include "kernels/shared/photon.h"

namespace stokes {

// One of the maps F, S, M and surface. Deposits of a round of events stand in consecutive slots, in the order of
// their paths, so that a slot depends on paths alone.
class PhotonMap {
  public:
    // builder, hash: what the map will be sorted with; they grow before it does. They outlive the map, or are null.
    PhotonMap(const Device& device, const std::string& name, std::uint32_t capacity, HashBuilder* builder = nullptr,
              SpatialHash* hash = nullptr);

    // Makes room for count more slots, by half as much again as is needed; keeps what is stored. Where the device's
    // memory budget does not allow it, for the map and for its hash together, the capacity stays and kernels drop and
    // count what does not fit.
    void reserve(std::uint32_t count);

    void clear() { used_ = 0; }

    // Sets whether the map remembers from now on which path each slot belongs to. The aiming of emission asks for it.
    void track_paths(bool on);
    // Notes the paths of the next slots: count events, whose paths stand from first_entry on in event_lists (one of
    // paths), will store exits_each times each. Does nothing where paths are not tracked. Asynchronous.
    void note_paths(const Arguments& paths, std::uint32_t first_entry, std::uint32_t count, std::uint32_t exits_each);
    const Buffer<std::uint32_t>& paths() const { return paths_; }  // by slot

    // Hands out count slots; returns how many of them lie beyond the capacity and are lost.
    std::uint32_t advance(std::uint32_t count);

    std::uint32_t used() const { return used_; }
    std::uint32_t capacity() const { return capacity_; }
    const Buffer<PhotonHead>& heads() const { return heads_; }
    const Buffer<Flux16>& flux() const { return flux_; }
    // MAP_ARGUMENTS.
    Arguments arguments() const { return Arguments("map_heads", heads_).add("map_flux", flux_); }

  private:
    Device device_;
    std::string name_;
    std::uint32_t capacity_ = 0, used_ = 0;
    HashBuilder* builder_ = nullptr;
    SpatialHash* hash_ = nullptr;
    Buffer<PhotonHead> heads_;
    Buffer<Flux16> flux_;
    std::optional<Kernel> note_paths_;  // where paths are tracked
    Buffer<std::uint32_t> paths_;
};

}  // namespace stokes
