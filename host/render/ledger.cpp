#include "host/render/ledger.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/core/log.hpp"

namespace stokes {

// Share of the photons that may meet the backs of translucent surfaces unsaid: rays between triangles that do not quite
// meet.
constexpr double most_behind = 1e-4;

double Balance::imbalance() const {
    const double came = emitted + created;
    return came > 0.0 ? (came - absorbed - stokes_loss - escaped - dropped - roulette) / came : 0.0;
}

void warn_about(const Ledger& ledger, double emitted_part) {
    const Balance& power = ledger.power;
    const double started = emitted_part * power.emitted;
    if (power.created > 0.01 * started)
        warn(fmt::format(
            "{:.3g} times the emitted light was created, by power tables above one or by fluorophores that emit "
            "more than they take up",
            power.created / started));
    const double behind =
        static_cast<double>(ledger.paths_behind) / static_cast<double>(std::max<std::uint64_t>(ledger.paths, 1));
    if (behind > most_behind)
        warn(fmt::format(
            "{:.2g} of the photons met a translucent surface from behind and were absorbed there: its faces look "
            "inward, bodies pass through one another, or it is seen through an opening",
            behind));
    if (power.dropped > 0.01 * started)
        warn(fmt::format(
            "{:.3g} times the emitted light was cut off, where paths were too long or found no surface to leave "
            "through: the picture is too dark",
            power.dropped / started));
    for (const double imbalance : {power.imbalance(), ledger.photons.imbalance()})
        if (!(std::abs(imbalance) < 1e-4)) {
            warn(fmt::format("the account of the light does not close: imbalance {:.2g}", imbalance));
            return;
        }
}

void LedgerBook::add(const PhotonAccount& account, double spectral_weight_nm) {
    // lambda/(h c) turns power into photons; wavelengths are nanometres.
    constexpr double planck_times_light = 6.62607015e-34 * 299792458.0;
    for (std::size_t k = 0; k < power_.size(); ++k) {
        power_[k] += account.energy[k] * spectral_weight_nm;
        photons_[k] += account.photons[k] * spectral_weight_nm * 1e-9 / planck_times_light;
    }
    for (std::size_t k = 0; k < fates_.size(); ++k) fates_[k] += account.fates[k];
    rays_ += account.rays;
    missed_exits_ += account.missed_exits;
    refused_slots_ += account.refused_slots;
    deposits_ += account.deposits;
    ++passes_;
}

std::uint64_t LedgerBook::photons() const { return std::accumulate(fates_.begin(), fates_.end(), std::uint64_t{0}); }

namespace {

Balance mean_balance(const std::array<double, 8>& sums, double share) {
    Balance balance;
    double* const fields[] = {&balance.emitted, &balance.absorbed, &balance.stokes_loss, &balance.escaped,
                              &balance.dropped, &balance.roulette, &balance.created,     &balance.stored};
    for (std::size_t k = 0; k < sums.size(); ++k) *fields[k] = sums[k] * share;
    if (balance.stokes_loss < 0.0) {  // a fluorophore that emits more than it takes up
        balance.created -= balance.stokes_loss;
        balance.stokes_loss = 0.0;
    }
    return balance;
}

}  // namespace

Ledger LedgerBook::ledger() const {
    const double share = passes_ > 0 ? 1.0 / static_cast<double>(passes_) : 0.0;
    Ledger ledger;
    ledger.power = mean_balance(power_, share);
    ledger.photons = mean_balance(photons_, share);
    ledger.paths = photons();
    ledger.paths_behind = fates_[STOKES_FATE_BEHIND];
    ledger.absorbed_paths = fates_[STOKES_FATE_ABSORBED] + ledger.paths_behind;
    ledger.escaped_paths = fates_[STOKES_FATE_ESCAPED];
    ledger.dropped_paths = ledger.paths - ledger.absorbed_paths - ledger.escaped_paths;
    return ledger;
}

std::map<std::string, std::uint64_t> LedgerBook::dropped() const {
    return {{"missed_exit", missed_exits_},
            {"map_full", refused_slots_},
            {"event_limit", fates_[STOKES_FATE_EVENT_LIMIT]},
            {"overflow", fates_[STOKES_FATE_OVERFLOW]}};
}

}  // namespace stokes
