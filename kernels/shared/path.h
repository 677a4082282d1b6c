// A photon under way, and the account of its energy.
#ifndef STOKES_SHARED_PATH_H
#define STOKES_SHARED_PATH_H

#include "limits.h"
#include "material.h"

// PathLedger.fate: how a path ended.
#define STOKES_FATE_ALIVE 0u
#define STOKES_FATE_ABSORBED 1u     // by a black surface, by roulette, or with no flux left
#define STOKES_FATE_ESCAPED 2u      // left the scene
#define STOKES_FATE_MISSED_EXIT 3u  // its exit point found no surface
#define STOKES_FATE_OVERFLOW 4u     // its flux grew beyond STOKES_FLUX_LIMIT times what it started with
#define STOKES_FATE_EVENT_LIMIT 5u  // the pass's limit of events was reached
#define STOKES_FATE_BEHIND 6u       // absorbed by the back of a translucent surface
#define STOKES_FATE_COUNT 7u

// Power tables above one can multiply light without end where it cannot leave; a path is cut at this multiple.
#define STOKES_FLUX_LIMIT 1e6f

// What happens at a hit.
#define STOKES_EVENT_NONE 0u
#define STOKES_EVENT_DIFFUSE 1u
#define STOKES_EVENT_SPECULAR 2u  // reflected at a smooth surface; only the ray changes
// Below a surface, from here on: the light meets a fluorophore; it scatters (model `walk`: all that happens there); or
// both, each with its weight, and the path goes on along one of them.
#define STOKES_EVENT_FLUORESCENCE 3u
#define STOKES_EVENT_ELASTIC 4u
#define STOKES_EVENT_BRANCHES 5u

// The lists that the paths of a round are sorted into by what happens to them: one of diffuse surfaces, then those of
// FLUORESCENCE, ELASTIC and BRANCHES of each transport model (STOKES_TRANSPORT_*).
#define STOKES_LIST_DIFFUSE 0u
#define STOKES_LIST_BELOW(transport, event) (1u + 3u * (transport) + (event)-STOKES_EVENT_FLUORESCENCE)
#define STOKES_LIST_COUNT (1u + 3u * STOKES_TRANSPORT_COUNT)
// Of a path in no list: it goes on, or has ended.
#define STOKES_LIST_NONE 254u
#define STOKES_LIST_ENDED 255u

// Sums over a pass's 16 wavelengths.
typedef struct LightSum {
    float energy;   // of flux [W/nm]
    float photons;  // of flux times wavelength [W]: h c times a number of photons per second
} LightSum;
STOKES_ASSERT_SIZE(LightSum, 8);

// The light along one path, in energy and in photons; at its end
// emitted + created = absorbed + stokes_loss + escaped + dropped + roulette. Written by every photon kernel.
typedef struct PathLedger {
    LightSum emitted;
    LightSum absorbed;     // by surfaces and media
    LightSum stokes_loss;  // taken up by a fluorophore and not re-emitted
    LightSum escaped;
    LightSum dropped;   // cut off: missed exits, the limit of events, overflow
    LightSum roulette;  // ended by Russian roulette minus what survivors were raised by, and what random weights add
                        // and take; mean zero
    LightSum created;   // model `paper`: made by power tables above one
    LightSum stored;    // put into the maps
    unsigned int fate;  // STOKES_FATE_*
    unsigned int missed_exits;  // deposits dropped because the exit point found no surface
    unsigned int rays;          // rays traced for it so far, probes not counted
    float reference_flux;       // mean flux at emission [W/nm], the measure for roulette
    unsigned int conversions;   // how often its light has been re-radiated
    unsigned int reflections;   // how often it was reflected specularly
    unsigned int history;       // stratified wavelengths: bit k: its light was taken up at the pass's wavelength k
    unsigned int leader;        // the one that the event in progress takes it up at, or STOKES_NONE
} PathLedger;
STOKES_ASSERT_SIZE(PathLedger, 96);

// The accounts of a chunk of paths, added up. Written by sum_ledgers, read back by the host once a pass.
typedef struct LedgerSums {
    LightSum light[8];      // emitted, absorbed, stokes_loss, escaped, dropped, roulette, created, stored
    unsigned int fates[7];  // paths by STOKES_FATE_*
    unsigned int missed_exits;
    unsigned int rays;
    unsigned int reflections;
    unsigned int pad[2];
} LedgerSums;
STOKES_ASSERT_SIZE(LedgerSums, 112);

// Where a path's ray starts. Written by emission, and by every kernel that sends a path on.
typedef struct Departure {
    float nx, ny, nz;      // normal of the surface that it leaves, on the side to which it leaves, unit length
    unsigned int body;     // the body that it met last, STOKES_NONE: none yet; written by classify_photons
    unsigned int inside;   // the body of model `walk` in whose medium it runs, STOKES_NONE: it runs in the open
    unsigned int arrives;  // 1: its walk in that medium has ended: it reaches what lies within
    unsigned int pad[2];
} Departure;
STOKES_ASSERT_SIZE(Departure, 32);

