#include "host/render/photon_map.hpp"

#include <algorithm>

#include "host/core/error.hpp"

namespace stokes {

PhotonMap::PhotonMap(const Device& device, const std::string& name, std::uint32_t capacity)
    : device_(device),
      name_(name),
      capacity_(capacity),
      heads_(device, name + " map", capacity),
      flux_(device, name + " map flux", capacity) {}

void PhotonMap::reserve(std::uint32_t count) {
    const std::uint64_t needed = std::uint64_t{used_} + count;
    if (needed <= capacity_ || full_) return;
    const std::uint64_t wanted = std::min<std::uint64_t>(needed + needed / 2, 0x7fffffffu);
    try {
        const Buffer<PhotonHead> heads(device_, name_ + " map", wanted);
        const Buffer<Flux16> flux(device_, name_ + " map flux", wanted);
        heads_.copy_to(heads, used_);
        flux_.copy_to(flux, used_);
        device_.finish();
        heads_ = heads;
        flux_ = flux;
        capacity_ = static_cast<std::uint32_t>(wanted);
    } catch (const InputError&) {  // over the memory budget
        full_ = true;
    }
}

std::uint32_t PhotonMap::advance(std::uint32_t count) {
    const std::uint32_t taken = std::min(count, capacity_ - used_);
    used_ += taken;
    return count - taken;
}

}  // namespace stokes
