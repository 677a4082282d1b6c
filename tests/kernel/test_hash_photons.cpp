#include <algorithm>
#include <cmath>
#include <random>

#include "host/render/spatial_hash.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/normals.hpp"

using namespace stokes;

namespace {

struct alignas(16) Float4 {
    float x, y, z, w;
};
struct alignas(16) Uint4 {
    std::uint32_t v[4];
};

struct Slots {
    std::vector<PhotonHead> heads;
    std::vector<Flux16> flux;  // v[0] is the slot
    glm::vec3 low{0.0f}, high{0.0f};
};

// count slots in a box, every fifth or so empty.
Slots random_slots(std::uint32_t count, glm::vec3 low, glm::vec3 high) {
    std::mt19937 generator(count);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    Slots slots;
    slots.low = low;
    slots.high = high;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 p = low + (high - low) * glm::vec3(uniform(generator), uniform(generator), uniform(generator));
        const std::uint32_t normal =
            uniform(generator) < 0.2f ? STOKES_EMPTY_SLOT : pack_normal_twin(random_direction(generator));
        slots.heads.push_back({p.x, p.y, p.z, normal});
        Flux16 flux;
        for (int k = 0; k < 16; ++k) flux.v[k] = k == 0 ? static_cast<float>(i) : uniform(generator);
        slots.flux.push_back(flux);
    }
    return slots;
}

std::uint32_t cell_twin(float coordinate, std::uint32_t cells) {
    return static_cast<std::uint32_t>(std::min(std::max(coordinate, 0.0f), static_cast<float>(cells - 1)));
}

// The key as kernels/lib/hash_grid.clh defines it, in plain C++.
std::uint32_t key_twin(const HashGrid& grid, float px, float py, float pz) {
    const std::uint32_t x = cell_twin((px - grid.origin_x) * grid.cells_per_mm, grid.cells_x);
    const std::uint32_t y = cell_twin((py - grid.origin_y) * grid.cells_per_mm, grid.cells_y);
    const std::uint32_t z = cell_twin((pz - grid.origin_z) * grid.cells_per_mm, grid.cells_z);
    if (grid.row_mask == 0) return (z * grid.cells_y + y) * grid.cells_x + x;
    std::uint32_t h = y * 0x9E3779B1u + z * 0x85EBCA77u;
    h = (h ^ (h >> 16)) * 0x85EBCA6Bu;
    h = (h ^ (h >> 13)) * 0xC2B2AE35u;
    return ((h ^ (h >> 16)) & grid.row_mask) + x;
}

struct Built {
    HashGrid grid;
    std::vector<std::uint32_t> starts, normals;
    std::vector<float> positions;
    std::vector<Flux16> flux;
    std::uint32_t photons;
};

Built build(const Slots& slots, float radius_mm, std::uint32_t capacity) {
    HashBuilder builder(test_device(), capacity);
    SpatialHash hash(test_device(), "test", capacity);
    const Buffer<PhotonHead> heads(test_device(), "heads", slots.heads);
    const Buffer<Flux16> flux(test_device(), "flux", slots.flux);
    builder.build(hash, heads, flux, static_cast<std::uint32_t>(slots.heads.size()), slots.low, slots.high, radius_mm);
    const std::uint32_t n = hash.count_photons();
    return {hash.grid(),
            hash.cell_starts().download(hash.grid().keys + 1),
            hash.normals().download(n),
            hash.positions().download(),
            hash.flux().download(n),
            n};
}

// The slots that hold photons, sorted by key, slots of a cell in their order.
std::vector<std::uint32_t> order_twin(const Slots& slots, const HashGrid& grid) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < slots.heads.size(); ++i)
        if (slots.heads[i].normal != STOKES_EMPTY_SLOT) order.push_back(i);
    const auto key = [&](std::uint32_t i) {
        return key_twin(grid, slots.heads[i].x, slots.heads[i].y, slots.heads[i].z);
    };
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
    return order;
}

