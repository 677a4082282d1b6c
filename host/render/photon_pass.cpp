#include "host/render/photon_pass.hpp"

#include <algorithm>

#include "host/core/error.hpp"
#include "host/render/translucent_bodies.hpp"

namespace stokes {

namespace {

// Rounds of events after which the remaining paths are cut and counted. Roulette ends nearly all paths long before.
constexpr std::uint32_t round_limit = 1000;

PhotonMaps make_maps(const Device& device, std::uint32_t slots, HashBuilder* builder, SpatialHash* hash) {
    const auto map = [&](const char* name) { return PhotonMap(device, name, slots, builder, hash); };
    return {map("fluorescence"), map("single scattering"), map("multiple scattering"), map("surface")};
}

}  // namespace

PhotonPass::PhotonPass(const Device& device, const Scene& scene, const DeviceScene& on_device, std::uint32_t photons,
                       std::uint32_t first_slots, HashBuilder* builder, SpatialHash* hash)
    : on_device_(on_device),
      inputs_(device, scene, on_device),
      paths_(device, photons),
      maps_(make_maps(device, first_slots, builder, hash)),
      exits_(device, on_device.rays.kernels),
      transports_(make_transports(device, scene, on_device)),
      translucent_bodies_(translucent_bodies(scene)),
      met_bodies_(device, "bodies that photons met",
                  std::vector<std::uint32_t>(static_cast<std::size_t>(std::max(scene.body_count, 1)), 0u)) {
    sampling_.store_direct = resolved(scene.render).direct == Direct::photons;
    const Program emission(device, "emit_photons.cl");
    emit_ = emission.kernel("emit_photons");
    emit_stratified_ = emission.kernel("emit_stratified");
    const RayKernels& kernels = on_device.rays.kernels;
    trace_ = on_device.has_contacts ? kernels.program(device, "settle_hits.cl").kernel("trace_photons")
                                    : kernels.program(device, "trace_rays.cl").kernel("trace_closest");
    classify_ = Program(device, "classify_photons.cl").kernel("classify_photons");
    scatter_ = Program(device, "scatter_photons.cl").kernel("scatter_diffuse");
}

void PhotonPass::prepare(std::uint32_t pass, std::uint32_t photons) {
    inputs_.prepare(pass, photons);
    for (const auto& transport : transports_) transport->prepare(inputs_.spectra());
}

void PhotonPass::prepare(const PassWavelengths& wavelengths, std::uint32_t pass, std::uint32_t photons) {
    inputs_.prepare(wavelengths, pass, photons);
    for (const auto& transport : transports_) transport->prepare(inputs_.spectra());
}

PhotonAccount PhotonPass::trace(const PathSampling& sampling) {
    for (PhotonMap& map : maps_) map.clear();
    common_ = arguments().add(paths_.arguments());
    DepositCounts counts;
    emit();
    EventRound round{};
    for (std::uint32_t alive = inputs_.photons(); alive > 0; ++round.event) {
        round.last = round.event + 1 >= round_limit ? 1 : 0;
        round.count = alive;
        round.branches = sampling.both_branches ? 1 : 0;
        round.notes_bodies = unmet_bodies_.empty() ? 0 : 1;
        trace_rays(alive);
        const ListCounts lists = classify(round);
        const SubsurfaceEvent event{round, lists, sampling, common_, maps_, exits_, counts};
        scatter_at_surfaces(event);
        check_scattered(lists);
        for (const auto& transport : transports_) transport->scatter(event);
        paths_.end_round();
        alive = lists.alive;
    }
    common_ = {};
    forget_met_bodies();
    PhotonAccount account = paths_.sum_ledgers(inputs_.photons());
    account.rays += counts.probes;
    account.refused_slots = counts.refused_slots;
    account.deposits = counts.deposits;
    return account;
}

void PhotonPass::note_met_bodies() {
    unmet_bodies_ = translucent_bodies_;
    met_bodies_.upload(std::vector<std::uint32_t>(met_bodies_.size(), 0u));
}

void PhotonPass::forget_met_bodies() {
    if (unmet_bodies_.empty()) return;
    const std::vector<std::uint32_t> met = met_bodies_.download();
    const auto is_met = [&](int body) { return met[static_cast<std::size_t>(body)] != 0; };
    unmet_bodies_.erase(std::remove_if(unmet_bodies_.begin(), unmet_bodies_.end(), is_met), unmet_bodies_.end());
}

Arguments PhotonPass::arguments() const { return on_device_.arguments().add(inputs_.arguments()); }

void PhotonPass::emit() const {
    (inputs_.has_cells() ? emit_stratified_ : emit_).launch(inputs_.photons(), common_, paths_.list());
}

void PhotonPass::trace_rays(std::uint32_t count) const {
    trace_.launch(count, Arguments("n", count), common_, paths_.list());
}

// Finds what happens to each photon where it landed, and lists them by that.
ListCounts PhotonPass::classify(const EventRound& round) {
    classify_.launch(round.count, Arguments("round", round), common_, paths_.list(),
                     Arguments("met_bodies", met_bodies_));
    return paths_.make_lists(round.count);
}

// RunError where paths are in a list that no transport goes through: they would never end.
void PhotonPass::check_scattered(const ListCounts& lists) const {
    std::array<bool, STOKES_LIST_COUNT> scattered{};
    scattered[STOKES_LIST_DIFFUSE] = true;
    for (const auto& transport : transports_)
        for (const std::uint32_t event : {STOKES_EVENT_FLUORESCENCE, STOKES_EVENT_ELASTIC, STOKES_EVENT_BRANCHES})
            if (transport->scatters(event)) scattered[STOKES_LIST_BELOW(transport->code(), event)] = true;
    for (std::size_t list = 0; list < scattered.size(); ++list)
        if (lists.count[list] > 0 && !scattered[list])
            throw RunError("photons below a surface that no transport scatters");
}

// Stores and reflects the photons at diffuse surfaces. Those straight from a light are not stored where shadow rays
// bring that light to the camera.
void PhotonPass::scatter_at_surfaces(const SubsurfaceEvent& event) {
    EventRound round = event.round;
    round.count = event.lists.count[STOKES_LIST_DIFFUSE];
    round.first_entry = event.lists.first[STOKES_LIST_DIFFUSE];
    if (round.count == 0) return;
    const bool stores = round.event > 0 || event.sampling.store_direct;
    PhotonMap& map = maps_[STOKES_MAP_SURFACE];
    const Slots slots = event.take_slots(map, round, stores ? 1 : 0);
    round.first_slot = slots.first;
    round.slot_limit = slots.limit;
    scatter_.launch(round.count, Arguments("round", round), common_, map.arguments());
    event.counts.deposits += stores ? round.count : 0;
    event.counts.refused_slots += slots.refused;
}

}  // namespace stokes
