#include "host/render/ledger.hpp"

#include <fmt/core.h>

#include <cmath>
#include <numeric>

#include "host/core/log.hpp"

namespace stokes {

double Ledger::imbalance() const {
    const double came = emitted + created;
    return came > 0.0 ? (came - absorbed - stokes_loss - escaped - dropped - roulette) / came : 0.0;
}

void warn_about(const Ledger& ledger) {
    if (ledger.created > 0.01 * ledger.emitted)
        warn(fmt::format("{:.3g} times the emitted light was created, by power tables above one or by fluorophores that emit "
                         "more than they take up",
                         ledger.created / ledger.emitted));
    if (!(std::abs(ledger.imbalance()) < 1e-4))
        warn(fmt::format("the account of the light does not close: imbalance {:.2g}", ledger.imbalance()));
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
    if (ledger.stokes_loss < 0.0) {  // a fluorophore that emits more than it takes up
        ledger.created -= ledger.stokes_loss;
        ledger.stokes_loss = 0.0;
    }
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
            {"overflow", fates_[STOKES_FATE_OVERFLOW]}};
}

}  // namespace stokes
