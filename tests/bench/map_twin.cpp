#include "tests/bench/map_twin.hpp"

#include <algorithm>
#include <cmath>

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define TWIN_AVX512
#elif defined(__AVX2__) && defined(__FMA__)
#define TWIN_AVX2
#endif
#if defined(TWIN_AVX512) || defined(TWIN_AVX2)
#include <immintrin.h>
#endif

namespace stokes::bench {

namespace {

constexpr float pi = 3.14159265358979f;
constexpr int list_length = 240;  // photons found that wait to be summed

std::uint32_t grid_cell(float coordinate, std::uint32_t cells) {
    const float inside = coordinate > 0.0f ? coordinate : 0.0f;
    const float last = static_cast<float>(cells - 1);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(inside < last ? inside : last));
}

std::uint32_t grid_row(const HashGrid& grid, std::uint32_t y, std::uint32_t z) {
    if (grid.row_mask == 0) return (z * grid.cells_y + y) * grid.cells_x;
    std::uint32_t h = y * 0x9E3779B1u + z * 0x85EBCA77u;
    h = (h ^ (h >> 16)) * 0x85EBCA6Bu;
    h = (h ^ (h >> 13)) * 0xC2B2AE35u;
    return (h ^ (h >> 16)) & grid.row_mask;
}

struct Runs {
    std::uint32_t begin[4], end[4];
};

Runs key_runs(const HashGrid& grid, const GatherPoint& p) {
    const float u = std::floor((p.x - grid.origin_x) * grid.cells_per_mm - 0.5f);
    const float v = std::floor((p.y - grid.origin_y) * grid.cells_per_mm - 0.5f);
    const float w = std::floor((p.z - grid.origin_z) * grid.cells_per_mm - 0.5f);
    const std::uint32_t x0 = grid_cell(u, grid.cells_x), x1 = grid_cell(u + 1.0f, grid.cells_x);
    const std::uint32_t y0 = grid_cell(v, grid.cells_y), y1 = grid_cell(v + 1.0f, grid.cells_y);
    const std::uint32_t z0 = grid_cell(w, grid.cells_z), z1 = grid_cell(w + 1.0f, grid.cells_z);
    const std::uint32_t a = grid_row(grid, y0, z0), b = grid_row(grid, y1, z0);
    const std::uint32_t c = grid_row(grid, y0, z1), d = grid_row(grid, y1, z1);
    const std::uint32_t ab = std::min(a, b), ba = std::max(a, b), cd = std::min(c, d), dc = std::max(c, d);
    const std::uint32_t low = std::max(ab, cd), high = std::min(ba, dc);
    const std::uint32_t row[4] = {std::min(ab, cd), std::min(low, high), std::max(low, high), std::max(ba, dc)};
    Runs runs;
    for (int k = 0; k < 4; ++k) {
        runs.begin[k] = row[k] + x0;
        runs.end[k] = row[k] + x1 + 1;
        if (k > 0) runs.begin[k] = std::max(runs.begin[k], runs.end[k - 1]);
    }
    return runs;
}

// A query and the photons that may count, as the three versions of `Finder` read them.
struct Query {
    float x, y, z, nx, ny, nz;
    float radius_squared, height;
    const float *px, *py, *pz;
    const std::uint32_t* normals;
    std::uint32_t body;  // in the highest byte
};

#if defined(TWIN_AVX512)

constexpr int lanes = 16;

struct Finder {
    explicit Finder(const Query& q)
        : x(_mm512_set1_ps(q.x)),
          y(_mm512_set1_ps(q.y)),
          z(_mm512_set1_ps(q.z)),
          nx(_mm512_set1_ps(q.nx)),
          ny(_mm512_set1_ps(q.ny)),
          nz(_mm512_set1_ps(q.nz)),
          mx(_mm512_set1_ps(q.nx / 127.0f)),
          my(_mm512_set1_ps(q.ny / 127.0f)),
          mz(_mm512_set1_ps(q.nz / 127.0f)),
          radius_squared(_mm512_set1_ps(q.radius_squared)),
          height(_mm512_set1_ps(q.height)),
          body(_mm512_set1_epi32(static_cast<int>(q.body))) {}

