// Where photons start: a partition of all places and directions of the lights, by how many photons start in each part.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/shared/light.h"

namespace stokes {

// A photon of a trial pass: where it started and what it brought.
struct EmissionSample {
    std::uint32_t light = 0;
    std::array<float, 4> place{};  // in the light's cube, as lib/lights.clh has it
    // Square of its value in the picture, had it the flux of random emission, times how many photons of random emission
    // it stands for, over their number in all trials: the sum over a part's samples estimates the part's share of the
    // mean square.
    double square = 0.0;
};

// One of the lights, as far as emission is concerned.
struct EmittingLight {
    double probability = 0.0;  // of a photon of random emission to be its own; together 1
    unsigned dimensions = 2;   // coordinates of its places, up to 4
    // A part of its cube that cells are cut out for before all else: small, and most of what matters lies in it.
    std::array<float, 4> region_low{0.0f, 0.0f, 0.0f, 0.0f}, region_high{1.0f, 1.0f, 1.0f, 1.0f};
};

class EmissionCells {
  public:
    EmissionCells() = default;

    // For passes of this many photons, a cell a light: evenly spread. Lights of probability 0 have none. No cells at
    // all, which stands for random emission, where there are less than three photons a cell.
    static EmissionCells stratified(const std::vector<EmittingLight>& lights, std::uint32_t photons);

    // Cells that are small where the samples' squares differ, with photons in proportion to the root of each cell's
    // mean square, which makes the variance of the picture least; but an uniform_share of the photons as stratified()
    // spreads them, so that hardly a photon weighs more than 1/uniform_share, and one and a half photons to each cell.
    // At most most_cells, or stratified() where no sample has a value.
    static EmissionCells aimed(const std::vector<EmittingLight>& lights, const std::vector<EmissionSample>& samples,
                               double uniform_share, std::size_t most_cells, std::uint32_t photons);

    // The same from seeds, which are all that there is: a part without any has photons for its size alone.
    static EmissionCells seeded(const std::vector<EmittingLight>& lights, const std::vector<EmissionSample>& seeds,
                                double uniform_share, std::size_t most_cells, std::uint32_t photons);

    const std::vector<EmissionCell>& records() const { return records_; }
    // Share of the photons, in the order of records; their sum is 1.
    const std::vector<double>& shares() const { return shares_; }

    // Photons first[c] to first[c + 1] - 1 of the pass start in cell c, at least one; first[0] = 0, the last is the
    // photons of a pass. Each cell has the integer below or above its share of them, in the mean over seeds the share
    // exactly.
    std::vector<std::uint32_t> first_photons(std::uint32_t seed, std::uint32_t pass) const;

  private:
    struct Box;
    class Partition;
    static EmissionCells of_boxes(std::vector<Box> boxes, double uniform_share, std::uint32_t photons);
    static EmissionCell record_of(const Box& box, double photons);

    std::uint32_t photons_ = 0;
    std::vector<EmissionCell> records_;
    std::vector<double> shares_;
};

}  // namespace stokes
