#include "host/render/photon_map.hpp"

#include <algorithm>

namespace stokes {

namespace {

// What SpatialHash and HashBuilder take for each slot, rounded up [bytes].
constexpr std::uint64_t hash_bytes_per_slot = 128;

// Slots are counted in 32 bits, and the float16 of one buffer are addressed in 64.
constexpr std::uint64_t largest_map = 0x7fffffff;

}  // namespace

PhotonMap::PhotonMap(const Device& device, const std::string& name, std::uint32_t capacity, HashBuilder* builder,
                     SpatialHash* hash)
    : device_(device),
      name_(name),
      capacity_(capacity),
      builder_(builder),
      hash_(hash),
      heads_(device, name + " map", capacity),
      flux_(device, name + " map flux", capacity) {}

void PhotonMap::reserve(std::uint32_t count) {
    const std::uint64_t needed = std::uint64_t{used_} + count;
    if (needed <= capacity_) return;
    // The map and, at most, its hash anew, beside what is there now.
    const std::uint64_t slot_bytes = sizeof(PhotonHead) + sizeof(Flux16) + hash_bytes_per_slot +
                                     (note_paths_ ? sizeof(std::uint32_t) + sizeof(float) : 0);  // path and score
    const std::uint64_t in_one_piece = device_.description().largest_allocation_bytes / sizeof(Flux16);
    const std::uint64_t room = std::min({device_.memory_left() / slot_bytes, in_one_piece, largest_map});
    if (room < needed) return;
    const auto wanted = static_cast<std::uint32_t>(std::min(needed + needed / 2, room));
    if (builder_ != nullptr) builder_->reserve(wanted);
    if (hash_ != nullptr) hash_->reserve(wanted);
    const Buffer<PhotonHead> heads(device_, name_ + " map", wanted);
    const Buffer<Flux16> flux(device_, name_ + " map flux", wanted);
    heads_.copy_to(heads, used_);
    flux_.copy_to(flux, used_);
    heads_ = heads;
    flux_ = flux;
    if (note_paths_) {
        const Buffer<std::uint32_t> paths(device_, name_ + " map paths", wanted);
        paths_.copy_to(paths, used_);
        paths_ = paths;
    }
    capacity_ = wanted;
}

void PhotonMap::track_paths(bool on) {
    paths_ = {};
    note_paths_.reset();
    if (!on) return;
    paths_ = Buffer<std::uint32_t>(device_, name_ + " map paths", capacity_);
    note_paths_.emplace(Program(device_, "score_photons.cl").kernel("note_paths"));
}

void PhotonMap::note_paths(const Arguments& paths, std::uint32_t first_entry, std::uint32_t count,
                           std::uint32_t exits_each) {
    if (!note_paths_) return;
    note_paths_->launch(count, paths,
                        Arguments("count", count)
                            .add("exits_each", exits_each)
                            .add("first_entry", first_entry)
                            .add("first_slot", used_)
                            .add("slot_limit", capacity_)
                            .add("path_of_slot", paths_));
}

std::uint32_t PhotonMap::advance(std::uint32_t count) {
    const std::uint32_t taken = std::min(count, capacity_ - used_);
    used_ += taken;
    return count - taken;
}

}  // namespace stokes