    // Lists those of the photons i .. i + 15 below end that count.
    int append(const Query& q, int i, int end, int* list, int count) const {
        const __m512 dx = _mm512_sub_ps(_mm512_loadu_ps(q.px + i), x);
        const __m512 dy = _mm512_sub_ps(_mm512_loadu_ps(q.py + i), y);
        const __m512 dz = _mm512_sub_ps(_mm512_loadu_ps(q.pz + i), z);
        const __m512i packed = _mm512_loadu_si512(q.normals + i);
        const __m512 cx = _mm512_cvtepi32_ps(_mm512_srai_epi32(_mm512_slli_epi32(packed, 24), 24));
        const __m512 cy = _mm512_cvtepi32_ps(_mm512_srai_epi32(_mm512_slli_epi32(packed, 16), 24));
        const __m512 cz = _mm512_cvtepi32_ps(_mm512_srai_epi32(_mm512_slli_epi32(packed, 8), 24));
        const __m512 cosine = _mm512_fmadd_ps(cz, mz, _mm512_fmadd_ps(cy, my, _mm512_mul_ps(cx, mx)));
        const __m512 distance = _mm512_fmadd_ps(dz, dz, _mm512_fmadd_ps(dy, dy, _mm512_mul_ps(dx, dx)));
        const __m512 above = _mm512_fmadd_ps(dz, nz, _mm512_fmadd_ps(dy, ny, _mm512_mul_ps(dx, nx)));
        __mmask16 in = static_cast<__mmask16>(end - i >= lanes ? 0xffff : (1 << (end - i)) - 1);
        in = _mm512_mask_cmp_ps_mask(in, distance, radius_squared, _CMP_LT_OQ);
        in = _mm512_mask_cmp_ps_mask(in, _mm512_abs_ps(above), height, _CMP_LT_OQ);
        in = _mm512_mask_cmp_ps_mask(in, cosine, _mm512_set1_ps(STOKES_GATHER_MIN_COSINE), _CMP_GT_OQ);
        in = _mm512_mask_cmplt_epu32_mask(in, _mm512_xor_si512(packed, body), _mm512_set1_epi32(1 << 24));
        const __m512i index = _mm512_add_epi32(_mm512_set1_epi32(i),
                                               _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
        _mm512_storeu_si512(list + count, _mm512_maskz_compress_epi32(in, index));
        return count + __builtin_popcount(in);
    }
    __m512 x, y, z, nx, ny, nz, mx, my, mz, radius_squared, height;
    __m512i body;
};

struct Sum {
    __m512 even = _mm512_setzero_ps(), odd = _mm512_setzero_ps();
    void add(const Flux16* flux, const int* list, int count) {
        int j = 0;
        for (; j + 1 < count; j += 2) {
            even = _mm512_add_ps(even, _mm512_load_ps(flux[list[j]].v));
            odd = _mm512_add_ps(odd, _mm512_load_ps(flux[list[j + 1]].v));
        }
        if (j < count) even = _mm512_add_ps(even, _mm512_load_ps(flux[list[j]].v));
    }
    Flux16 value() const {
        Flux16 result;
        _mm512_store_ps(result.v, _mm512_add_ps(even, odd));
        return result;
    }
};

#elif defined(TWIN_AVX2)

constexpr int lanes = 8;

struct Finder {
    explicit Finder(const Query& q)
        : x(_mm256_set1_ps(q.x)),
          y(_mm256_set1_ps(q.y)),
          z(_mm256_set1_ps(q.z)),
          nx(_mm256_set1_ps(q.nx)),
          ny(_mm256_set1_ps(q.ny)),
          nz(_mm256_set1_ps(q.nz)),
          mx(_mm256_set1_ps(q.nx / 127.0f)),
          my(_mm256_set1_ps(q.ny / 127.0f)),
          mz(_mm256_set1_ps(q.nz / 127.0f)),
          radius_squared(_mm256_set1_ps(q.radius_squared)),
          height(_mm256_set1_ps(q.height)),
          body(_mm256_set1_epi32(static_cast<int>(q.body))) {}

