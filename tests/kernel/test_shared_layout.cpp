#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "host/core/embedded.hpp"
#include "kernels/shared/bvh.h"
#include "kernels/shared/camera.h"
#include "kernels/shared/gather.h"
#include "kernels/shared/green.h"
#include "kernels/shared/hash_grid.h"
#include "kernels/shared/integrated_power.h"
#include "kernels/shared/light.h"
#include "kernels/shared/material.h"
#include "kernels/shared/pass.h"
#include "kernels/shared/path.h"
#include "kernels/shared/photon.h"
#include "kernels/shared/power_table.h"
#include "kernels/shared/ray.h"
#include "kernels/shared/texture.h"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"

using namespace stokes;

// Every struct of kernels/shared with every field: S(struct) opens one, F(struct, field) follows.
// clang-format off
#define SHARED_STRUCTS(S, F) \
    S(BvhNode16) F(BvhNode16, lo_x) F(BvhNode16, lo_y) F(BvhNode16, lo_z) F(BvhNode16, hi_x) F(BvhNode16, hi_y) \
        F(BvhNode16, hi_z) F(BvhNode16, child) \
    S(BvhNode16f) F(BvhNode16f, lo_x) F(BvhNode16f, lo_y) F(BvhNode16f, lo_z) F(BvhNode16f, hi_x) F(BvhNode16f, hi_y) \
        F(BvhNode16f, hi_z) F(BvhNode16f, child) \
    S(BvhNode8) F(BvhNode8, lo_x) F(BvhNode8, lo_y) F(BvhNode8, lo_z) F(BvhNode8, hi_x) F(BvhNode8, hi_y) \
        F(BvhNode8, hi_z) F(BvhNode8, child) \
    S(BvhNode8f) F(BvhNode8f, lo_x) F(BvhNode8f, lo_y) F(BvhNode8f, lo_z) F(BvhNode8f, hi_x) F(BvhNode8f, hi_y) \
        F(BvhNode8f, hi_z) F(BvhNode8f, child) \
    S(BvhBlock) F(BvhBlock, v0x) F(BvhBlock, v0y) F(BvhBlock, v0z) F(BvhBlock, v1x) F(BvhBlock, v1y) \
        F(BvhBlock, v1z) F(BvhBlock, v2x) F(BvhBlock, v2y) F(BvhBlock, v2z) F(BvhBlock, triangle) \
    S(BvhGrid) F(BvhGrid, origin_x) F(BvhGrid, origin_y) F(BvhGrid, origin_z) F(BvhGrid, scale_x) \
        F(BvhGrid, scale_y) F(BvhGrid, scale_z) F(BvhGrid, root) F(BvhGrid, pad) \
    S(CameraRecord) F(CameraRecord, position_x) F(CameraRecord, position_y) F(CameraRecord, position_z) \
        F(CameraRecord, width) F(CameraRecord, corner_x) F(CameraRecord, corner_y) \
        F(CameraRecord, corner_z) F(CameraRecord, height) F(CameraRecord, right_x) \
        F(CameraRecord, right_y) F(CameraRecord, right_z) F(CameraRecord, pad0) F(CameraRecord, down_x) \
        F(CameraRecord, down_y) F(CameraRecord, down_z) F(CameraRecord, pad1) \
    S(GatherPoint) F(GatherPoint, x) F(GatherPoint, y) F(GatherPoint, z) F(GatherPoint, pixel) \
        F(GatherPoint, nx) F(GatherPoint, ny) F(GatherPoint, nz) F(GatherPoint, material) \
        F(GatherPoint, maps) F(GatherPoint, weight) F(GatherPoint, reflected) F(GatherPoint, luminance) \
        F(GatherPoint, radius_factor) F(GatherPoint, body) \
    S(PixelRadius) F(PixelRadius, factor) F(PixelRadius, material) \
    S(HashGrid) F(HashGrid, origin_x) F(HashGrid, origin_y) F(HashGrid, origin_z) \
        F(HashGrid, cells_per_mm) F(HashGrid, cells_x) F(HashGrid, cells_y) F(HashGrid, cells_z) \
        F(HashGrid, row_mask) F(HashGrid, keys) F(HashGrid, bucket_shift) F(HashGrid, radius_mm) \
        F(HashGrid, stride) \
    S(PassMedium) F(PassMedium, sigma_s) F(PassMedium, sigma_a) F(PassMedium, dipole_a) F(PassMedium, pad) \
    S(DistanceMixture) F(DistanceMixture, first) F(DistanceMixture, count) F(DistanceMixture, r_max_mm) \
        F(DistanceMixture, theta_max_deg) F(DistanceMixture, reach_f_mm) F(DistanceMixture, reach_s_mm) \
        F(DistanceMixture, pad) \
    S(LightRecord) F(LightRecord, kind) F(LightRecord, first_triangle) F(LightRecord, triangle_count) \
        F(LightRecord, cumulative_probability) F(LightRecord, px) F(LightRecord, py) F(LightRecord, pz) \
        F(LightRecord, first_area) F(LightRecord, dx) F(LightRecord, dy) F(LightRecord, dz) \
        F(LightRecord, ball_mm) F(LightRecord, ux) F(LightRecord, uy) F(LightRecord, uz) F(LightRecord, dimensions) \
        F(LightRecord, vx) F(LightRecord, vy) F(LightRecord, vz) F(LightRecord, restricted) F(LightRecord, tx) F(LightRecord, ty) F(LightRecord, tz) F(LightRecord, target_mm) F(LightRecord, wux) F(LightRecord, wuy) F(LightRecord, wuz) F(LightRecord, part) F(LightRecord, wvx) F(LightRecord, wvy) F(LightRecord, wvz) F(LightRecord, inside) S(EmissionTarget) F(EmissionTarget, x) F(EmissionTarget, y) F(EmissionTarget, z) F(EmissionTarget, nx) F(EmissionTarget, ny) F(EmissionTarget, nz) \
    S(EmissionCell) F(EmissionCell, low) F(EmissionCell, size) F(EmissionCell, probability) F(EmissionCell, light) \
        F(EmissionCell, stride) F(EmissionCell, pad) \
    S(BodyRecord) F(BodyRecord, flags) F(BodyRecord, material) F(BodyRecord, inside) F(BodyRecord, first_region) \
        F(BodyRecord, region_count) F(BodyRecord, pad) \
    S(ContactRegion) F(ContactRegion, low_x) F(ContactRegion, low_y) F(ContactRegion, low_z) \
        F(ContactRegion, high_x) F(ContactRegion, high_y) F(ContactRegion, high_z) \
    S(ShapeRecord) F(ShapeRecord, material) F(ShapeRecord, light) \
    S(MaterialRecord) F(MaterialRecord, kind) F(MaterialRecord, flags) F(MaterialRecord, transport) \
        F(MaterialRecord, medium) \
        F(MaterialRecord, fluorescent_fraction) F(MaterialRecord, eta) F(MaterialRecord, excitation_row) \
        F(MaterialRecord, reradiation_row) F(MaterialRecord, sigma_row) F(MaterialRecord, exit_scale) \
    S(PassConstants) F(PassConstants, lambda_nm) F(PassConstants, to_x) F(PassConstants, to_y) \
        F(PassConstants, to_z) F(PassConstants, chain) \
        F(PassConstants, seed) F(PassConstants, pass) F(PassConstants, photons) \
        F(PassConstants, offset_mm) F(PassConstants, first_collision_only) \
        F(PassConstants, stratified) F(PassConstants, low_discrepancy_pixels) F(PassConstants, strata) \
        F(PassConstants, level_shares) F(PassConstants, low_discrepancy_exits) F(PassConstants, pad1) \
    S(PathLedger) F(PathLedger, emitted) F(PathLedger, absorbed) F(PathLedger, stokes_loss) \
        F(PathLedger, escaped) F(PathLedger, dropped) F(PathLedger, roulette) F(PathLedger, created) \
        F(PathLedger, stored) F(PathLedger, fate) F(PathLedger, missed_exits) F(PathLedger, rays) \
        F(PathLedger, reference_flux) F(PathLedger, conversions) F(PathLedger, reflections) \
        F(PathLedger, history) F(PathLedger, leader) \
    S(LightSum) F(LightSum, energy) F(LightSum, photons) \
    S(LedgerSums) F(LedgerSums, light) F(LedgerSums, fates) F(LedgerSums, missed_exits) F(LedgerSums, rays) \
        F(LedgerSums, reflections) F(LedgerSums, pad) \
    S(WalkSlots) F(WalkSlots, first) F(WalkSlots, limit) F(WalkSlots, pad) \
    S(Departure) F(Departure, nx) F(Departure, ny) F(Departure, nz) F(Departure, body) F(Departure, inside) \
        F(Departure, arrives) F(Departure, pad) \
    S(SurfacePoint) F(SurfacePoint, x) F(SurfacePoint, y) F(SurfacePoint, z) F(SurfacePoint, material) \
        F(SurfacePoint, nx) F(SurfacePoint, ny) F(SurfacePoint, nz) F(SurfacePoint, body) \
    S(EventSample) F(EventSample, first) F(EventSample, second) \
    S(ExitPoint) F(ExitPoint, x) F(ExitPoint, y) F(ExitPoint, z) F(ExitPoint, r_mm) F(ExitPoint, nx) \
        F(ExitPoint, ny) F(ExitPoint, nz) F(ExitPoint, row) F(ExitPoint, path) F(ExitPoint, material) \
        F(ExitPoint, way_mm) F(ExitPoint, scale) F(ExitPoint, kept) F(ExitPoint, event_light) F(ExitPoint, found) \
    S(EventRound) F(EventRound, count) F(EventRound, event) F(EventRound, component) F(EventRound, sampler) \
        F(EventRound, first_exit) F(EventRound, first_slot) F(EventRound, slot_limit) \
        F(EventRound, second_exit) F(EventRound, last) F(EventRound, exits) F(EventRound, branches) \
        F(EventRound, drawn_rows) F(EventRound, first_entry) F(EventRound, notes_bodies) F(EventRound, pad) \
    S(ExitGroups) F(ExitGroups, count) F(ExitGroups, component) F(ExitGroups, first_exit) \
        F(ExitGroups, pad) \
    S(ListCounts) F(ListCounts, alive) F(ListCounts, count) F(ListCounts, first) F(ListCounts, pad) \
    S(PhotonHead) F(PhotonHead, x) F(PhotonHead, y) F(PhotonHead, z) F(PhotonHead, normal) \
    S(TableShape) F(TableShape, offset) F(TableShape, row_count) F(TableShape, row_first) \
        F(TableShape, row_step) F(TableShape, r_count) F(TableShape, r_first) F(TableShape, r_step) \
        F(TableShape, log_axes) \
    S(GreenWalk) F(GreenWalk, source_depth) F(GreenWalk, eta) F(GreenWalk, critical_cosine) \
        F(GreenWalk, deep) F(GreenWalk, deep_offset) F(GreenWalk, deep_spread) F(GreenWalk, rho_first) \
        F(GreenWalk, bins_per_octave) F(GreenWalk, bins) F(GreenWalk, seed) F(GreenWalk, stream) \
        F(GreenWalk, first_walk) F(GreenWalk, walks_per_item) F(GreenWalk, items) F(GreenWalk, pad0) \
        F(GreenWalk, pad1) \
    S(GreenShape) F(GreenShape, rho_first) F(GreenShape, rho_step) F(GreenShape, z_first) \
        F(GreenShape, z_step) F(GreenShape, rho_count) F(GreenShape, z_count) F(GreenShape, pad0) \
        F(GreenShape, pad1) \
    S(Ray) F(Ray, ox) F(Ray, oy) F(Ray, oz) F(Ray, t_min) F(Ray, dx) F(Ray, dy) F(Ray, dz) F(Ray, t_max) \
    S(Hit) F(Hit, t) F(Hit, u) F(Hit, v) F(Hit, triangle) \
    S(Probe) F(Probe, x) F(Probe, y) F(Probe, z) F(Probe, reach_mm) F(Probe, nx) F(Probe, ny) F(Probe, nz) \
        F(Probe, body) \
    S(Triangle) F(Triangle, v0x) F(Triangle, v0y) F(Triangle, v0z) F(Triangle, shape) F(Triangle, e1x) \
        F(Triangle, e1y) F(Triangle, e1z) F(Triangle, body) F(Triangle, e2x) F(Triangle, e2y) \
        F(Triangle, e2z) F(Triangle, flags) \
    S(TextureRecord) F(TextureRecord, width) F(TextureRecord, height) F(TextureRecord, first_texel) \
        F(TextureRecord, white_row) \
    S(TriangleUv) F(TriangleUv, u0) F(TriangleUv, v0) F(TriangleUv, u1) F(TriangleUv, v1) F(TriangleUv, u2) \
        F(TriangleUv, v2) F(TriangleUv, repeats) F(TriangleUv, padding)
