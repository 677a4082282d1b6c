// Once per pass: photon power tables from their own wavelengths onto the pass's sixteen, so that a look-up later is
// one 64-byte line.
// Work-items: one an entry (row, r) of all tables in the buffer, guarded by count.
// Reads:  full [entry][lambda], the tables' unit, at lambda_first_nm + i lambda_step_nm, i < n_lambda;
//         lambda_nm16 [16], nm.
// Writes: table16 [entry], sixteen values, the tables' unit.
// Equation: linear interpolation in wavelength, held beyond the first and the last of the table.
#include "lib/power_table.clh"

__kernel void resample_table(__global const float* restrict full, uint n_lambda, float lambda_first_nm,
                             float lambda_step_nm, __global const float* restrict lambda_nm16,
                             __global float16* restrict table16, uint count) {
    const uint entry = (uint)get_global_id(0);
    if (entry >= count) return;
    __global const float* values = full + (size_t)entry * n_lambda;
    float resampled[STOKES_WAVELENGTHS];
    for (int i = 0; i < STOKES_WAVELENGTHS; ++i) {
        const TablePlace place = table_place(lambda_nm16[i], lambda_first_nm, lambda_step_nm, n_lambda);
        resampled[i] = mix(values[place.lower], values[place.upper], place.fraction);
    }
    table16[entry] = vload16(0, resampled);
}
