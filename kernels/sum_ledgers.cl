// Last stage of a pass's photons: the accounts of the paths are added up.
#include "lib/inline.clh"
#include "lib/light_sum.clh"
#include "shared/limits.h"
#include "shared/path.h"

// Adds a value; lost: what rounding has cost so far (Kahan 1965). All paths of a light start with the same flux, whose
// roundings would all go the same way.
FORCE_INLINE void add_exactly(float2* sum, float2* lost, float2 value) {
    const float2 owed = value - *lost;
    const float2 next = *sum + owed;
    *lost = (next - *sum) - owed;
    *sum = next;
}

// Work-items: chunks of chunk_size paths. Reads: ledgers [count]. Writes: sums [chunks].
__kernel void sum_ledgers(uint count, uint chunk_size, __global const PathLedger* ledgers, __global LedgerSums* sums) {
    const uint chunk = (uint)get_global_id(0);
    const uint first = chunk * chunk_size;
    if (first >= count) return;
    const uint last = min(first + chunk_size, count);
    LedgerSums total;
    float2 light[8], lost[8];
    for (uint k = 0u; k < 8u; ++k) light[k] = lost[k] = (float2)(0.0f);
    for (uint k = 0u; k < STOKES_FATE_COUNT; ++k) total.fates[k] = 0u;
    total.missed_exits = 0u;
    total.rays = 0u;
    total.reflections = 0u;
    total.pad[0] = total.pad[1] = 0u;
    for (uint i = first; i < last; ++i) {
        const PathLedger ledger = ledgers[i];
        add_exactly(&light[0], &lost[0], light_in(ledger.emitted));
        add_exactly(&light[1], &lost[1], light_in(ledger.absorbed));
        add_exactly(&light[2], &lost[2], light_in(ledger.stokes_loss));
        add_exactly(&light[3], &lost[3], light_in(ledger.escaped));
        add_exactly(&light[4], &lost[4], light_in(ledger.dropped));
        add_exactly(&light[5], &lost[5], light_in(ledger.roulette));
        add_exactly(&light[6], &lost[6], light_in(ledger.created));
        add_exactly(&light[7], &lost[7], light_in(ledger.stored));
        total.fates[min(ledger.fate, STOKES_FATE_COUNT - 1u)] += 1u;
        total.missed_exits += ledger.missed_exits;
        total.rays += ledger.rays;
        total.reflections += ledger.reflections;
    }
    for (uint k = 0u; k < 8u; ++k) total.light[k] = (LightSum){light[k].x, light[k].y};
    sums[chunk] = total;
}
