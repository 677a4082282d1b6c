#include "host/render/emission_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/core/overloaded.hpp"
#include "host/scene/mesh/mesh.hpp"

namespace stokes {

namespace {

// Above this part of a light's emission, bounds gain less than they cost.
constexpr double most_part = 0.5;

// The window is this much wider than what it covers, and starts this far before it, in its own sizes: more than the
// rounding of coordinates.
constexpr double margin = 1e-3;

// A light with bounds has at least this share of the photons of its power within them, so that all of a light is
// sampled though hardly any of it shines that way.
constexpr double least_part = 0.05;

constexpr double infinite = std::numeric_limits<double>::infinity();

// Its light ends nowhere else, but it is no target.
bool is_black_lamp(const Scene& scene, const Shape& shape) {
    const auto material = static_cast<std::size_t>(shape.material);
    return shape.light >= 0 && std::holds_alternative<BlackMaterial>(scene.materials[material].kind);
}

// Some of its fronts see some of its corners.
bool faces_itself(const Mesh& mesh) {
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 corner(mesh.positions_mm[t.x]), normal = area_vector_mm2(mesh, t);
        const double edge = std::sqrt(glm::length(normal));
        for (const glm::vec3& p : mesh.positions_mm)
            if (glm::dot(glm::dvec3(p) - corner, normal) > 1e-4 * edge * edge * edge) return true;
    }
    return false;
}

bool is_target(const Scene& scene, std::size_t shape, int own_shape) {
    if (is_black_lamp(scene, scene.shapes[shape])) return false;
    return static_cast<int>(shape) != own_shape || faces_itself(scene.shapes[shape].mesh);
}

struct Interval {
    double low = infinite, high = -infinite;
    void add(double value) { low = std::min(low, value), high = std::max(high, value); }
    double middle() const { return 0.5 * (low + high); }
    double half() const { return 0.5 * (high - low); }
};

// Where along and across the beam the shapes lie [mm], from the middle of the section.
struct BeamView {
    Interval across_u, across_v;  // of targets that reach beyond the section's plane
    double first = infinite;      // where the beam may meet the first of all shapes
};

BeamView view_along(const Scene& scene, const Beam& beam) {
    const glm::dvec3 d = glm::normalize(beam.direction), u = glm::normalize(beam.half_u_mm),
                     v = glm::normalize(beam.half_v_mm);
    BeamView view;
    for (std::size_t s = 0; s < scene.shapes.size(); ++s) {
        Interval along, across_u, across_v;
        for (const glm::vec3& p : scene.shapes[s].mesh.positions_mm) {
            const glm::dvec3 way = glm::dvec3(p) - beam.position_mm;
            along.add(glm::dot(way, d));
            across_u.add(glm::dot(way, u));
            across_v.add(glm::dot(way, v));
        }
        if (!(along.high >= 0.0)) continue;
        view.first = std::min(view.first, std::max(along.low, 0.0));
        if (!is_target(scene, s, -1)) continue;
        view.across_u.add(across_u.low), view.across_u.add(across_u.high);
        view.across_v.add(across_v.low), view.across_v.add(across_v.high);
    }
    return view;
}

// A little wider, but no wider than the section.
Interval clipped(Interval across, double most) {
    const double wider = margin * across.half();
    return {std::max(across.low - wider, -most), std::min(across.high + wider, most)};
}

EmissionBounds beam_bounds(const Scene& scene, const Beam& beam, double section_mm2) {
    const BeamView view = view_along(scene, beam);
    const double most_u = glm::length(beam.half_u_mm), most_v = glm::length(beam.half_v_mm);
    const Interval u = clipped(view.across_u, most_u), v = clipped(view.across_v, most_v);
    if (!(u.half() > 0.0 && v.half() > 0.0)) return {};  // the beam meets nothing
    const double part = 4.0 * u.half() * v.half() / section_mm2;
    if (!(part < most_part)) return {};
    const double before = std::max(view.first - margin * std::max(u.half(), v.half()), 0.0);
    const glm::dvec3 to_u = beam.half_u_mm / most_u, to_v = beam.half_v_mm / most_v;
    BeamWindow window;
    window.centre_mm =
        beam.position_mm + before * glm::normalize(beam.direction) + u.middle() * to_u + v.middle() * to_v;
    window.half_u_mm = u.half() * to_u;
    window.half_v_mm = v.half() * to_v;
    EmissionBounds bounds;
    bounds.window = window;
    bounds.part = part;
    return bounds;
}

// bounds: of each shape, so that many lamps do not go through all vertices.
TargetBall ball_around(const Scene& scene, const std::vector<Bounds>& bounds, int own_shape) {
    glm::dvec3 low(infinite), high(-infinite);
    for (std::size_t s = 0; s < scene.shapes.size(); ++s) {
        if (!is_target(scene, s, own_shape)) continue;
        low = glm::min(low, bounds[s].low_mm), high = glm::max(high, bounds[s].high_mm);
    }
    if (!(low.x <= high.x)) return {};
    return {0.5 * (low + high), (1.0 + margin) * 0.5 * glm::distance(low, high)};
}

// Places on a triangle at which its cone is judged, of equal areas: the middles of 16 parts, by rows.
constexpr int rows = 4;

// What a place of a light emits towards the ball, over all that it emits, as emission_cone() of kernels/lib/lights.clh
// has it; cosine: of the ball's direction.
double part_at(const TargetBall& ball, const glm::dvec3& place, const glm::dvec3& normal, bool with_cosine) {
    const glm::dvec3 way = ball.centre_mm - place;
    const double squared = glm::dot(way, way), sine = ball.radius_mm * ball.radius_mm / squared;
    if (!(sine < 0.25)) return 1.0;
    const double height = sine / (1.0 + std::sqrt(1.0 - sine));
    return 2.0 * height * (with_cosine ? std::max(glm::dot(way, normal) / std::sqrt(squared), 0.0) : 1.0);
}

double mean_part(const TargetBall& ball, const Mesh& mesh, bool with_cosine) {
    double sum = 0.0, area = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions_mm[t.x]), b(mesh.positions_mm[t.y]), c(mesh.positions_mm[t.z]);
        const glm::dvec3 vector = area_vector_mm2(a, b, c);
        const double own = glm::length(vector);
        if (!(own > 0.0)) continue;
        double part = 0.0;
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < 2 * (rows - i) - 1; ++j) {  // of a row, upright ones and those between them
                const double third = j % 2 == 0 ? 1.0 / 3.0 : 2.0 / 3.0;
                const double u = (i + third) / rows, v = (j / 2 + third) / rows;
                part += part_at(ball, a + (b - a) * u + (c - a) * v, vector / own, with_cosine);
            }
        sum += own * part / (rows * rows);
        area += own;
    }
    return area > 0.0 ? sum / area : 1.0;
}

