// Stage 4 of a pass, at diffuse surfaces: photons are stored with the flux they bring, and reflected.
#include "lib/normal.clh"
#include "lib/retrace.clh"
#include "lib/texture.clh"
#include "shared/arguments.h"
#include "shared/photon.h"

// Work-items: round.count, one an entry of its list.
// Reads: event_lists, points and hits [paths], spectra: row i is the reflectance of material i, without its texture;
// textures. Writes: the surface map's slot round.first_slot + i (incident flux [W/nm]; nothing
//   from round.slot_limit on), rays, flux, ledgers.
// The path goes on with probability mean(reflectance flux) / mean(flux) and its flux raised accordingly.
__kernel void scatter_diffuse(EventRound round, PASS_ARGUMENTS, TEXTURE_ARGUMENTS, __global const uint* event_lists,
                              __global const SurfacePoint* points, __global const Hit* hits, PATH_ARGUMENTS,
                              MAP_ARGUMENTS) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const uint path = event_lists[round.first_entry + i];
    const SurfacePoint point = points[path];
    const float3 normal = (float3)(point.nx, point.ny, point.nz);
    const float16 incident = flux[path];
    __global PathLedger* ledger = &ledgers[path];

    const float2 arriving = light_of(incident, pass);
    const uint slot = round.first_slot + i;
    if (slot < round.slot_limit) {
        map_heads[slot] = (PhotonHead){point.x, point.y, point.z, pack_normal(normal, point.body)};
        map_flux[slot] = incident;
        add_light(&ledger->stored, arriving);
    }

    const Textures textures = {texture_records, texels, texture_uv};
    const float luminance = texture_luminance(textures, point.material, hits[path]);
    const float16 reflected = incident * textured_reflectance(texture_records, spectra, point.material, luminance);
    const float2 leaving = light_of(reflected, pass);
    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_SCATTER);
    const float survival = arriving.x > 0.0f ? min(leaving.x / arriving.x, 1.0f) : 0.0f;
    add_light(&ledger->absorbed, arriving - leaving);
    if (!(draw.a < survival)) {
        add_light(&ledger->roulette, leaving);
        end_path(&rays[path], ledger, STOKES_FATE_ABSORBED);
        return;
    }
    const float16 carried = reflected / survival;
    const float2 going_on = light_of(carried, pass);
    add_light(&ledger->roulette, leaving - going_on);
    flux[path] = carried;
    continue_diffuse(&rays[path], &departures[path], ledger, &round, pass->offset_mm,
                     (float3)(point.x, point.y, point.z), normal, going_on, draw.b, draw.c);
}