    int append(const Query& q, int i, int end, int* list, int count) const {
        const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(q.px + i), x);
        const __m256 dy = _mm256_sub_ps(_mm256_loadu_ps(q.py + i), y);
        const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(q.pz + i), z);
        const __m256i packed = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(q.normals + i));
        const __m256 cx = _mm256_cvtepi32_ps(_mm256_srai_epi32(_mm256_slli_epi32(packed, 24), 24));
        const __m256 cy = _mm256_cvtepi32_ps(_mm256_srai_epi32(_mm256_slli_epi32(packed, 16), 24));
        const __m256 cz = _mm256_cvtepi32_ps(_mm256_srai_epi32(_mm256_slli_epi32(packed, 8), 24));
        const __m256 cosine = _mm256_fmadd_ps(cz, mz, _mm256_fmadd_ps(cy, my, _mm256_mul_ps(cx, mx)));
        const __m256 distance = _mm256_fmadd_ps(dz, dz, _mm256_fmadd_ps(dy, dy, _mm256_mul_ps(dx, dx)));
        const __m256 above = _mm256_fmadd_ps(dz, nz, _mm256_fmadd_ps(dy, ny, _mm256_mul_ps(dx, nx)));
        const __m256 size = _mm256_andnot_ps(_mm256_set1_ps(-0.0f), above);
        const __m256 in = _mm256_and_ps(
            _mm256_and_ps(_mm256_cmp_ps(distance, radius_squared, _CMP_LT_OQ), _mm256_cmp_ps(size, height, _CMP_LT_OQ)),
            _mm256_cmp_ps(cosine, _mm256_set1_ps(STOKES_GATHER_MIN_COSINE), _CMP_GT_OQ));
        const __m256i of_body =
            _mm256_cmpeq_epi32(_mm256_srli_epi32(_mm256_xor_si256(packed, body), 24), _mm256_setzero_si256());
        unsigned mask = static_cast<unsigned>(_mm256_movemask_ps(_mm256_and_ps(in, _mm256_castsi256_ps(of_body)))) &
                        (end - i >= lanes ? 0xffu : (1u << (end - i)) - 1u);
        for (; mask != 0; mask &= mask - 1) list[count++] = i + __builtin_ctz(mask);
        return count;
    }
    __m256 x, y, z, nx, ny, nz, mx, my, mz, radius_squared, height;
    __m256i body;
};

struct Sum {
    __m256 low = _mm256_setzero_ps(), high = _mm256_setzero_ps();
    void add(const Flux16* flux, const int* list, int count) {
        for (int j = 0; j < count; ++j) {
            low = _mm256_add_ps(low, _mm256_load_ps(flux[list[j]].v));
            high = _mm256_add_ps(high, _mm256_load_ps(flux[list[j]].v + 8));
        }
    }
    Flux16 value() const {
        Flux16 result;
        _mm256_store_ps(result.v, low);
        _mm256_store_ps(result.v + 8, high);
        return result;
    }
};

#else

constexpr int lanes = 16;

struct Finder {
    explicit Finder(const Query&) {}
    int append(const Query& q, int i, int end, int* list, int count) const {
        for (int k = i; k < std::min(i + lanes, end); ++k) {
            const float dx = q.px[k] - q.x, dy = q.py[k] - q.y, dz = q.pz[k] - q.z;
            const auto byte = [&](int shift) {
                return static_cast<float>(static_cast<int>(q.normals[k] << shift) >> 24);
            };
            const float cosine = (byte(24) * q.nx + byte(16) * q.ny + byte(8) * q.nz) / 127.0f;
            list[count] = k;
            count += dx * dx + dy * dy + dz * dz < q.radius_squared &&
                     std::fabs(dx * q.nx + dy * q.ny + dz * q.nz) < q.height && cosine > STOKES_GATHER_MIN_COSINE &&
                     (q.normals[k] ^ q.body) < 1u << 24;
        }
        return count;
    }
};

