// The photons of a map in the order of a spatial hash, so that the gather reads neighbours side by side.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

#include "host/device/kernel.hpp"
#include "kernels/shared/hash_grid.h"
#include "kernels/shared/photon.h"

namespace stokes {

// The grid for photons between low_mm and high_mm and queries of radius_mm > 0, with a table that suits
// slots photons. Photons and queries outside of the bounds are found too, only more slowly.
// RunError for a radius or bounds that are not finite.
HashGrid make_hash_grid(glm::vec3 low_mm, glm::vec3 high_mm, float radius_mm, std::uint32_t slots);

// One map in cell order. The contents are written by HashBuilder and valid until its next build of this map.
class SpatialHash {
  public:
    // name: of the map, for people. capacity: slots there is room for.
    SpatialHash(const Device& device, const std::string& name, std::uint32_t capacity);

    // Makes room for at least this many slots; the contents are lost when it grows.
    void reserve(std::uint32_t capacity);

    // Photons of the last build; waits for it.
    std::uint32_t count_photons() const { return cell_starts_.download(1, grid_.keys).front(); }

    const HashGrid& grid() const { return grid_; }
    // [keys + 1]: photons of key k are cell_starts[k] .. cell_starts[k + 1] - 1.
    const Buffer<std::uint32_t>& cell_starts() const { return cell_starts_; }
    // x, y and z, each [grid().stride] [mm].
    const Buffer<float>& positions() const { return positions_; }
    // As PhotonHead has them.
    const Buffer<std::uint32_t>& normals() const { return normals_; }
    // [W/nm]
    const Buffer<Flux16>& flux() const { return flux_; }
    // SORTED_MAP_ARGUMENTS.
    Arguments arguments() const;

  private:
    friend class HashBuilder;
    Device device_;
    std::string name_;
    std::uint32_t capacity_ = 0;
    HashGrid grid_{};
    Buffer<std::uint32_t> cell_starts_, normals_;
    Buffer<float> positions_;
    Buffer<Flux16> flux_;
};

// Builds the hashes of all maps, one after the other, with the same working memory.
class HashBuilder {
  public:
    HashBuilder(const Device& device, std::uint32_t capacity);

    // Makes room for at least this many slots.
    void reserve(std::uint32_t capacity);

    // Sorts the photons in the first slots of heads and flux [W/nm] into hash; slots whose normal is
    // STOKES_EMPTY_SLOT hold none. Photons of a cell keep the order of their slots. Asynchronous.
    // RunError when heads or flux are shorter than slots, and as make_hash_grid does.
    void build(SpatialHash& hash, const Buffer<PhotonHead>& heads, const Buffer<Flux16>& flux, std::uint32_t slots,
               glm::vec3 low_mm, glm::vec3 high_mm, float radius_mm);

  private:
    Device device_;
    Kernel find_keys_, count_buckets_, scan_chunks_, scan_buckets_, scatter_slots_, sort_buckets_, permute_photons_;
    Buffer<std::uint32_t> keys_, histograms_, bucket_starts_, order_;
    Buffer<std::uint64_t> entries_;
};

}  // namespace stokes