void check_build(const Slots& slots, const Built& built) {
    const HashGrid& grid = built.grid;
    const std::vector<std::uint32_t> order = order_twin(slots, grid);
    REQUIRE(built.photons == order.size());
    REQUIRE(built.starts.front() == 0);
    REQUIRE(built.starts.back() == order.size());
    REQUIRE(std::is_sorted(built.starts.begin(), built.starts.end()));
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        const PhotonHead& head = slots.heads[order[i]];
        REQUIRE(std::memcmp(&built.flux[i], &slots.flux[order[i]], sizeof(Flux16)) == 0);
        REQUIRE(built.positions[i] == head.x);
        REQUIRE(built.positions[grid.stride + i] == head.y);
        REQUIRE(built.positions[2 * grid.stride + i] == head.z);
        const std::uint32_t key = key_twin(grid, head.x, head.y, head.z);
        REQUIRE(built.starts[key] <= i);
        REQUIRE(i < built.starts[key + 1]);
    }
}

}  // namespace

TEST_CASE("photons come in cell order, each in its cell, empty slots left out", "[hash][tiny]") {
    const Slots hashed = random_slots(700, {-30, -20, -10}, {30, 20, 10});
    const Built sparse = build(hashed, 0.5f, 700);
    REQUIRE(sparse.grid.row_mask != 0);
    check_build(hashed, sparse);
    const Built dense = build(hashed, 5.0f, 700);
    REQUIRE(dense.grid.row_mask == 0);
    check_build(hashed, dense);
}

TEST_CASE("many photons, far from the origin, outside of the bounds", "[hash]") {
    Slots slots = random_slots(200000, {9000, -12000, -500}, {9100, -11900, -480});
    check_build(slots, build(slots, 0.4f, 200000));
    slots.low += glm::vec3(20.0f);
    slots.high -= glm::vec3(8.0f);
    check_build(slots, build(slots, 0.4f, 200000));
    check_build(slots, build(slots, 60.0f, 200000));
}

TEST_CASE("no photon, one photon, only empty slots", "[hash][tiny]") {
    Slots slots;
    check_build(slots, build(slots, 1.0f, 0));
    slots.heads = {{1.0f, 2.0f, 3.0f, 7u}};
    slots.flux.resize(1);
    check_build(slots, build(slots, 1.0f, 1));
    slots.heads.assign(40, {1.0f, 2.0f, 3.0f, STOKES_EMPTY_SLOT});
    slots.flux.resize(40);
    check_build(slots, build(slots, 1.0f, 40));
}

TEST_CASE("a map is used again, grows, and refuses more slots than there are", "[hash]") {
    HashBuilder builder(test_device(), 10);
    SpatialHash hash(test_device(), "test", 10);
    for (std::uint32_t count : {3000u, 20u, 0u, 5000u}) {
        const Slots slots = random_slots(count, {0, 0, 0}, {10, 10, 10});
        const Buffer<PhotonHead> heads(test_device(), "heads", slots.heads);
        const Buffer<Flux16> flux(test_device(), "flux", slots.flux);
        builder.build(hash, heads, flux, count, slots.low, slots.high, 0.7f);
        CHECK(hash.count_photons() == order_twin(slots, hash.grid()).size());
        CHECK_THROWS_AS(builder.build(hash, heads, flux, count + 1, slots.low, slots.high, 0.7f), RunError);
        CHECK_THROWS_AS(builder.build(hash, heads, flux, count, slots.low, slots.high, 0.0f), RunError);
    }
}

TEST_CASE("the order depends neither on the work-group size nor on the capacity", "[hash]") {
    const Slots slots = random_slots(30000, {-1, -1, -1}, {1, 1, 1});
    const Built expected = build(slots, 0.02f, 30000);
    const std::size_t local_size = test_device().local_size();
    for (std::size_t size : {std::size_t{16}, std::size_t{256}}) {
        test_device().set_local_size(size);
        const Built other = build(slots, 0.02f, 50000);
        CHECK(other.starts == expected.starts);
        CHECK(other.normals == expected.normals);
        CHECK(std::memcmp(other.flux.data(), expected.flux.data(), expected.photons * sizeof(Flux16)) == 0);
    }
    test_device().set_local_size(local_size);
}

