#include "host/render/probe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/error.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/photon_pass.hpp"
#include "host/render/probe_grid.hpp"
#include "host/render/probe_scene.hpp"
#include "host/render/probe_sets.hpp"
#include "host/render/transport/transport_model.hpp"
#include "host/subsurface/escape.hpp"

namespace stokes {

namespace {

constexpr std::int64_t least_batches = 32, most_photons_per_batch = 65536;

void check(const ProbeMaterial& material, const ProbeSettings& s) {
    const auto expect = [](bool good, const char* what) {
        if (!good) throw InputError(fmt::format("probe: expected {}", what));
    };
    const auto covered = [](int lambda) { return lambda >= first_lambda_nm && lambda <= last_lambda_nm; };
    expect(material.medium || !material.dyes.empty(), "a medium, a fluorophore or both");
    expect(s.angle_deg >= 0.0 && s.angle_deg <= 89.9, "an angle of incidence in [0, 89.9] deg");
    expect(s.photons >= least_probe_photons && s.photons <= 1000000000000, "photons in [64, 1e12]");
    expect(covered(s.lambda_min_nm) && covered(s.lambda_max_nm) &&
               s.lambda_max_nm - s.lambda_min_nm >= STOKES_WAVELENGTHS - 1,
           "a range of at least 16 whole nanometres within [300, 830] nm");
    expect(s.step_nm >= 1 && s.step_nm <= 50, "a step in [1, 50] nm");
    expect(s.bins >= 2 && s.bins <= 10000, "from 2 to 10000 bins");
    expect(!s.r_max_mm || (*s.r_max_mm >= 1e-9 && *s.r_max_mm <= 1e12), "a largest distance in [1e-9, 1e12] mm");
    expect(!s.first_collision_only || transport_model(s.transport).takes_up_again(false),
           "fluorescence at the first collision only with the transport walk; it is what the others do");
}

// Where a batch's sums of a component stand: by wavelength, by bin (the last for what lies beyond), and the
// total.
class Layout {
  public:
    Layout(std::size_t wavelengths, std::size_t bins) : wavelengths_(wavelengths), bins_(bins) {}
    std::size_t at_wavelength(std::size_t component, std::size_t i) const { return component * stride() + i; }
    std::size_t in_bin(std::size_t component, std::size_t bin) const {
        return component * stride() + wavelengths_ + bin;
    }
    std::size_t total(std::size_t component) const { return (component + 1) * stride() - 1; }
    std::size_t emitted_photons() const { return probe_component_count * stride(); }
    std::size_t size() const { return probe_component_count * stride() + 1; }

  private:
    std::size_t stride() const { return wavelengths_ + bins_ + 2; }
    std::size_t wavelengths_, bins_;
};

// Means over batches and their standard errors (Welford 1962).
class BatchMeans {
  public:
    explicit BatchMeans(std::size_t size) : mean_(size, 0.0), squares_(size, 0.0) {}
    void add(const std::vector<double>& batch) {
        ++count_;
        for (std::size_t i = 0; i < mean_.size(); ++i) {
            const double before = batch[i] - mean_[i];
            mean_[i] += before / count_;
            squares_[i] += before * (batch[i] - mean_[i]);
        }
    }
    Measured at(std::size_t i) const { return {mean_[i], std::sqrt(squares_[i] / (count_ * (count_ - 1.0)))}; }

  private:
    double count_ = 0.0;
    std::vector<double> mean_, squares_;
};

}  // namespace

struct HalfSpaceProbe::Bench {
    Bench(const Device& on, const ProbeMaterial& probed, const ProbeSettings& s)
        : device(on),
          material(probed),
          settings(s),
          scene(probe_scene(probed, s)),
          on_device(on, scene),
          batches(std::max(least_batches, (s.photons + most_photons_per_batch - 1) / most_photons_per_batch)),
          photons(static_cast<std::uint32_t>((s.photons + batches - 1) / batches)),
          pass(on, scene, on_device, photons, photons),
          grids(material, settings) {
        on_device.bodies.upload({BodyRecord{STOKES_BODY_FLAT, 0, STOKES_NONE, 0, 0, {}}});
        // Far below the mean free paths, so that it matters nowhere.
        on_device.offset_mm = static_cast<float>(1e-3 * mean_free_paths(material).shortest_mm);
    }

