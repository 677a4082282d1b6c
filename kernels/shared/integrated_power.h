// Model `paper` without power tables: what eq. 3-5 are integrated for, and what distances are drawn from.
#ifndef STOKES_SHARED_INTEGRATED_POWER_H
#define STOKES_SHARED_INTEGRATED_POWER_H

#include "limits.h"

// A medium at the pass's wavelengths. Written by the host once per pass.
typedef struct PassMedium {
    float sigma_s[16];  // [1/mm]
    float sigma_a[16];  // [1/mm]; sigma_s + sigma_a is positive
    float dipole_a;     // A of eq. 5, at least 1
    float pad[15];
} PassMedium;
STOKES_ASSERT_SIZE(PassMedium, 192);

// The wavelengths over whose mean a medium's distances are drawn, as lib/integrated_distance.clh has it: `count` of
// them, in STOKES_MIX_ROWS rows of a buffer, from `first` on. Written by the host once per scene.
typedef struct DistanceMixture {
    unsigned int first;
    unsigned int count;   // at least 1
    float r_max_mm;       // distances end here, as those of the tables do
    float theta_max_deg;  // refraction angles beyond are taken for this one, likewise
    float reach_f_mm;     // sum of 1/sigma_t^2 over the wavelengths, divided by that of 1/sigma_t
    float reach_s_mm;     // the same, each wavelength weighing sigma_s; 0 where nothing scatters
    unsigned int pad[2];
} DistanceMixture;
STOKES_ASSERT_SIZE(DistanceMixture, 32);

// The rows. Cumulative ones hold the sums of the weights of the wavelengths 0..i over that of all, the last is 1.
#define STOKES_MIX_SIGMA_T 0u   // [1/mm]
#define STOKES_MIX_SIGMA_TR 1u  // sqrt(3 sigma_a sigma_t) [1/mm]
#define STOKES_MIX_V_LOW 2u     // asinh(r_max / z_v), z_v the depth of the dipole's virtual source
#define STOKES_MIX_V_HIGH 3u    // asinh(r_max sigma_t)
#define STOKES_MIX_F_DENSE 4u   // cumulative: 1/sigma_t^2
#define STOKES_MIX_F_THIN 5u    // cumulative: 1/sigma_t
#define STOKES_MIX_S_DENSE 6u   // cumulative: sigma_s/sigma_t^2
#define STOKES_MIX_S_THIN 7u    // cumulative: sigma_s/sigma_t
#define STOKES_MIX_M 8u         // cumulative: sigma_t (V_HIGH - V_LOW) (1 + a) exp(-a), a = sigma_tr/sigma_t
#define STOKES_MIX_ROWS 9u

#endif