struct Sum {
    Flux16 sum{};
    void add(const Flux16* flux, const int* list, int count) {
        for (int j = 0; j < count; ++j)
            for (int k = 0; k < 16; ++k) sum.v[k] += flux[list[j]].v[k];
    }
    Flux16 value() const { return sum; }
};

#endif

// Added in pairs, as the kernel does: one after the other they would wait for each other.
float dot16(const Flux16& a, const float* b) {
    float p[16], q[8], r[4];
    for (int k = 0; k < 16; ++k) p[k] = a.v[k] * b[k];
    for (int k = 0; k < 8; ++k) q[k] = p[k] + p[k + 8];
    for (int k = 0; k < 4; ++k) r[k] = q[k] + q[k + 4];
    return (r[0] + r[2]) + (r[1] + r[3]);
}

}  // namespace

const char* twin_instructions() { return lanes == 8 ? "AVX2" : sizeof(Finder) > 64 ? "AVX-512" : "scalar"; }

MapTwin::MapTwin(Team& team, std::uint32_t slots, const HashGrid& grid)
    : team_(team),
      grid_(grid),
      keys_(slots),
      histograms_(STOKES_HASH_CHUNKS * STOKES_HASH_BUCKETS),
      bucket_starts_(STOKES_HASH_BUCKETS + 1),
      order_(slots),
      cell_starts_(grid.keys + 1),
      normals_(slots + STOKES_HASH_PADDING),
      entries_(slots),
      positions_(3 * std::size_t{grid.stride}),
      flux_(slots) {}

void MapTwin::sort(const PhotonHead* heads, std::uint32_t slots) {
    const std::uint32_t length = (slots + STOKES_HASH_CHUNKS - 1) / STOKES_HASH_CHUNKS;
    const auto chunk = [&](std::size_t c, const auto& work) {
        const std::uint32_t begin = static_cast<std::uint32_t>(c) * length, end = std::min(slots, begin + length);
        for (std::uint32_t i = begin; i < end; ++i) work(i);
    };
    team_.each(STOKES_HASH_CHUNKS, [&](std::size_t c) {
        chunk(c, [&](std::uint32_t i) {
            const PhotonHead& h = heads[i];
            const std::uint32_t x = grid_cell((h.x - grid_.origin_x) * grid_.cells_per_mm, grid_.cells_x);
            const std::uint32_t y = grid_cell((h.y - grid_.origin_y) * grid_.cells_per_mm, grid_.cells_y);
            const std::uint32_t z = grid_cell((h.z - grid_.origin_z) * grid_.cells_per_mm, grid_.cells_z);
            const std::uint32_t key = grid_row(grid_, y, z) + x;
            keys_[i] = h.normal == STOKES_EMPTY_SLOT ? STOKES_NONE : key;
        });
        std::uint32_t* counts = histograms_.get() + c * STOKES_HASH_BUCKETS;
        std::fill_n(counts, STOKES_HASH_BUCKETS, 0u);
        chunk(c, [&](std::uint32_t i) {
            if (keys_[i] != STOKES_NONE) ++counts[keys_[i] >> grid_.bucket_shift];
        });
    });
    // Small: one thread.
    std::uint32_t* starts = bucket_starts_.get();
    std::fill_n(starts, STOKES_HASH_BUCKETS + 1, 0u);
    for (std::uint32_t c = 0; c < STOKES_HASH_CHUNKS; ++c)
        for (std::uint32_t b = 0; b < STOKES_HASH_BUCKETS; ++b) {
            std::uint32_t& count = histograms_[c * STOKES_HASH_BUCKETS + b];
            const std::uint32_t own = count;
            count = starts[b + 1];
            starts[b + 1] += own;
        }
    for (std::uint32_t b = 1; b <= STOKES_HASH_BUCKETS; ++b) starts[b] += starts[b - 1];
    team_.each(STOKES_HASH_CHUNKS, [&](std::size_t c) {
        std::uint32_t* next = histograms_.get() + c * STOKES_HASH_BUCKETS;
        for (std::uint32_t b = 0; b < STOKES_HASH_BUCKETS; ++b) next[b] += starts[b];
        chunk(c, [&](std::uint32_t i) {
            const std::uint32_t key = keys_[i];
            if (key != STOKES_NONE) entries_[next[key >> grid_.bucket_shift]++] = (std::uint64_t{i} << 32) | key;
        });
    });
    team_.each(STOKES_HASH_BUCKETS, [&](std::size_t b) {
        const auto bucket = static_cast<std::uint32_t>(b);
        const std::uint32_t first_key = std::min(bucket << grid_.bucket_shift, grid_.keys);
        const std::uint32_t end_key = std::min((bucket + 1) << grid_.bucket_shift, grid_.keys);
        std::uint32_t* ends = cell_starts_.get() + 1;
        if (bucket == 0) cell_starts_[0] = 0;
        for (std::uint32_t k = first_key; k < end_key; ++k) ends[k] = 0;
        for (std::uint32_t i = starts[b]; i < starts[b + 1]; ++i) ++ends[static_cast<std::uint32_t>(entries_[i])];
        std::uint32_t sum = starts[b];
        for (std::uint32_t k = first_key; k < end_key; ++k) {
            const std::uint32_t count = ends[k];
            ends[k] = sum;
            sum += count;
        }
        for (std::uint32_t i = starts[b]; i < starts[b + 1]; ++i) {
            const std::uint64_t entry = entries_[i];
            order_[ends[static_cast<std::uint32_t>(entry)]++] = static_cast<std::uint32_t>(entry >> 32);
        }
    });
}

