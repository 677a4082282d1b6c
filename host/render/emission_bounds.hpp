// Which part of what a light emits can meet something: photons start there alone.
#pragma once

#include <optional>
#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

// A rectangle across a beam, before all that its light meets.
struct BeamWindow {
    glm::dvec3 centre_mm{0.0}, half_u_mm{0.0}, half_v_mm{0.0};  // along the beam's half-axes
};

// A ball around what a surface's light can meet.
struct TargetBall {
    glm::dvec3 centre_mm{0.0};
    double radius_mm = 0.0;
};

struct EmissionBounds {
    std::optional<BeamWindow> window;
    std::optional<TargetBall> ball;
    // Of what photons carry that start evenly over the whole light, what starts within the bounds; of a beam exactly
    // the window's area over the section's. In (0, 1]; 1 without bounds.
    double part = 1.0;
};

// One for each light. A light has bounds where less than half of what it emits can meet a shape. Lamps are shapes too;
// those that are black do not count, because one lamp far away would make the bounds of all others wide: light that
// meets nothing but them is taken to have left the scene. Nor does the light's own shape where it does not face itself.
std::vector<EmissionBounds> emission_bounds(const Scene& scene);

}  // namespace stokes
