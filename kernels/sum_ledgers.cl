// Last stage of a pass: the paths' accounts, added up.
#include "shared/limits.h"
#include "shared/path.h"

// Work-items: chunks of chunk_size paths. Reads: ledgers [count]. Writes: sums [chunks].
__kernel void sum_ledgers(uint count, uint chunk_size, __global const PathLedger* ledgers,
                          __global LedgerSums* sums) {
    const uint chunk = (uint)get_global_id(0);
    const uint first = chunk * chunk_size;
    if (first >= count) return;
    const uint last = min(first + chunk_size, count);
    LedgerSums total;
    for (uint k = 0u; k < 8u; ++k) total.flux[k] = 0.0f;
    for (uint k = 0u; k < STOKES_FATE_COUNT; ++k) total.fates[k] = 0u;
    total.missed_exits = 0u;
    total.rays = 0u;
    total.pad[0] = total.pad[1] = total.pad[2] = 0u;
    for (uint i = first; i < last; ++i) {
        const PathLedger ledger = ledgers[i];
        total.flux[0] += ledger.emitted;
        total.flux[1] += ledger.absorbed;
        total.flux[2] += ledger.stokes_loss;
        total.flux[3] += ledger.escaped;
        total.flux[4] += ledger.dropped;
        total.flux[5] += ledger.roulette;
        total.flux[6] += ledger.created;
        total.flux[7] += ledger.stored;
        total.fates[min(ledger.fate, STOKES_FATE_COUNT - 1u)] += 1u;
        total.missed_exits += ledger.missed_exits;
        total.rays += ledger.rays;
    }
    sums[chunk] = total;
}
