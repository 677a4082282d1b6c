#include "host/render/spatial_hash.hpp"

#include <algorithm>
#include <cmath>

namespace stokes {

namespace {

// Rows of a hashed grid start at one of this many keys, a power of two: with one for every two photons a row
// seldom meets another, and the table stays small beside the photons.
std::uint32_t count_row_starts(std::uint32_t slots) {
    std::uint32_t result = 16;
    while (result < slots / 2) result *= 2;
    return result;
}

}  // namespace

HashGrid make_hash_grid(glm::vec3 low_mm, glm::vec3 high_mm, float radius_mm, std::uint32_t slots) {
    const glm::dvec3 extent = glm::max(glm::dvec3(high_mm) - glm::dvec3(low_mm), glm::dvec3(0.0));
    const double largest = std::max({extent.x, extent.y, extent.z});
    if (!(radius_mm > 0.0f) || !std::isfinite(radius_mm) || !std::isfinite(glm::dot(extent, extent)))
        throw RunError("photon hash: the radius and the bounds of the scene must be finite");

    // Cell coordinates of n cells are rounded by less than n 2^-22, on both sides of a comparison: the slack
    // keeps the ball about a query inside of two cells along each axis all the same.
    const double most = STOKES_HASH_MAX_CELLS;
    const double slack = 1e-5 + std::min(largest / (2.0 * radius_mm) + 1.0, most) * 0x1p-20;
    const double edge = 2.0 * radius_mm * (1.0 + slack);
    const auto cells = [&](double length, double limit) {
        return static_cast<std::uint32_t>(std::min(std::floor(length / edge) + 1.0, limit));
    };

    HashGrid grid{};
    grid.origin_x = low_mm.x;
    grid.origin_y = low_mm.y;
    grid.origin_z = low_mm.z;
    grid.cells_per_mm = static_cast<float>(1.0 / edge);
    grid.radius_mm = radius_mm;
    const std::uint32_t row_starts = count_row_starts(slots);
    grid.cells_x = cells(extent.x, std::min<double>(most, row_starts));
    grid.cells_y = cells(extent.y, most);
    grid.cells_z = cells(extent.z, most);
    const double all = static_cast<double>(grid.cells_x) * grid.cells_y * grid.cells_z;
    const bool dense = all <= row_starts;
    grid.row_mask = dense ? 0 : row_starts - 1;
    grid.keys = dense ? static_cast<std::uint32_t>(all) : row_starts + grid.cells_x - 1;
    while ((grid.keys - 1) >> grid.bucket_shift >= STOKES_HASH_BUCKETS) ++grid.bucket_shift;
    return grid;
}

SpatialHash::SpatialHash(const Device& device, const std::string& name, std::uint32_t capacity)
    : device_(device), name_(name) {
    reserve(std::max(capacity, 1u));
}

void SpatialHash::reserve(std::uint32_t capacity) {
    if (capacity <= capacity_) return;
    const std::size_t padded = std::size_t{capacity} + STOKES_HASH_PADDING;
    cell_starts_ = {};
    cell_starts_ = {device_, name_ + " map: cell starts", 2 * std::size_t{count_row_starts(capacity)} + 1};
    positions_ = {};
    positions_ = {device_, name_ + " map: positions in cell order", 3 * padded};
    normals_ = {};
    normals_ = {device_, name_ + " map: normals in cell order", padded};
    flux_ = {};
    flux_ = {device_, name_ + " map: flux in cell order", capacity};
    capacity_ = capacity;
}

Arguments SpatialHash::arguments() const {
    return Arguments("hash_grid", grid_)
        .add("cell_starts", cell_starts_)
        .add("positions", positions_)
        .add("normals", normals_)
        .add("sorted_flux", flux_);
}

HashBuilder::HashBuilder(const Device& device, std::uint32_t capacity)
    : device_(device),
      histograms_(device, "photon hash: histograms", STOKES_HASH_CHUNKS * STOKES_HASH_BUCKETS),
      bucket_starts_(device, "photon hash: bucket starts", STOKES_HASH_BUCKETS + 1) {
    const Program program(device, "hash_photons.cl");
    find_keys_ = program.kernel("find_keys");
    count_buckets_ = program.kernel("count_buckets");
    scan_chunks_ = program.kernel("scan_chunks");
    scan_buckets_ = program.kernel("scan_buckets");
    scatter_slots_ = program.kernel("scatter_slots");
    sort_buckets_ = program.kernel("sort_buckets");
    permute_photons_ = program.kernel("permute_photons");
    reserve(std::max(capacity, 1u));
}

void HashBuilder::reserve(std::uint32_t capacity) {
    if (capacity <= order_.size()) return;
    keys_ = {};
    keys_ = {device_, "photon hash: keys", capacity};
    entries_ = {};
    entries_ = {device_, "photon hash: keys and slots", capacity};
    order_ = {};
    order_ = {device_, "photon hash: order", capacity};
}

void HashBuilder::build(SpatialHash& hash, const Buffer<PhotonHead>& heads, const Buffer<Flux16>& flux,
                        std::uint32_t slots, glm::vec3 low_mm, glm::vec3 high_mm, float radius_mm) {
    if (slots > heads.size() || slots > flux.size())
        throw RunError("photon hash: more slots than the " + hash.name_ + " map has");
    reserve(slots);
    hash.reserve(slots);
    hash.grid_ = make_hash_grid(low_mm, high_mm, radius_mm, slots);
    hash.grid_.stride = hash.capacity_ + STOKES_HASH_PADDING;
    const Arguments all = Arguments("slots", slots)
                              .add("map_heads", heads)
                              .add("map_flux", flux)
                              .add("keys", keys_)
                              .add("histograms", histograms_)
                              .add("bucket_starts", bucket_starts_)
                              .add("entries", entries_, "uint2")
                              .add("order", order_)
                              .add(hash.arguments());
    find_keys_.launch(slots, all);
    count_buckets_.launch(STOKES_HASH_CHUNKS, all);
    scan_chunks_.launch(STOKES_HASH_BUCKETS / 16, all);
    scan_buckets_.launch(1, all);
    scatter_slots_.launch(STOKES_HASH_CHUNKS, all);
    sort_buckets_.launch(STOKES_HASH_BUCKETS, all);
    permute_photons_.launch((slots + 15) / 16, all);
}

}  // namespace stokes
