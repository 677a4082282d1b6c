// Once per pass and medium: the universal Green's function table onto the pass's sixteen wavelengths and onto axes in
// millimetres, as power_table_at() and sample_distance() read them. Three kernels, in this order.
#include "lib/inline.clh"
#include "lib/power_table.clh"
#include "lib/sampling.clh"
#include "shared/green.h"

// Positions on an axis of the universal table, node i >= 1 at first 2^((i - 1) step): the whole part is the node below,
// the rest the fraction to the next, linear in the logarithm, and in the value below node 1. Held beyond the last node.
FORCE_INLINE float16 green_position(float16 value, float first, float step, uint count) {
    const float16 ratio = value / first;
    const float16 position = select(ratio, 1.0f + log2(ratio) / step, ratio > 1.0f);
    return clamp(position, 0.0f, (float)(count - 1u));
}

// Work-items: one an entry (z, rho) of the universal table.
// Reads:  log_h [z][rho][albedo]: log(H1/a), in 1/mfp, of STOKES_GREEN_ALBEDOS albedos; lower [16], fraction [16]: each
//         wavelength's place between two albedos.
// Writes: blended [z][rho], sixteen values: log(H1/a).
// Equation: log(H1/a) is linear in sqrt(1 - a) between albedos: the diffusion length enters as exp(-rho sqrt(3 (1-a))).
__kernel void blend_green(GreenShape shape, __global const float* restrict log_h, __global const uint* restrict lower,
                          __global const float* restrict fraction, __global float16* restrict blended) {
    const uint entry = (uint)get_global_id(0);
    if (entry >= shape.z_count * shape.rho_count) return;
    __global const float* values = log_h + (size_t)entry * STOKES_GREEN_ALBEDOS;
    float result[STOKES_WAVELENGTHS];
    for (int j = 0; j < STOKES_WAVELENGTHS; ++j) result[j] = mix(values[lower[j]], values[lower[j] + 1u], fraction[j]);
    blended[entry] = vload16(0, result);
}

// Work-items: one an entry (row, r) of the medium's table, whose both axes are logarithmic.
// Reads:  shape of the universal table, blended as above; sigma_t [16], 1/mm.
// Writes: table16 [target.offset + row * r_count + r]: H1 in 1/mm, not normalised.
// Equation: H1_mm(r, z) = sigma_t H1(sigma_t r, sigma_t z), log(H1) bilinear in the logarithms; proportional to r below
//           the universal table's first distance, 0 beyond its last, held beyond its last depth.
__kernel void resample_green(GreenShape shape, TableShape target, __global const float* restrict blended,
                             __global const float* restrict sigma_t, __global float16* restrict table16) {
    const uint i = (uint)get_global_id(0);
    if (i >= target.row_count * target.r_count) return;
    const float z_mm = log_axis_node(target.row_first, target.row_step, i / target.r_count);
    const float r_mm = log_axis_node(target.r_first, target.r_step, i % target.r_count);
    const float reach = shape.rho_first * exp2((float)(shape.rho_count - 2u) * shape.rho_step) * 1.0001f;
    const float16 sigma = vload16(0, sigma_t);
    const float16 rho = sigma * r_mm;
    const float16 z_at = green_position(sigma * z_mm, shape.z_first, shape.z_step, shape.z_count);
    const float16 r_at = green_position(max(rho, shape.rho_first), shape.rho_first, shape.rho_step, shape.rho_count);
    const float16 z_low = min(floor(z_at), (float)(shape.z_count - 2u));
    const float16 r_low = min(floor(r_at), (float)(shape.rho_count - 2u));
    float corner[4][STOKES_WAVELENGTHS];
    uint node[STOKES_WAVELENGTHS];
    vstore16(convert_uint16(z_low) * shape.rho_count + convert_uint16(r_low), 0, node);
    for (uint j = 0u; j < STOKES_WAVELENGTHS; ++j) {
        __global const float* low = blended + (size_t)node[j] * STOKES_WAVELENGTHS + j;
        __global const float* high = low + (size_t)shape.rho_count * STOKES_WAVELENGTHS;
        corner[0][j] = low[0];
        corner[1][j] = low[STOKES_WAVELENGTHS];
        corner[2][j] = high[0];
        corner[3][j] = high[STOKES_WAVELENGTHS];
    }
    const float16 log_h = mix(mix(vload16(0, corner[0]), vload16(0, corner[1]), r_at - r_low),
                              mix(vload16(0, corner[2]), vload16(0, corner[3]), r_at - r_low), z_at - z_low);
    const float16 near = sigma * min(rho / shape.rho_first, 1.0f);
    table16[target.offset + i] = select(near * exp(log_h), (float16)(0.0f), rho > reach);
}

// The trapezoid weight of a node between two others.
FORCE_INLINE float half_span(float before, float after) { return 0.5f * (after - before); }

// Work-items: one a row (depth) of the medium's table.
// Reads:  table16 as above; u1 [first_row + row] float16: the probability of leaving scattered.
// Writes: table16: each wavelength's trapezoid integral over r is u1; mean_rows: the mean over wavelengths of H1/u1,
//         the density that sample_distance draws from; cumulative_rows: its trapezoid integral. Both [row][r] at the
//         same offset as table16.
// Where the density is convex, straight lines between its values lie above it; each value is lowered by a twelfth of
// the second difference first, so that every stretch of two cells holds what it should.
__kernel void normalise_green(TableShape target, uint first_row, __global const float16* restrict u1,
                              __global float16* restrict table16, __global float* restrict mean_rows,
                              __global float* restrict cumulative_rows) {
    const uint row = (uint)get_global_id(0);
    if (row >= target.row_count) return;
    const uint first = target.offset + row * target.r_count, last = target.r_count - 1u;
    __global float16* h = table16 + first;

    float16 total = (float16)(0.0f), before = h[0], here = h[0];
    float r_before = 0.0f, r_here = 0.0f;
    for (uint i = 0u; i <= last; ++i) {
        const float16 after = h[min(i + 1u, last)];
        const float r_after = log_axis_node(target.r_first, target.r_step, min(i + 1u, last));
        float16 value = here;
        if (i > 0u && i < last) {
            const float d0 = r_here - r_before, d1 = r_after - r_here;
            const float16 bend = ((after - here) / d1 - (here - before) / d0) * (d0 * d1 / (6.0f * (d0 + d1)));
            value = max(here - bend, 0.5f * here);
        }
        h[i] = value;
        total += value * half_span(i > 0u ? r_before : r_here, i < last ? r_after : r_here);
        before = here;
        here = after;
        r_before = r_here;
        r_here = r_after;
    }

    const float16 target_total = u1[first_row + row];
    const float16 none = (float16)(0.0f);
    const float16 share = select(none, 1.0f / total, total > none);
    const float16 factor = share * target_total;
    const float16 lit = select(none, share, target_total > none);
    float integral = 0.0f, mean_before = 0.0f;
    r_before = 0.0f;
    for (uint i = 0u; i <= last; ++i) {
        const float r = log_axis_node(target.r_first, target.r_step, i);
        const float mean = sum16(h[i] * lit) / (float)STOKES_WAVELENGTHS;
        h[i] *= factor;
        integral += (mean_before + mean) * half_span(r_before, r);
        mean_rows[first + i] = mean;
        cumulative_rows[first + i] = integral;
        mean_before = mean;
        r_before = r;
    }
}
