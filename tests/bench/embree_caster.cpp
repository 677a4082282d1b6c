#include "tests/bench/embree_caster.hpp"

#include <embree3/rtcore.h>
#include <immintrin.h>

#include <stdexcept>

namespace stokes::bench {

namespace {

constexpr std::size_t block = 1024;

// What Embree asks of every thread that traces: denormals are zero.
void flush_denormals() { _mm_setcsr(_mm_getcsr() | 0x8040u); }

RTCIntersectContext context_with(RTCIntersectContextFlags flags) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = flags;
    return context;
}

RTCRay embree_ray(const Ray& ray) {
    return {ray.ox, ray.oy, ray.oz, ray.t_min, ray.dx, ray.dy, ray.dz, 0.0f, ray.t_max, 0xffffffffu, 0, 0};
}

}  // namespace

struct EmbreeCaster::Owner {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    double build_wall_s = 0.0;
    ~Owner() {
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }
};

EmbreeCaster::EmbreeCaster(const std::vector<Triangle>& triangles, unsigned threads, bool robust)
    : owner_(std::make_unique<Owner>()) {
    owner_->device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    if (owner_->device == nullptr) throw std::runtime_error("Embree: no device");
    owner_->scene = rtcNewScene(owner_->device);
    if (robust) rtcSetSceneFlags(owner_->scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(owner_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), 3 * triangles.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), triangles.size()));
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Triangle& t = triangles[i];
        const float corners[9] = {t.v0x,         t.v0y,         t.v0z,         t.v0x + t.e1x, t.v0y + t.e1y,
                                  t.v0z + t.e1z, t.v0x + t.e2x, t.v0y + t.e2y, t.v0z + t.e2z};
        for (std::size_t k = 0; k < 9; ++k) vertices[9 * i + k] = corners[k];
        for (std::size_t k = 0; k < 3; ++k) indices[3 * i + k] = static_cast<unsigned>(3 * i + k);
    }
    owner_->build_wall_s = time_of([&] {
                               rtcCommitGeometry(geometry);
                               rtcAttachGeometry(owner_->scene, geometry);
                               rtcReleaseGeometry(geometry);
                               rtcCommitScene(owner_->scene);
                           }).wall_s;
    const RTCError error = rtcGetDeviceError(owner_->device);
    if (error != RTC_ERROR_NONE) throw std::runtime_error("Embree: error " + std::to_string(error));
}

EmbreeCaster::~EmbreeCaster() = default;

double EmbreeCaster::build_wall_s() const { return owner_->build_wall_s; }

void EmbreeCaster::closest(Team& team, const std::vector<Ray>& rays, std::vector<Hit>& hits) const {
    team.blocks(rays.size(), block, [&](std::size_t begin, std::size_t end) {
        flush_denormals();
        RTCIntersectContext context = context_with(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
        for (std::size_t i = begin; i < end; ++i) {
            RTCRayHit r;
            r.ray = embree_ray(rays[i]);
            r.hit.geomID = r.hit.primID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(owner_->scene, &context, &r);
            hits[i] = {r.ray.tfar, r.hit.u, r.hit.v, r.hit.primID};
        }
    });
}

void EmbreeCaster::any(Team& team, const std::vector<Ray>& rays, std::vector<std::uint32_t>& occluded) const {
    team.blocks(rays.size(), block, [&](std::size_t begin, std::size_t end) {
        flush_denormals();
        RTCIntersectContext context = context_with(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
        for (std::size_t i = begin; i < end; ++i) {
            RTCRay ray = embree_ray(rays[i]);
            rtcOccluded1(owner_->scene, &context, &ray);
            occluded[i] = ray.tfar < 0.0f ? 1u : 0u;
        }
    });
}

void EmbreeCaster::coherent(Team& team, const std::vector<Ray>& rays, std::vector<Hit>& hits) const {
    team.blocks(rays.size(), block, [&](std::size_t begin, std::size_t end) {
        flush_denormals();
        RTCIntersectContext context = context_with(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
        for (std::size_t first = begin; first < end; first += 16) {
            const std::size_t count = std::min<std::size_t>(16, end - first);
            alignas(64) int valid[16];
            RTCRayHit16 p;
            for (std::size_t k = 0; k < 16; ++k) {
                const Ray& ray = rays[first + std::min(k, count - 1)];
                valid[k] = k < count ? -1 : 0;
                p.ray.org_x[k] = ray.ox;
                p.ray.org_y[k] = ray.oy;
                p.ray.org_z[k] = ray.oz;
                p.ray.tnear[k] = ray.t_min;
                p.ray.dir_x[k] = ray.dx;
                p.ray.dir_y[k] = ray.dy;
                p.ray.dir_z[k] = ray.dz;
                p.ray.time[k] = 0.0f;
                p.ray.tfar[k] = ray.t_max;
                p.ray.mask[k] = 0xffffffffu;
                p.ray.id[k] = p.ray.flags[k] = 0;
                p.hit.geomID[k] = p.hit.primID[k] = p.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
            }
            rtcIntersect16(valid, owner_->scene, &context, &p);
            for (std::size_t k = 0; k < count; ++k)
                hits[first + k] = {p.ray.tfar[k], p.hit.u[k], p.hit.v[k], p.hit.primID[k]};
        }
    });
}

std::string embree_version() { return RTC_VERSION_STRING; }

}  // namespace stokes::bench