    std::vector<double> bin_edges(const ProbeGrid& grid) const;
    void add_set(const ProbeSet& set, int set_step_nm, const ProbeResult& result, const Layout& layout,
                 std::size_t sets, std::vector<double>& sums) const;

    Device device;
    ProbeMaterial material;
    ProbeSettings settings;
    Scene scene;
    DeviceScene on_device;
    std::int64_t batches;
    std::uint32_t photons;  // a batch and set
    PhotonPass pass;
    ProbeGrids grids;
};

// From a hundredth of a mean free path to twenty diffusion lengths, but no more than 1000 mean free paths.
std::vector<double> HalfSpaceProbe::Bench::bin_edges(const ProbeGrid& grid) const {
    double first = 0.01, last = 10.0;  // paper: what its tables cover
    if (material.medium && transport_model(settings.transport).reaches_any_distance()) {
        const auto sigma_t = [&](int lambda) {
            return material.medium->sigma_s.at(lambda) + material.medium->sigma_a.at(lambda);
        };
        std::vector<int> leaving_nm{grid.lambda_ex_nm};
        for (const ProbeStep& step : grid.emitting)
            leaving_nm.insert(leaving_nm.end(), step.lambda_nm.begin(), step.lambda_nm.end());
        first = 0.01 / sigma_t(grid.lambda_ex_nm);
        last = 0.0;
        for (const int lambda : leaving_nm) {
            const double decay = diffusion_decay(std::min(material.medium->sigma_s.at(lambda) / sigma_t(lambda), 1.0));
            last = std::max(last, std::min(1000.0, 20.0 / decay) / sigma_t(lambda));
        }
    }
    last = settings.r_max_mm.value_or(last);
    first = std::min(first, 1e-3 * last);
    std::vector<double> edges{0.0};
    for (int i = 0; i < settings.bins; ++i)
        edges.push_back(first * std::pow(last / first, double(i) / double(settings.bins - 1)));
    edges.back() = last;
    return edges;
}

// Adds what the maps hold to a batch's sums. set_step_nm: ProbeGrid::step_nm. Elastic light is in every one of the
// sets, of which it is the mean.
void HalfSpaceProbe::Bench::add_set(const ProbeSet& set, int set_step_nm, const ProbeResult& result,
                                    const Layout& layout, std::size_t sets, std::vector<double>& sums) const {
    constexpr std::array<std::size_t, 3> component_of = {probe_fluorescence, probe_single, probe_multiple};
    const auto ex = static_cast<std::size_t>(
        std::lower_bound(result.lambda_nm.begin(), result.lambda_nm.end(), result.lambda_ex_nm) -
        result.lambda_nm.begin());
    for (std::size_t m = 0; m < component_of.size(); ++m) {
        const std::size_t component = component_of[m];
        const std::vector<PhotonHead> heads = pass.maps()[m].heads().download(pass.maps()[m].used());
        const std::vector<Flux16> flux = pass.maps()[m].flux().download(pass.maps()[m].used());
        for (std::size_t i = 0; i < heads.size(); ++i) {
            if (heads[i].normal == STOKES_EMPTY_SLOT) continue;
            double leaving = 0.0;
            if (component == probe_fluorescence) {
                for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k) {
                    if (set.read[k] < 0) continue;
                    const double part =
                        static_cast<double>(flux[i].v[k]) / set.wavelengths.pair_weight_nm * set_step_nm;
                    sums[layout.at_wavelength(component, static_cast<std::size_t>(set.read[k]))] +=
                        part / settings.step_nm;
                    sums[layout.emitted_photons()] +=
                        part * set.wavelengths.set[k] / static_cast<double>(result.lambda_ex_nm);
                    leaving += part;
                }
            } else {
                leaving = static_cast<double>(flux[i].v[set.excitation]) / static_cast<double>(sets);
                sums[layout.at_wavelength(component, ex)] += leaving;
            }
            const double r_mm = std::hypot(static_cast<double>(heads[i].x), static_cast<double>(heads[i].z));
            const auto above = std::upper_bound(result.r_mm.begin(), result.r_mm.end(), r_mm);
            sums[layout.in_bin(component, static_cast<std::size_t>(above - result.r_mm.begin()) - 1)] += leaving;
            sums[layout.total(component)] += leaving;
        }
    }
}

HalfSpaceProbe::HalfSpaceProbe(const Device& device, const ProbeMaterial& material, const ProbeSettings& settings) {
    check(material, settings);
    bench_ = std::make_unique<Bench>(device, material, settings);
}

