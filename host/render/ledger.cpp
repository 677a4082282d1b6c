#include "host/render/ledger.hpp"

#include <numeric>

namespace stokes {

double Ledger::imbalance() const {
    if (!(emitted > 0.0)) return 0.0;
    return (emitted + created - absorbed - stokes_loss - escaped - dropped - roulette) / emitted;
}

void LedgerBook::add(const PhotonAccount& account, double spectral_weight_nm) {
    for (std::size_t k = 0; k < energy_.size(); ++k) energy_[k] += account.flux[k] * spectral_weight_nm;
    for (std::size_t k = 0; k < fates_.size(); ++k) fates_[k] += account.fates[k];
    rays_ += account.rays;
    missed_exits_ += account.missed_exits;
    refused_slots_ += account.refused_slots;
    deposits_ += account.deposits;
    ++passes_;
}

std::uint64_t LedgerBook::photons() const { return std::accumulate(fates_.begin(), fates_.end(), std::uint64_t{0}); }

Ledger LedgerBook::ledger() const {
    const double share = passes_ > 0 ? 1.0 / static_cast<double>(passes_) : 0.0;
    Ledger ledger;
    double* const fields[] = {&ledger.emitted, &ledger.absorbed, &ledger.stokes_loss, &ledger.escaped,
                              &ledger.dropped, &ledger.roulette, &ledger.created,     &ledger.stored};
    for (std::size_t k = 0; k < energy_.size(); ++k) *fields[k] = energy_[k] * share;
    ledger.photons = photons();
    ledger.absorbed_photons = fates_[STOKES_FATE_ABSORBED];
    ledger.escaped_photons = fates_[STOKES_FATE_ESCAPED];
    ledger.dropped_photons = ledger.photons - ledger.absorbed_photons - ledger.escaped_photons;
    return ledger;
}

std::map<std::string, std::uint64_t> LedgerBook::dropped() const {
    return {{"missed_exit", missed_exits_},
            {"map_full", refused_slots_},
            {"event_limit", fates_[STOKES_FATE_EVENT_LIMIT]},
            {"not_finite", fates_[STOKES_FATE_NOT_FINITE]}};
}

}  // namespace stokes
