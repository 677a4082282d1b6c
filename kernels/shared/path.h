// A photon under way, and the account of its energy.
#ifndef STOKES_SHARED_PATH_H
#define STOKES_SHARED_PATH_H

#include "limits.h"

// PathLedger.fate: how a path ended.
#define STOKES_FATE_ALIVE 0u
#define STOKES_FATE_ABSORBED 1u      // by a black surface, by roulette, or with no flux left
#define STOKES_FATE_ESCAPED 2u       // left the scene
#define STOKES_FATE_MISSED_EXIT 3u   // its exit point found no surface
#define STOKES_FATE_MAP_FULL 4u      // no slot was left for its deposit
#define STOKES_FATE_OVERFLOW 5u      // its flux grew beyond STOKES_FLUX_LIMIT times what it started with
#define STOKES_FATE_EVENT_LIMIT 6u   // the pass's limit of events was reached
#define STOKES_FATE_COUNT 7u

// Power tables above one can multiply light without end where it cannot leave; a path is cut at this multiple.
#define STOKES_FLUX_LIMIT 1e6f

// What happens at a hit. Written by classify_photons.
#define STOKES_EVENT_NONE 0u
#define STOKES_EVENT_DIFFUSE 1u
#define STOKES_EVENT_FLUORESCENCE 2u
#define STOKES_EVENT_ELASTIC 3u

// Sums over the 16 wavelengths of the flux [W/nm] along one path; at its end
// emitted + created = absorbed + stokes_loss + escaped + dropped + roulette. Written by every photon kernel.
typedef struct PathLedger {
    float emitted;
    float absorbed;
    float stokes_loss;  // taken up by a fluorophore and not re-emitted
    float escaped;
    float dropped;      // cut off: missed exits, fluorescence without a slot, the limit of events, overflow
    float roulette;     // ended by Russian roulette minus what survivors were raised by; mean zero
    float created;      // made by power tables above one
    float stored;       // put into the maps
    unsigned int fate;           // STOKES_FATE_*
    unsigned int missed_exits;   // deposits dropped because the exit point found no surface
    unsigned int rays;           // rays traced for it so far, probes not counted
    float reference_flux;        // mean flux at emission [W/nm], the measure for roulette
    unsigned int conversions;    // how often its light has been re-radiated
    unsigned int pad[3];
} PathLedger;
STOKES_ASSERT_SIZE(PathLedger, 64);

// The accounts of a chunk of paths, added up. Written by sum_ledgers, read back by the host once a pass.
typedef struct LedgerSums {
    float flux[8];          // emitted, absorbed, stokes_loss, escaped, dropped, roulette, created, stored [W/nm]
    unsigned int fates[7];  // paths by STOKES_FATE_*
    unsigned int missed_exits;
    unsigned int rays;
    unsigned int pad[3];
} LedgerSums;
STOKES_ASSERT_SIZE(LedgerSums, 80);

// Where a path meets a surface. Written by classify_photons.
typedef struct SurfacePoint {
    float x, y, z;          // [mm]
    unsigned int material;  // index into the MaterialRecord buffer
    float nx, ny, nz;       // geometric normal, outward, unit length
    unsigned int body;
} SurfacePoint;
STOKES_ASSERT_SIZE(SurfacePoint, 32);

// One subsurface exit. Written by sample_exits, place_exits and deposit_exits.
typedef struct ExitPoint {
    float x, y, z;     // on the surface [mm]
    float r_mm;        // distance from the entry in the tangent plane; negated where no surface was found
    float nx, ny, nz;  // surface normal there, outward, unit length
    float row;         // where the power tables are read: refraction angle [deg]
    unsigned int path;
    unsigned int material;
    float kept;       // sum of the deposited flux over the wavelengths [W/nm]
    float converted;  // fluorescence: sum of the flux before the power table [W/nm]
} ExitPoint;
STOKES_ASSERT_SIZE(ExitPoint, 48);

// One round of events: passed by value to the photon kernels.
typedef struct EventRound {
    unsigned int count;      // work-items
    unsigned int event;      // index of the round, from 0
    unsigned int component;  // STOKES_MAP_*: which map is being written
    unsigned int first_exit;    // first of the component's exits in the exit buffer
    unsigned int first_slot;    // first free slot of the component's map
    unsigned int slot_limit;    // capacity of the map
    unsigned int second_exit;   // elastic: first exit of multiple scattering
    unsigned int last;          // 1: paths that would go on are cut and counted
} EventRound;
STOKES_ASSERT_SIZE(EventRound, 32);

// Read back by the host once a round. Written by scan_lists.
typedef struct ListCounts {
    unsigned int alive, diffuse, fluorescence, elastic;
} ListCounts;
STOKES_ASSERT_SIZE(ListCounts, 16);

#endif