HalfSpaceProbe::~HalfSpaceProbe() = default;

const std::vector<int>& HalfSpaceProbe::grid_nm() const { return bench_->grids.read_nm(); }

namespace {

// The sum of a batch's components, and what was reflected where it arrived.
void finish_batch(const Layout& layout, std::size_t wavelengths, std::size_t bins, std::size_t ex, double reflected,
                  std::vector<double>& sums) {
    sums[layout.at_wavelength(probe_specular, ex)] = sums[layout.total(probe_specular)] = reflected;
    for (std::size_t component = 0; component < probe_total; ++component) {
        for (std::size_t i = 0; i < wavelengths; ++i)  // shares at the excitation, values per nm elsewhere
            if (component != probe_fluorescence || i != ex)
                sums[layout.at_wavelength(probe_total, i)] += sums[layout.at_wavelength(component, i)];
        for (std::size_t bin = 0; bin <= bins; ++bin)
            sums[layout.in_bin(probe_total, bin)] += sums[layout.in_bin(component, bin)];
        sums[layout.total(probe_total)] += sums[layout.total(component)];
    }
}

void read_means(const Layout& layout, const BatchMeans& means, ProbeResult& result) {
    const std::size_t bins = result.r_mm.size() - 1;
    for (std::size_t component = 0; component < probe_component_count; ++component) {
        for (std::size_t i = 0; i < result.lambda_nm.size(); ++i)
            result.reflectance[component].push_back(means.at(layout.at_wavelength(component, i)));
        for (std::size_t bin = 0; bin < bins; ++bin) {
            const double inner = result.r_mm[bin], outer = result.r_mm[bin + 1];
            const double area_mm2 = M_PI * (outer - inner) * (outer + inner);
            const Measured share = means.at(layout.in_bin(component, bin));
            result.radial[component].push_back({share.value / area_mm2, share.standard_error / area_mm2});
        }
        result.beyond[component] = means.at(layout.in_bin(component, bins));
        result.totals[component] = means.at(layout.total(component));
    }
    result.emitted_photons = means.at(layout.emitted_photons());
}

}  // namespace

ProbeResult HalfSpaceProbe::measure(int lambda_ex_nm) {
    Bench& b = *bench_;
    if (lambda_ex_nm < first_lambda_nm || lambda_ex_nm > last_lambda_nm)
        throw InputError(fmt::format("probe: expected an excitation wavelength in [{}, {}] nm, got {}", first_lambda_nm,
                                     last_lambda_nm, lambda_ex_nm));
    b.scene.lights[0].flux = line_of(lambda_ex_nm);
    const ProbeGrid grid = b.grids.at(lambda_ex_nm);
    ProbeResult result;
    result.lambda_ex_nm = lambda_ex_nm;
    result.lambda_nm = grid.lambda_nm;
    result.r_mm = b.bin_edges(grid);
    result.photons = b.batches * b.photons;
    result.sets = probe_set_count(grid);
    result.batches = static_cast<std::size_t>(b.batches);

    const std::size_t bins = result.r_mm.size() - 1;
    const Layout layout(grid.lambda_nm.size(), bins);
    BatchMeans means(layout.size());
    const auto ex = static_cast<std::size_t>(
        std::lower_bound(grid.lambda_nm.begin(), grid.lambda_nm.end(), lambda_ex_nm) - grid.lambda_nm.begin());
    double dropped = 0.0, arrived = 0.0;
    std::uint32_t index = 0;
    for (std::int64_t batch = 0; batch < b.batches; ++batch) {
        std::vector<double> sums(layout.size(), 0.0);
        double reflections = 0.0;
        const auto sets = probe_sets(grid, b.settings.seed, static_cast<std::uint32_t>(batch));
        for (const ProbeSet& set : sets) {
            b.pass.prepare(set.wavelengths, index++, b.photons);
            const PhotonAccount account = b.pass.trace();
            reflections += static_cast<double>(account.reflections);
            arrived += account.energy[0];
            dropped += account.energy[4];
            b.add_set(set, grid.step_nm, result, layout, sets.size(), sums);
        }
        finish_batch(layout, grid.lambda_nm.size(), bins, ex,
                     reflections / (static_cast<double>(sets.size()) * b.photons), sums);
        means.add(sums);
    }
    result.dropped = dropped / arrived;
    read_means(layout, means, result);
    return result;
}

}  // namespace stokes
