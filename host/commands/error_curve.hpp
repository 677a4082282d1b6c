// How far a render is from a reference, pass by pass.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/image/exr.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

// Rows of passes, seconds, and rmse [cd/m^2] and relative_rmse (image/compare.hpp) of the whole and of each component.
class ErrorCurve {
  public:
    // every: a row after each that many passes; 0: after 1, 2, 4, 8 .. of them. Reads the reference. InputError where
    // it cannot be read, has another size than the film or not all layers of a render, or has pixels that are not
    // finite.
    ErrorCurve(const std::string& reference_file, const std::string& csv_file, int every, const Film& film);

    // Whether there should be a row after this many passes, from 1.
    bool due(std::uint32_t passes) const;
    // Adds a row and writes the file anew, complete or not at all. Where that fails it warns, and the next row or
    // write() tries again. seconds: what the passes took.
    void add(std::uint32_t passes, double seconds, const FilmImage& film);
    // The passes of the last row, 0 without one.
    std::uint32_t last() const { return last_; }
    // Writes the file. RunError when it cannot be written.
    void write() const;

  private:
    std::string csv_file_, text_;
    std::uint32_t every_, last_ = 0;
    RgbLayers reference_;
    std::vector<std::string> layers_;
};

}  // namespace stokes
