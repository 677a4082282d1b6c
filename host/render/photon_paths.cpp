#include "host/render/photon_paths.hpp"

#include <utility>

namespace stokes {

namespace {

// Paths or list entries that one work-item counts; fixed, so that results do not depend on the device.
constexpr std::uint32_t chunk_size = 512;

std::uint32_t chunks_of(std::uint32_t count) { return (count + chunk_size - 1) / chunk_size; }

Arguments chunked(std::uint32_t count) { return Arguments("count", count).add("chunk_size", chunk_size); }

}  // namespace

PhotonPaths::PhotonPaths(const Device& device, std::uint32_t paths)
    : rays_(device, "photon rays", paths),
      departures_(device, "departures", paths),
      hits_(device, "photon hits", paths),
      flux_(device, "photon flux", paths),
      ledgers_(device, "photon ledgers", paths),
      points_(device, "surface points", paths),
      event_samples_(device, "event samples", paths),
      alive_(device, "photon list", paths),
      next_alive_(device, "next photon list", paths),
      event_lists_(device, "event lists", paths),
      entry_lists_(device, "lists of entries", paths),
      chunk_counts_(device, "list counts", chunks_of(paths)),
      totals_(device, "list totals", 1),
      sums_(device, "ledger sums", chunks_of(paths)) {
    const Program lists(device, "classify_photons.cl");
    count_ = lists.kernel("count_lists");
    scan_ = lists.kernel("scan_lists");
    write_ = lists.kernel("write_lists");
    sum_ = Program(device, "sum_ledgers.cl").kernel("sum_ledgers");
    arguments_ = Arguments("rays", rays_)
                     .add("departures", departures_)
                     .add("flux", flux_)
                     .add("ledgers", ledgers_)
                     .add("hits", hits_)
                     .add("points", points_)
                     .add("event_samples", event_samples_)
                     .add("event_lists", event_lists_)
                     .add("entry_lists", entry_lists_);
}

ListCounts PhotonPaths::make_lists(std::uint32_t count) {
    const std::uint32_t chunks = chunks_of(count);
    const Arguments counts = Arguments("chunk_counts", chunk_counts_).add("totals", totals_).add("chunks", chunks);
    count_.launch(chunks, chunked(count), arguments_, counts);
    scan_.launch(1, counts);
    write_.launch(chunks, chunked(count), list(), arguments_, counts, Arguments("next_alive", next_alive_));
    return totals_.download(1).front();
}

void PhotonPaths::end_round() { std::swap(alive_, next_alive_); }

PhotonAccount PhotonPaths::sum_ledgers(std::uint32_t count) const {
    sum_.launch(chunks_of(count), chunked(count), arguments_, Arguments("sums", sums_));
    PhotonAccount account;
    for (const LedgerSums& sums : sums_.download(chunks_of(count))) {
        for (std::size_t k = 0; k < account.energy.size(); ++k) {
            account.energy[k] += static_cast<double>(sums.light[k].energy);
            account.photons[k] += static_cast<double>(sums.light[k].photons);
        }
        for (std::size_t k = 0; k < account.fates.size(); ++k) account.fates[k] += sums.fates[k];
        account.rays += sums.rays;
        account.missed_exits += sums.missed_exits;
        account.reflections += sums.reflections;
    }
    return account;
}

}  // namespace stokes
