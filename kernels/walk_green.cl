// The Green's function G1 of a half-space by random walks, PHYSICS "conserving": where light of an isotropic point
// source leaves that has collided at least once.
// Work-items: items, each with its own walks and its own histogram, so that the sums have a fixed order.
// Reads:  walk; albedos [6] float16: the albedos a (two float16), the decays kappa(a) [1/mfp] (two), and the factors c
//         of the light that escapes from the deep (two).
// Writes: histogram [item][bin][2] float16: the expected number of escapes, summed over the item's walks, by
//         lateral distance from the source's foot and by albedo.
//
// One walk serves all albedos: after n collisions it counts a^n. At each collision, at depth z, it scores
// 1/2 integral T(mu) exp(-z/mu) dmu by one direction, which its next flight uses as well: each is sampled from the
// right distribution, and a sum of expectations needs no independence. The flight itself is mirrored at the surface
// with probability R(mu), else the walk is over: what leaves has been scored.
// A walk that gets deep would take long to return. Deep down diffusion is exact but for terms of order exp(-z): the
// rest leaves at distance d from the walk's foot with density (h / 2 pi s^3) (1 + kappa s) exp(-kappa s) per area,
// h the height above z of the extrapolated surface of diffusion, s = sqrt(h^2 + d^2); d is drawn for kappa = 0.
#include "lib/fresnel.clh"
#include "lib/inline.clh"
#include "lib/rng.clh"
#include "shared/green.h"
#include "shared/limits.h"

// Smaller escapes are not worth the score: exp(-16) = 1e-7.
#define FAINT_DEPTH 16.0f

FORCE_INLINE void score(__global float16* histogram, __private const GreenWalk* walk, float2 at, float16 low,
                        float16 high) {
    const float octaves = 0.5f * log2(dot(at, at) + FLT_MIN) - log2(walk->rho_first);
    const float bin = floor(octaves * walk->bins_per_octave + 1.5f);
    if (!(bin < (float)walk->bins)) return;
    const uint i = (uint)max(bin, 0.0f);
    histogram[2u * i] += low;
    histogram[2u * i + 1u] += high;
}

// What a walk in the deep still has to give, and where.
FORCE_INLINE void score_deep(__global float16* histogram, __private const GreenWalk* walk, __constant float16* albedos,
                             float2 at, float z, float16 low, float16 high, Random4 draw) {
    const float h = z + walk->deep_offset - walk->deep_spread * log(1.0f - draw.a);
    const float cosine = 1.0f - draw.b;
    const float s = h / cosine;
    float c;
    const float sine = sincos(6.28318531f * draw.c, &c);
    at += sqrt(max(s * s - h * h, 0.0f)) * (float2)(c, sine);
    const float16 x0 = albedos[2] * s, x1 = albedos[3] * s;
    score(histogram, walk, at, low * albedos[4] * (1.0f + x0) * exp(-x0), high * albedos[5] * (1.0f + x1) * exp(-x1));
}

__kernel void walk_green(GreenWalk walk, __constant float16* albedos, __global float16* histograms) {
    const uint item = (uint)get_global_id(0);
    if (item >= walk.items) return;
    __global float16* histogram = histograms + (size_t)item * 2u * walk.bins;
    for (uint i = 0u; i < 2u * walk.bins; ++i) histogram[i] = (float16)(0.0f);

    const float eta = walk.eta, critical = walk.critical_cosine;
    for (uint i = 0u; i < walk.walks_per_item; ++i) {
        const uint path = walk.first_walk + item * walk.walks_per_item + i;
        float2 at = (float2)(0.0f);
        float z = walk.source_depth;
        float16 low = (float16)(1.0f), high = (float16)(1.0f);
        for (uint event = 0u;; ++event) {
            const Random4 draw = random4(walk.seed, walk.stream, path, event, 0u);
            if (z > walk.deep) {
                score_deep(histogram, &walk, albedos, at, z, low, high, draw);
                break;
            }
            float c;
            const float sine = sincos(6.28318531f * draw.c, &c);
            const float2 across = (float2)(c, sine);
            if (event > 0u && z < FAINT_DEPTH) {
                const float mu = max(critical + (1.0f - critical) * draw.a, 1e-6f);
                const float leaving = 0.5f * (1.0f - critical) * (1.0f - internal_reflectance(mu, eta)) * exp(-z / mu);
                const float2 exit_at = at + across * (z / mu * sqrt(max(1.0f - mu * mu, 0.0f)));
                score(histogram, &walk, exit_at, leaving * low, leaving * high);
            }
            const float mu = 2.0f * draw.a - 1.0f;
            const float flight = -log(1.0f - draw.b);
            at += across * (flight * sqrt(max(1.0f - mu * mu, 0.0f)));
            z -= flight * mu;
            if (z < 0.0f) {
                if (!(draw.d < internal_reflectance(mu, eta))) break;
                z = -z;
            }
            low *= albedos[0];
            high *= albedos[1];
        }
    }
}