// clang-format on

namespace {

struct Entry {
    std::string name, measure;  // the expression the device evaluates
    std::size_t host = 0;       // its value here
    std::size_t bytes = 0;      // of a field; 0: the entry is a whole struct
};

std::vector<Entry> entries() {
#define STRUCT_ENTRY(type) {#type, "sizeof(" #type ")", sizeof(type), 0},
#define FIELD_ENTRY(type, field) \
    {#type "." #field, "OFFSET(" #type ", " #field ")", offsetof(type, field), sizeof(type::field)},
    return {SHARED_STRUCTS(STRUCT_ENTRY, FIELD_ENTRY)};
}

// Headers of kernels/shared, below kernels/.
std::vector<std::string> shared_headers() {
    std::vector<std::string> result;
    for (const auto& [file, text] : embedded_files())
        if (file.rfind("kernels/shared/", 0) == 0) result.push_back(file.substr(8));
    return result;
}

// A kernel that writes what each entry's expression is on the device.
std::string layout_kernel(const std::vector<Entry>& all) {
    std::string text;
    for (const std::string& header : shared_headers()) text += "#include \"" + header + "\"\n";
    text += "#define OFFSET(type, field) ((uint)((size_t)&((__global type*)base)->field - (size_t)base))\n";
    text += "__kernel void report_layout(__global uint* out) {\n    if (get_global_id(0) != 0) return;\n";
    text += "    __global uint* base = out;\n";
    for (std::size_t i = 0; i < all.size(); ++i)
        text += "    out[" + std::to_string(i) + "] = (uint)" + all[i].measure + ";\n";
    return text + "}\n";
}

}  // namespace

TEST_CASE("shared structs have one layout on host and device", "[shared_layout][tiny]") {
    const std::vector<Entry> all = entries();
    const Buffer<std::uint32_t> out(test_device(), "layout", all.size());
    Program::from_source(test_device(), "shared_layout.cl", layout_kernel(all))
        .kernel("report_layout")
        .launch(1, Arguments("out", out));
    const std::vector<std::uint32_t> device = out.download();
    for (std::size_t i = 0; i < all.size(); ++i) {
        CAPTURE(all[i].name);
        CHECK(device[i] == all[i].host);
    }
}

// Fields follow one another without gaps, so none is missing above and no padding is left to a compiler.
TEST_CASE("shared structs have no hidden padding", "[shared_layout]") {
    std::string open;
    std::size_t size = 0, end = 0;
    const auto close = [&] {
        CAPTURE(open);
        CHECK(end == size);
    };
    for (const Entry& entry : entries()) {
        CAPTURE(entry.name);
        if (entry.bytes == 0) {
            if (!open.empty()) close();
            open = entry.name;
            size = entry.host;
            end = 0;
        } else {
            CHECK(entry.host == end);
            end += entry.bytes;
        }
    }
    close();
}

TEST_CASE("the layout test knows every shared struct", "[shared_layout]") {
    std::set<std::string> known;
    for (const Entry& entry : entries()) known.insert(entry.name);
    const std::string mark = "typedef struct ";
    std::size_t found = 0;
    for (const std::string& header : shared_headers()) {
        const std::string& text = embedded_files().at("kernels/" + header);
        for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1), ++found) {
            const std::size_t name = at + mark.size();
            const std::string type = text.substr(name, text.find(' ', name) - name);
            CAPTURE(header, type);
            CHECK(known.count(type) == 1);
            CHECK(text.find("STOKES_ASSERT_SIZE(" + type + ", ") != std::string::npos);
        }
    }
    CHECK(found > 10);
}