// Where a path meets a surface. Written by classify_photons.
typedef struct SurfacePoint {
    float x, y, z;          // [mm]
    unsigned int material;  // index into the MaterialRecord buffer
    float nx, ny, nz;       // geometric normal on the side that was met, unit length
    unsigned int body;
} SurfacePoint;
STOKES_ASSERT_SIZE(SurfacePoint, 32);

// Two coordinates of a photon's low-discrepancy point, as scrambled binary digits, the first one lowest: they draw the
// distance, or direction, and the azimuth of each exit of its first event. Written by emit_stratified.
typedef struct EventSample {
    unsigned int first, second;
} EventSample;
STOKES_ASSERT_SIZE(EventSample, 8);

// EventRound.sampler: how exit points are found and what leaves there.
#define STOKES_SAMPLER_PAPER 0u      // distance from the component's power table, PHYSICS section 3
#define STOKES_SAMPLER_DIRECT 1u     // straight from the first collision to the surface: G0 of PHYSICS section 4
#define STOKES_SAMPLER_SCATTERED 2u  // distance from the Green's function table: G1
#define STOKES_SAMPLER_INTEGRATED \
    3u  // PHYSICS section 3 without tables, by integrate_power.cl; below the same as PAPER

// One subsurface exit. Written by sample_exits, place_exits, fold_exits and deposit_exits.
typedef struct ExitPoint {
    float x, y, z;     // on the surface [mm]
    float r_mm;        // distance from the entry in the tangent plane, or from the foot of the first collision
    float nx, ny, nz;  // surface normal there, outward, unit length
    float row;         // PAPER: refraction angle [deg]; DIRECT: way from the first collision to the surface [mm];
                       // SCATTERED: depth of the first collision [mm]
    unsigned int path;
    unsigned int material;
    float way_mm;          // to the first collision, along the refracted ray
    float scale;           // factor on what leaves: PAPER the table's density of r over the drawn one, DIRECT 1/density
                           // of the direction, SCATTERED 1/density of r, the last two over the number of exits
    LightSum kept;         // the deposited flux; PAPER: before the branch's weight
    LightSum event_light;  // PAPER: re-emitted as fluorescence; DIRECT: what the first collision sends on; SCATTERED:
                           // what it takes up
    unsigned int found;    // 1: it lies on the surface; 0: there is none
} ExitPoint;
STOKES_ASSERT_SIZE(ExitPoint, 68);

// One round of events: passed by value to the photon kernels.
typedef struct EventRound {
    unsigned int count;         // work-items
    unsigned int event;         // index of the round, from 0
    unsigned int component;     // STOKES_MAP_*: which map is being written
    unsigned int sampler;       // STOKES_SAMPLER_*
    unsigned int first_exit;    // first of the component's exits in the exit buffer; those of an event stand together
    unsigned int first_slot;    // first free slot of the component's map
    unsigned int slot_limit;    // capacity of the map
    unsigned int second_exit;   // retrace_elastic: first of the multiple-scattering exits in the exit buffer
    unsigned int last;          // 1: paths that would go on are cut and counted
    unsigned int exits;         // exits of an event and component, at least 1
    unsigned int branches;      // 1: the events are STOKES_EVENT_BRANCHES; classify_photons: they may become that
    unsigned int drawn_rows;    // PAPER: first entry of the distance densities that r is drawn from; 0: the tables' own
    unsigned int first_entry;   // of the round's list in the buffer of all lists
    unsigned int notes_bodies;  // classify_photons: 1: bodies that are met are noted
    unsigned int pad[2];
} EventRound;
STOKES_ASSERT_SIZE(EventRound, 64);

// Where the exits of a list of events stand, in groups of one component each: direct and scattered ones of a branch,
// and with STOKES_EVENT_BRANCHES those of the other branch. Passed by value.
typedef struct ExitGroups {
    unsigned int count;          // 2 or 4
    unsigned int component[4];   // STOKES_MAP_*
    unsigned int first_exit[4];  // as in EventRound
    unsigned int pad[3];
} ExitGroups;
STOKES_ASSERT_SIZE(ExitGroups, 48);

// Where walk_photons stores, by map STOKES_MAP_*: F, S and M. Passed by value.
typedef struct WalkSlots {
    unsigned int first[3];  // first free slot
    unsigned int limit[3];  // capacity
    unsigned int pad[2];
} WalkSlots;
STOKES_ASSERT_SIZE(WalkSlots, 32);

// Read back by the host once a round. Written by scan_lists; of a chunk, by count_lists and scan_lists.
typedef struct ListCounts {
    unsigned int alive;                     // paths that go on, be they in a list or not
    unsigned int count[STOKES_LIST_COUNT];  // paths in each list
    unsigned int first[STOKES_LIST_COUNT];  // where each list starts in the buffer of all lists
    unsigned int pad[3];
} ListCounts;
STOKES_ASSERT_SIZE(ListCounts, 96);

#endif
