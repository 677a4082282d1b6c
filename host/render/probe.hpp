// A virtual spectrofluorometer: a narrow monochromatic beam falls on a half-space of a material, and what
// leaves is read by wavelength and by distance from where the beam enters. The light is the render's own:
// DeviceScene and PhotonPass, whose maps are read in place of being looked at.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/device/device.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

struct ProbeDye {
    Fluorophore fluorophore;
    double fraction = 0.0;  // in [0, 1], of all dyes together at most 1
};

struct ProbeMaterial {
    std::string name;
    std::optional<Medium> medium;  // none: surface fluorescence
    std::vector<ProbeDye> dyes;    // one at least where there is no medium
    bool fresnel = false;          // conserving, walk
};

// A scene's translucent material. InputError when there is none of that name, or it is not translucent.
ProbeMaterial probe_material(const Scene& scene, const std::string& name);

struct ProbeSettings {
    Transport transport = Transport::conserving;
    bool first_collision_only = false;  // walk: fluorophores take light up at its first collision only
    double angle_deg = 0.0;             // of incidence, in [0, 89.9]
    std::int64_t photons = 1000000;     // for each set of sixteen wavelengths, in [least_probe_photons, 1e12]
    std::uint32_t seed = 1;
    int lambda_min_nm = 300, lambda_max_nm = 780;  // in [first_lambda_nm, last_lambda_nm]
    int step_nm = 5;                               // in [1, 50]
    int bins = 40;                                 // of distance, in [2, 10000]
    std::optional<double> r_max_mm;                // end of the last of them, in [1e-9, 1e12]; none: from the material
};

inline constexpr std::int64_t least_probe_photons = 64;

// What leaves, as ProbeResult's arrays have it. specular: reflected where it arrives; total: all the others
// together.
enum ProbeComponent : std::size_t { probe_specular, probe_single, probe_multiple, probe_fluorescence, probe_total };
inline constexpr std::size_t probe_component_count = 5;

struct Measured {
    double value = 0.0, standard_error = 0.0;
};

// Light that leaves, per light that arrives in the beam, both in energy.
struct ProbeResult {
    int lambda_ex_nm = 0;
    // lambda_min_nm + n step_nm up to lambda_max_nm, and lambda_ex_nm, increasing.
    std::vector<int> lambda_nm;
    // [component][lambda]: at lambda_ex_nm the share that leaves. Fluorescence per nm [1/nm]: what leaves at the whole
    // nanometres above lambda_ex_nm that are nearest to lambda, over step_nm; in the total but at lambda_ex_nm.
    std::array<std::vector<Measured>, probe_component_count> reflectance;
    // Shares of the energy; fluorescence: step_nm times the sum over lambda_nm.
    std::array<Measured, probe_component_count> totals;
    Measured emitted_photons;  // fluorescence in photons that leave per photon that arrives
    // Distances from where the beam enters: edges of the bins, the first 0, the others evenly spaced in the
    // logarithm.
    std::vector<double> r_mm;
    // [component][bin]: totals by where it leaves, exitance [1/mm^2]. Nothing of it is specular.
    std::array<std::vector<Measured>, probe_component_count> radial;
    std::array<Measured, probe_component_count> beyond;  // share of the energy that leaves beyond the last edge
    std::int64_t photons = 0;  // simulated for each set: those asked for, rounded up to whole batches
    std::size_t sets = 0;      // of sixteen wavelengths
    std::size_t batches = 0;   // of which the standard errors are those of the means
    double dropped = 0.0;      // share of the energy that was cut off: missed exits, full maps, limits
};

// A material set up for measurements at several excitation wavelengths.
class HalfSpaceProbe {
  public:
    // Uploads and compiles. InputError for settings out of range, or a material that the transport cannot do.
    HalfSpaceProbe(const Device& device, const ProbeMaterial& material, const ProbeSettings& settings);
    ~HalfSpaceProbe();

    // The grid lambda_min_nm + n step_nm.
    const std::vector<int>& grid_nm() const;

    // A measurement with light of lambda_ex_nm, in [first_lambda_nm, last_lambda_nm]; depends on material, settings and
    // lambda_ex_nm alone. InputError when there are too few wavelengths for sets of sixteen (probe_sets).
    ProbeResult measure(int lambda_ex_nm);

  private:
    struct Bench;
    std::unique_ptr<Bench> bench_;
};

}  // namespace stokes
