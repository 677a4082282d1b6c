// The wavelength sets of a virtual spectrofluorometer: a monochromatic beam, and a grid of wavelengths to
// read.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/render/pass_spectra.hpp"

namespace stokes {

// The whole nanometres that one wavelength of the grid stands for and that can fluoresce.
struct ProbeStep {
    int read = -1;                 // index into ProbeGrid::lambda_nm, or -1: not to be read
    std::vector<int> lambda_nm;    // increasing, above the excitation
    std::vector<double> emission;  // of each, above 0: how often it is drawn, in any unit
};

// Which wavelengths [nm] one excitation can bring light to.
struct ProbeGrid {
    int lambda_ex_nm = 0;
    int step_nm = 1;
    std::vector<int> lambda_nm;       // to be read, increasing; lambda_ex_nm among them
    std::vector<ProbeStep> emitting;  // by increasing wavelength
    std::vector<int> spare;           // others, to fill a set with: where several re-radiations follow each other,
                                      // none of them may be reached and then emit at one of emitting. The best first
};

struct ProbeSet {
    PassWavelengths wavelengths;
    std::size_t excitation = 0;  // place of lambda_ex_nm in the set
    // By place in the set: index into ProbeGrid::lambda_nm of a wavelength that this set reads, else -1.
    std::array<int, STOKES_WAVELENGTHS> read;
};

// How many sets a grid takes: fifteen emitting steps each, at least one set.
std::size_t probe_set_count(const ProbeGrid& grid);

// Pair weight [nm] of a beam of one wavelength of which every flux stands for 1 nm: the light that a set
// re-radiates then is all that the grid does, in the mean. Divided by it, a set's flux is per nm.
double probe_pair_weight_nm(const ProbeGrid& grid);

// One batch's sets. Together they read every emitting step once, at one of its nanometres; which one, and which steps
// share a set, is drawn anew for each batch. A nanometre drawn with probability p has the rarity 1/(p step_nm), so that
// its flux is per nm and in the mean that of the step: the sum over its nanometres over step_nm. Light that is
// re-radiated again comes from the set's other wavelengths: with G emitting steps, given k of a path in the set (beside
// lambda_ex), the next is in it with probability (15 - k)/(G - k), so the sum over them weighs step (G - k)/(15 - k),
// or step alone where G <= 15 and all share the one set: pair weight times chain[k]. InputError when lambda_ex, the
// emitting and the spare wavelengths are fewer than sixteen.
std::vector<ProbeSet> probe_sets(const ProbeGrid& grid, std::uint32_t seed, std::uint32_t batch);

}  // namespace stokes