namespace {

// Photons at up to the radius from queries all over the bounds and beyond must stand in exactly one run.
void check_runs(glm::vec3 low, glm::vec3 high, float radius, std::uint32_t slots, std::uint32_t count) {
    const HashGrid grid = make_hash_grid(low, high, radius, slots);
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> uniform(-0.1f, 1.1f);
    std::vector<Float4> queries;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 q = low + (high - low) * glm::vec3(uniform(generator), uniform(generator), uniform(generator));
        queries.push_back({q.x, q.y, q.z, 0.0f});
    }
    const Buffer<Float4> input(test_device(), "queries", queries);
    const Buffer<Uint4> begin_buffer(test_device(), "begins", count), end_buffer(test_device(), "ends", count);
    test_program("hash_runs.cl")
        .kernel("find_runs")
        .launch(count, Arguments()
                           .add("queries", input, "float4")
                           .add("n", count)
                           .add("grid", grid)
                           .add("begins", begin_buffer, "uint4")
                           .add("ends", end_buffer, "uint4"));
    const std::vector<Uint4> begins = begin_buffer.download(), ends = end_buffer.download();
    for (std::uint32_t i = 0; i < count; ++i) {
        for (int run = 0; run < 4; ++run) {
            REQUIRE(begins[i].v[run] <= ends[i].v[run]);
            REQUIRE(ends[i].v[run] <= grid.keys);
            if (run > 0) REQUIRE(ends[i].v[run - 1] <= begins[i].v[run]);
        }
        for (int k = 0; k < 32; ++k) {
            glm::dvec3 offset = random_direction(generator) * static_cast<double>(radius);
            if (k < 6)
                offset = glm::dvec3(k / 2 == 0, k / 2 == 1, k / 2 == 2) * (k % 2 == 0 ? 1.0 : -1.0) * double(radius);
            const float x = static_cast<float>(queries[i].x + offset.x),
                        y = static_cast<float>(queries[i].y + offset.y),
                        z = static_cast<float>(queries[i].z + offset.z);
            if (glm::length(glm::dvec3(x, y, z) - glm::dvec3(queries[i].x, queries[i].y, queries[i].z)) >
                radius * 1.0001)
                continue;
            const std::uint32_t key = key_twin(grid, x, y, z);
            int found = 0;
            for (int run = 0; run < 4; ++run) found += key >= begins[i].v[run] && key < ends[i].v[run];
            REQUIRE(found == 1);
        }
    }
}

}  // namespace

TEST_CASE("the ball about a query is covered once, whatever the table", "[hash][tiny]") {
    check_runs({-5, -5, -5}, {5, 5, 5}, 0.5f, 10, 100);        // 16 row starts: rows overlap all the time
    check_runs({-5, -5, 0}, {5, 5, 0}, 0.5f, 1000, 100);       // dense, one layer of cells
    check_runs({-5, -5, -5}, {5, 5, 5}, 0.5f, 1u << 20, 100);  // hashed, hardly an overlap
}

TEST_CASE("the ball about a query is covered once, in large and distant scenes", "[hash]") {
    check_runs({0, 0, 0}, {1000, 1000, 1000}, 0.05f, 1u << 20,
               2000);                                                        // coordinates rounded to 1e-3 of a cell
    check_runs({-3e5f, 2e5f, 1e5f}, {-2e5f, 3e5f, 2e5f}, 1.0f, 1000, 2000);  // far from the origin
    check_runs({0, 0, 0}, {1e6f, 1e6f, 1e6f}, 0.1f, 1u << 22, 2000);         // more cells than the grid may have
    check_runs({0, 0, 0}, {0, 0, 0}, 0.1f, 100, 10);                         // a single point
}
