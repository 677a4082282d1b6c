// Where the energy of a render went.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "host/render/photon_paths.hpp"

namespace stokes {

// Sums along the photons' paths, in energy or in photons:
// emitted + created = absorbed + stokes_loss + escaped + dropped + roulette.
struct Balance {
    double emitted = 0.0;
    double absorbed = 0.0;     // by surfaces, media and black; an estimate, which can be below 0 where nothing absorbs
    double stokes_loss = 0.0;  // taken up by fluorophores and not re-emitted
    double escaped = 0.0;      // left the scene
    double dropped = 0.0;      // cut off: missed exits, the limits of events and of flux
    double roulette = 0.0;     // statistical balance of Russian roulette and random weights, mean zero
    double created = 0.0;      // by power tables above one, and by fluorophores that emit more than they take up
    double stored = 0.0;       // put into the maps; not part of the sum, light is stored at every event

    // (emitted + created - everything the light went to) / (emitted + created): 0 but for rounding.
    double imbalance() const;
};

// Means over the passes, integrated over the render's wavelengths.
struct Ledger {
    Balance power;    // [W]
    Balance photons;  // [1/s]
    // Simulated paths, of all passes, by how they ended.
    std::uint64_t paths = 0, absorbed_paths = 0, escaped_paths = 0, dropped_paths = 0;
    std::uint64_t paths_behind = 0;  // of the absorbed ones: by the back of a translucent surface
};

// Says, once, what a user should not overlook: light created or cut off beyond a hundredth of what was emitted, an
// account that does not close to 1e-4, or photons that met translucent surfaces from behind. emitted_part: of the
// emitted light, what started where it could meet something.
void warn_about(const Ledger& ledger, double emitted_part = 1.0);

// Sums over all passes of a render.
class LedgerBook {
  public:
    // spectral_weight_nm: image_weight_nm() of the render.
    void add(const PhotonAccount& account, double spectral_weight_nm);

    Ledger ledger() const;
    // Deposits and paths that were dropped, by cause: missed_exit, map_full, event_limit, overflow.
    std::map<std::string, std::uint64_t> dropped() const;
    std::uint64_t photons() const;
    std::uint64_t rays() const { return rays_; }
    std::uint64_t deposits() const { return deposits_; }

  private:
    std::array<double, 8> power_{}, photons_{};  // in the order of LedgerSums [W], [1/s]
    std::array<std::uint64_t, STOKES_FATE_COUNT> fates_{};
    std::uint64_t passes_ = 0, rays_ = 0, missed_exits_ = 0, refused_slots_ = 0, deposits_ = 0;
};

}  // namespace stokes
