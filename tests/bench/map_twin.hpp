// The photon map of kernels/hash_photons.cl and kernels/gather_radiance.cl in C++: the same algorithm, compiled for the
// machine it is built on, with AVX-512 or AVX2 by hand in the gather. Where C++ can do with fewer steps it does: keys
// are counted as they are found, and one thread adds up the histograms.
#pragma once

#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <vector>

#include "host/device/device.hpp"
#include "kernels/shared/gather.h"
#include "kernels/shared/hash_grid.h"
#include "kernels/shared/pass.h"
#include "kernels/shared/photon.h"
#include "tests/bench/timing.hpp"

namespace stokes::bench {

// Memory as the device's buffers have it: aligned to huge pages, zero at first.
template <class T>
class HugeArray {
  public:
    explicit HugeArray(std::size_t count) {
        const std::size_t page = std::size_t{2} << 20, bytes = (count * sizeof(T) + page - 1) / page * page;
        data_ = static_cast<T*>(std::aligned_alloc(page, bytes));
        if (data_ == nullptr) throw RunError("out of memory");
        ::madvise(data_, bytes, MADV_HUGEPAGE);
        std::memset(static_cast<void*>(data_), 0, bytes);
    }
    HugeArray(const HugeArray&) = delete;
    HugeArray& operator=(const HugeArray&) = delete;
    ~HugeArray() { std::free(data_); }
    T* get() const { return data_; }
    T& operator[](std::size_t i) const { return data_[i]; }

  private:
    T* data_ = nullptr;
};

class MapTwin {
  public:
    // Room for these slots; grid as make_hash_grid and HashBuilder set it.
    MapTwin(Team& team, std::uint32_t slots, const HashGrid& grid);

    // Sorts the slots into cells, and moves the photons into that order.
    void sort(const PhotonHead* heads, std::uint32_t slots);
    void permute(const PhotonHead* heads, const Flux16* flux);

    // Adds the radiance at the points to film [4][count] as gather_radiance does for this map.
    void gather(const GatherPoint* points, std::uint32_t count, std::uint32_t map, const Flux16* spectra,
                const PassConstants& pass, float* film) const;

    std::uint32_t photons() const { return cell_starts_[grid_.keys]; }
    const std::uint32_t* cell_starts() const { return cell_starts_.get(); }
    const float* positions() const { return positions_.get(); }
    const std::uint32_t* normals() const { return normals_.get(); }
    const Flux16* flux() const { return flux_.get(); }

  private:
    Flux16 sum_flux(const GatherPoint& point) const;
    Team& team_;
    HashGrid grid_;
    HugeArray<std::uint32_t> keys_, histograms_, bucket_starts_, order_, cell_starts_, normals_;
    HugeArray<std::uint64_t> entries_;
    HugeArray<float> positions_;
    HugeArray<Flux16> flux_;
};

// What the gather was compiled to: "AVX-512", "AVX2" or "scalar".
const char* twin_instructions();

}  // namespace stokes::bench