void MapTwin::permute(const PhotonHead* heads, const Flux16* flux) {
    float* const x = positions_.get();
    float* const y = x + grid_.stride;
    float* const z = y + grid_.stride;
    std::uint32_t* const normals = normals_.get();
    const std::uint32_t* const order = order_.get();
    Flux16* const sorted = flux_.get();
    team_.blocks(photons(), 1024, [=](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t slot = order[i];
            const PhotonHead head = heads[slot];
            x[i] = head.x;
            y[i] = head.y;
            z[i] = head.z;
            normals[i] = head.normal;
            sorted[i] = flux[slot];
        }
    });
}

Flux16 MapTwin::sum_flux(const GatherPoint& point) const {
    const Query query{point.x,
                      point.y,
                      point.z,
                      point.nx,
                      point.ny,
                      point.nz,
                      grid_.radius_mm * grid_.radius_mm,
                      STOKES_GATHER_MAX_HEIGHT * grid_.radius_mm,
                      positions_.get(),
                      positions_.get() + grid_.stride,
                      positions_.get() + 2 * std::size_t{grid_.stride},
                      normals_.get(),
                      point.body << 24};
    const Finder finder(query);
    const Runs runs = key_runs(grid_, point);
    Sum sum;
    int list[list_length + 16];
    int count = 0;
    for (int run = 0; run < 4; ++run) {
        const int end = static_cast<int>(cell_starts_[runs.end[run]]);
        for (int i = static_cast<int>(cell_starts_[runs.begin[run]]); i < end; i += lanes) {
            count = finder.append(query, i, end, list, count);
            if (count >= list_length) {
                sum.add(flux_.get(), list, count);
                count = 0;
            }
        }
    }
    sum.add(flux_.get(), list, count);
    return sum.value();
}

void MapTwin::gather(const GatherPoint* points, std::uint32_t count, std::uint32_t map, const Flux16* spectra,
                     const PassConstants& pass, float* film) const {
    team_.blocks(count, 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const GatherPoint& point = points[i];
            if ((point.maps & (1u << map)) == 0) continue;
            Flux16 radiance = sum_flux(point);
            const float scale = point.weight / (pi * pi * grid_.radius_mm * grid_.radius_mm);
            for (int k = 0; k < 16; ++k)
                radiance.v[k] *= scale * (map == STOKES_MAP_SURFACE ? spectra[point.material].v[k] : 1.0f);
            float* value = film + 4 * (std::size_t{map} * count + point.pixel);
            value[0] += dot16(radiance, pass.to_x);
            value[1] += dot16(radiance, pass.to_y);
            value[2] += dot16(radiance, pass.to_z);
        }
    });
}

}  // namespace stokes::bench
