#include "tests/bench/stages.hpp"

#include <vector>

namespace stokes::bench {

namespace {

const std::vector<std::pair<std::string, std::vector<std::string>>> groups = {
    {"tracing",
     {"emit_photons", "emit_stratified", "trace_closest", "trace_photons", "settle_hits", "trace_probe",
      "classify_photons", "camera_rays", "trace_closest_all", "trace_packets", "trace_reflections"}},
    {"depositing",
     {"scatter_diffuse", "sample_exits", "place_exits", "deposit_exits", "retrace_fluorescence", "retrace_elastic",
      "retrace_exits", "fold_exits", "draw_exits", "integrate_power", "walk_photons"}},
    {"gathering", {"collect_points", "add_direct_light", "choose_radii", "measure_disks", "gather_radiance"}},
    {"sorting",
     {"find_keys", "count_buckets", "scan_chunks", "scan_buckets", "scatter_slots", "sort_buckets", "permute_photons"}},
    {"lists", {"count_lists", "scan_lists", "write_lists"}},
    {"ledger", {"sum_ledgers"}},
};

}  // namespace

// What a pass makes before its photons start is all that is left.
std::string group_of(const std::string& kernel) {
    for (const auto& [group, kernels] : groups)
        for (const std::string& name : kernels)
            if (name == kernel) return group;
    return "tables";
}

bool is_overhead(const std::string& group) {
    return group != "tracing" && group != "depositing" && group != "gathering";
}

bool is_subsurface(const std::string& kernel) {
    return group_of(kernel) == "depositing" && kernel != "scatter_diffuse";
}

Json stages_json(const std::map<std::string, StageTime>& stages, double runs) {
    std::map<std::string, double> sums;
    Json kernels = Json::object();
    for (const auto& [kernel, time] : stages) {
        kernels[kernel] = time.seconds / runs;
        sums[group_of(kernel)] += time.seconds / runs;
    }
    return {{"groups", sums}, {"kernels", kernels}};
}

}  // namespace stokes::bench
