// Kernels by what they are for.
#pragma once

#include <map>
#include <string>

#include "tests/bench/bench.hpp"

namespace stokes::bench {

// tracing: photons and camera rays are made, follow their way and are told what they meet.
// depositing: events at and below surfaces, which store photons and draw the next direction.
// gathering: from the points that the camera sees to the film.
// sorting: the spatial hash. lists: which photons go where. tables: spectra and tables of the pass. ledger: its
// account. The last four, and all time that no kernel runs, are what a pass costs beside its work: its overhead.
std::string group_of(const std::string& kernel);

bool is_overhead(const std::string& group);

// Kernels that put light below a surface and let it out again; trace_probe, which finds the exit points, not among
// them.
bool is_subsurface(const std::string& kernel);

// Seconds by group and by kernel, each divided by runs, in JSON: {"groups": {}, "kernels": {}}.
Json stages_json(const std::map<std::string, StageTime>& stages, double runs);

}  // namespace stokes::bench