EmissionBounds surface_bounds(const Scene& scene, const std::vector<Bounds>& of_shapes, const SurfaceLight& light) {
    const TargetBall ball = ball_around(scene, of_shapes, light.shape);
    if (!(ball.radius_mm > 0.0)) return {};
    const Mesh& mesh = scene.shapes[static_cast<std::size_t>(light.shape)].mesh;
    const double part = mean_part(ball, mesh, false);
    if (!(part < most_part)) return {};
    EmissionBounds bounds;
    bounds.ball = ball;
    bounds.part = std::max(mean_part(ball, mesh, true), least_part * part);
    return bounds;
}

}  // namespace

std::vector<EmissionBounds> emission_bounds(const Scene& scene) {
    std::vector<EmissionBounds> bounds;
    std::vector<Bounds> of_shapes;
    for (const Shape& shape : scene.shapes) of_shapes.push_back(mesh_bounds(shape.mesh));
    const auto area = [](const Beam& beam) { return glm::length(beam.half_u_mm) * glm::length(beam.half_v_mm); };
    for (const Light& light : scene.lights)
        bounds.push_back(std::visit(
            Overloaded{[&](const SurfaceLight& of) { return surface_bounds(scene, of_shapes, of); },
                       [&](const DiskBeam& beam) { return beam_bounds(scene, beam, M_PI * area(beam)); },
                       [&](const RectangleBeam& beam) { return beam_bounds(scene, beam, 4.0 * area(beam)); }},
            light.kind));
    return bounds;
}

}  // namespace stokes
