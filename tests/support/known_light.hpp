// Scenes put together by hand, and what the film says of a radiance that is known.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "host/image/colour.hpp"
#include "host/render/renderer.hpp"
#include "host/render/wavelengths.hpp"
#include "host/scene/mesh/mesh.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/test_scenes.hpp"

namespace stokes {

// A parallel beam of spectral irradiance 1 W m^-2 nm^-1 (times the spectrum) on a plane across it, through a
// disk about the point that it hits first.
inline Light disk_beam(const glm::dvec3& through_mm, const glm::dvec3& direction, double radius_mm,
                       const Spectrum& irradiance) {
    DiskBeam beam;
    beam.direction = glm::normalize(direction);
    beam.position_mm = through_mm - 2.0 * radius_mm * beam.direction;
    beam.half_u_mm = radius_mm * glm::normalize(glm::cross(beam.direction, glm::dvec3(0.1, 0.2, 1.0)));
    beam.half_v_mm = glm::cross(beam.direction, beam.half_u_mm);
    return {"beam", irradiance.scaled(M_PI * radius_mm * radius_mm * 1e-6), beam};
}

// A camera above a point of the plane y = 0 that sees a square of it, edge_mm wide.
inline Camera camera_above(const glm::dvec3& point_mm, double height_mm, double edge_mm) {
    Camera camera;
    camera.position_mm = point_mm + glm::dvec3(0.0, height_mm, 0.0);
    camera.target_mm = point_mm;
    camera.up = {0.0, 0.0, -1.0};
    camera.vertical_fov_deg = 2.0 * std::atan2(0.5 * edge_mm, height_mm) * 180.0 / M_PI;
    return camera;
}

// Of a scene that draws them uniformly.
inline WavelengthSet wavelengths_of(const Scene& scene, std::uint32_t pass) {
    return draw_wavelengths(scene.render.seed, pass, scene.render.lambda_min_nm, scene.render.lambda_max_nm);
}

// XYZ of the film for spectral radiance values [W m^-2 sr^-1 nm^-1] at the wavelengths of a pass: 683.002
// lm/W times N/n times the sum over the set, so that wavelengths add no noise to a comparison.
template <class Radiance>
glm::dvec3 film_xyz(const Scene& scene, const WavelengthSet& set, const Radiance& radiance) {
    const ColourMatching& observer = cie1931();
    glm::dvec3 xyz(0.0);
    for (std::size_t i = 0; i < set.size(); ++i)
        xyz += radiance(i) * glm::dvec3(observer.x.at(set[i]), observer.y.at(set[i]), observer.z.at(set[i]));
    return luminous_efficacy * image_weight_nm(scene.render.lambda_min_nm, scene.render.lambda_max_nm) * xyz;
}

inline glm::dvec3 film_xyz(const Scene& scene, std::uint32_t pass, const Spectrum& radiance) {
    const WavelengthSet set = wavelengths_of(scene, pass);
    return film_xyz(scene, set, [&](std::size_t i) { return radiance.at(set[i]); });
}

// Mean XYZ of a layer over the picture.
inline glm::dvec3 mean_xyz(const FilmImage& image, Layer component) {
    const std::vector<float>& xyz = image.xyz[static_cast<std::size_t>(component)];
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < image.pixels(); ++i) sum += glm::dvec3(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
    return sum / static_cast<double>(image.pixels());
}

// The values of a film that only grows, a pass at a time: image() is the mean of the passes so far.
class PassImages {
  public:
    explicit PassImages(Renderer& renderer) : renderer_(renderer) {}
    // Renders the pass and gives its own picture.
    FilmImage next(std::uint32_t pass) {
        renderer_.render_pass(pass);
        const FilmImage mean = renderer_.image();
        FilmImage own = mean;
        const double n = renderer_.passes();
        for (std::size_t c = 0; c < layer_count; ++c) {
            sums_[c].resize(mean.xyz[c].size(), 0.0);
            for (std::size_t k = 0; k < mean.xyz[c].size(); ++k) {
                const double sum = n * static_cast<double>(mean.xyz[c][k]);
                own.xyz[c][k] = static_cast<float>(sum - sums_[c][k]);
                sums_[c][k] = sum;
            }
        }
        return own;
    }

  private:
    Renderer& renderer_;
    std::array<std::vector<double>, layer_count> sums_;
};

// Student's t with that many degrees of freedom as the normal deviate of the same significance (Wallace
// 1959).
inline double normal_of_t(double t, double freedom) {
    const double z = std::sqrt(freedom * std::log1p(t * t / freedom)) * (8.0 * freedom + 1.0) / (8.0 * freedom + 3.0);
    return std::copysign(z, t);
}

}  // namespace stokes
