#include "host/scene/mesh/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "host/core/overloaded.hpp"
#include "host/scene/mesh/mesh_topology.hpp"

namespace stokes {

namespace {

// Points that stand for a thing when it is asked whether it lies within a body.
constexpr std::size_t most_points = 64;

// Surfaces within this share of the distance lie in one place: some roundings of a coordinate.
constexpr double one_place_share = 0.125;

// Regions of a body that each of its photons is compared with.
constexpr std::size_t most_regions = 24;

bool has_medium(const Scene& scene, const Shape& shape) {
    return medium_of(scene.materials[static_cast<std::size_t>(shape.material)]).has_value();
}

Bounds box_of(const Scene& scene, int body) {
    Bounds box;
    for (const Shape& shape : scene.shapes)
        if (shape.body == body) box.add(mesh_bounds(shape.mesh));
    return box;
}

std::vector<bool> bodies_with_medium(const Scene& scene) {
    std::vector<bool> result(static_cast<std::size_t>(scene.body_count), false);
    for (const Shape& shape : scene.shapes)
        if (has_medium(scene, shape)) result[static_cast<std::size_t>(shape.body)] = true;
    return result;
}

bool is_solid(const Scene& scene, int body) { return body_topology(scene, body).kind == BodyKind::closed; }

// The triangles whose boxes come near the box of another body.
std::vector<BodyTriangle> candidates(const Scene& scene, const std::vector<Bounds>& boxes, double distance_mm) {
    std::vector<BodyTriangle> result;
    std::uint32_t index = 0;
    for (const Shape& shape : scene.shapes) {
        std::vector<const Bounds*> near;
        for (std::size_t b = 0; b < boxes.size(); ++b)
            if (static_cast<int>(b) != shape.body &&
                boxes[b].meets(boxes[static_cast<std::size_t>(shape.body)], distance_mm))
                near.push_back(&boxes[b]);
        for (const glm::uvec3& t : shape.mesh.triangles) {
            BodyTriangle triangle;
            triangle.index = index++;
            if (near.empty()) continue;
            for (int k = 0; k < 3; ++k) {
                triangle.corners[static_cast<std::size_t>(k)] = shape.mesh.positions_mm[t[k]];
                triangle.box.add(triangle.corners[static_cast<std::size_t>(k)]);
            }
            if (std::none_of(near.begin(), near.end(),
                             [&](const Bounds* box) { return box->meets(triangle.box, distance_mm); }))
                continue;
            const glm::dvec3 cross =
                glm::cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
            const double twice_area = glm::length(cross);
            if (!(twice_area > 0.0)) continue;
            triangle.normal = cross / twice_area;
            triangle.body = shape.body;
            result.push_back(triangle);
        }
    }
    return result;
}

std::size_t triangle_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Shape& shape : scene.shapes) count += shape.mesh.triangles.size();
    return count;
}

// The pair with the body that has a medium first, the lower of two such.
Contacts::Pair ordered(int a, int b, const std::vector<bool>& medium) {
    const bool swap = medium[static_cast<std::size_t>(a)] == medium[static_cast<std::size_t>(b)]
                          ? b < a
                          : medium[static_cast<std::size_t>(b)];
    return swap ? Contacts::Pair{b, a} : Contacts::Pair{a, b};
}

// The regions of each body; many become one.
std::vector<std::vector<Bounds>> few_regions(const std::map<Contacts::Pair, Bounds>& regions, std::size_t bodies) {
    std::vector<std::vector<Bounds>> result(bodies);
    for (const auto& [pair, box] : regions) result[static_cast<std::size_t>(pair.first)].push_back(box);
    for (std::vector<Bounds>& boxes : result)
        if (boxes.size() > most_regions) {
            Bounds all;
            for (const Bounds& box : boxes) all.add(box);
            boxes = {all};
        }
    return result;
}

// Solid angle of a triangle over 4 pi, seen from the origin; seen from behind it counts positive (van Oosterom and
// Strackee 1983).
double winding(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double triple = glm::dot(a, glm::cross(b, c));
    if (std::abs(triple) <= 1e-9 * la * lb * lc) return 0.0;  // in its plane
    const double rest = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    return std::atan2(triple, rest) / (2.0 * M_PI);
}

double winding_number(const Scene& scene, int body, const glm::dvec3& at) {
    double sum = 0.0;
    for (const Shape& shape : scene.shapes) {
        if (shape.body != body) continue;
        for (const glm::uvec3& t : shape.mesh.triangles)
            sum += winding(glm::dvec3(shape.mesh.positions_mm[t.x]) - at, glm::dvec3(shape.mesh.positions_mm[t.y]) - at,
                           glm::dvec3(shape.mesh.positions_mm[t.z]) - at);
    }
    return sum;
}

void add_points(const Mesh& mesh, std::vector<glm::dvec3>& points) {
    for (const glm::vec3& p : mesh.positions_mm) points.emplace_back(p);
}

Container container_of(const Scene& scene, const std::vector<glm::dvec3>& points, int self) {
    Container result;
    double smallest = INFINITY;
    const std::vector<bool> medium = bodies_with_medium(scene);
    Bounds all;
    for (const glm::dvec3& p : points) all.add(p);
    for (int body = 0; body < scene.body_count; ++body) {
        if (body == self || !medium[static_cast<std::size_t>(body)]) continue;
        const Bounds box = box_of(scene, body);
        if (!box.meets(all, 0.0) || !is_solid(scene, body)) continue;
        const Within within = within_body(scene, body, points);
        const glm::dvec3 size = box.high_mm - box.low_mm;
        if (within == Within::partly) result.part = body;
        if (within == Within::wholly && size.x * size.y * size.z < smallest) {
            smallest = size.x * size.y * size.z;
            result.whole = body;
        }
    }
    return result;
}

}  // namespace

Contacts find_contacts(const Scene& scene, double distance_mm) {
    const auto bodies = static_cast<std::size_t>(scene.body_count);
    Contacts result;
    result.touches.assign(bodies, false);
    result.solid.assign(bodies, false);
    result.holds.assign(bodies, false);
    result.contested.assign(triangle_count(scene), false);
    const std::vector<bool> medium = bodies_with_medium(scene);
    std::vector<Bounds> boxes;
    for (int body = 0; body < scene.body_count; ++body) boxes.push_back(box_of(scene, body));
    std::vector<BodyTriangle> triangles = candidates(scene, boxes, 2.0 * distance_mm);
    std::set<Contacts::Pair> coincide, cross;
    std::map<Contacts::Pair, Bounds> regions;       // of a body, and the other
    std::map<Contacts::Pair, std::set<int>> sides;  // on which a body stands on a plane of the other
    visit_near_pairs(triangles, 2.0 * distance_mm, [&](const BodyTriangle& a, const BodyTriangle& b) {
        const auto of_a = static_cast<std::size_t>(a.body), of_b = static_cast<std::size_t>(b.body);
        result.touches[of_a] = result.touches[of_b] = true;
        const Bounds common{glm::max(a.box.low_mm, b.box.low_mm) - 2.0 * distance_mm,
                            glm::min(a.box.high_mm, b.box.high_mm) + 2.0 * distance_mm};
        regions[{a.body, b.body}].add(common);
        regions[{b.body, a.body}].add(common);
        if (share_a_plane(a, b, one_place_share * distance_mm)) {
            result.contested[a.index] = result.contested[b.index] = true;
            if (medium[of_a] && medium[of_b] && glm::dot(a.normal, b.normal) > 0.0)
                coincide.insert(ordered(a.body, b.body, medium));
        } else if ((medium[of_a] || medium[of_b]) && cross_each_other(a, b, distance_mm)) {
            cross.insert(ordered(a.body, b.body, medium));
        } else if (medium[of_a] || medium[of_b]) {
            if (const int side = stands_on(a, b, distance_mm)) sides[{a.body, b.body}].insert(side);
            if (const int side = stands_on(b, a, distance_mm)) sides[{b.body, a.body}].insert(side);
        }
    });
    // Cut just along its edges.
    for (const auto& [pair, of_pair] : sides)
        if (of_pair.size() == 2) cross.insert(ordered(pair.first, pair.second, medium));
    result.regions = few_regions(regions, bodies);
    result.coincide.assign(coincide.begin(), coincide.end());
    result.cross.assign(cross.begin(), cross.end());
    for (std::size_t body = 0; body < bodies; ++body) {
        const bool overlaps = std::any_of(boxes.begin(), boxes.end(), [&](const Bounds& box) {
            return &box != &boxes[body] && box.meets(boxes[body], -distance_mm);
        });
        if (result.touches[body] || (overlaps && medium[body]))
            result.solid[body] = is_solid(scene, static_cast<int>(body));
        result.holds[body] = overlaps && medium[body] && result.solid[body];
        result.any_touch |= result.touches[body];
    }
    result.any_contested = std::find(result.contested.begin(), result.contested.end(), true) != result.contested.end();
    return result;
}

Within within_body(const Scene& scene, int body, const std::vector<glm::dvec3>& points) {
    std::size_t in = 0, out = 0;
    const std::size_t step = (points.size() + most_points - 1) / most_points;
    for (std::size_t i = 0; i < points.size(); i += step) {
        const double turns = winding_number(scene, body, points[i]);
        if (turns > 0.75) ++in;
        if (turns < 0.25) ++out;
    }
    return in == 0 ? Within::no : out == 0 ? Within::wholly : Within::partly;
}

Container container_of_body(const Scene& scene, int body) {
    std::vector<glm::dvec3> points;
    for (const Shape& shape : scene.shapes)
        if (shape.body == body) add_points(shape.mesh, points);
    return container_of(scene, points, body);
}

namespace {

// Whether the plane of a beam's section cuts a body where light goes through it.
bool section_cuts(const Scene& scene, const Light& light, int body) {
    const Beam* beam = std::visit(
        Overloaded{[](const SurfaceLight&) -> const Beam* { return nullptr; }, [](const Beam& of) { return &of; }},
        light.kind);
    if (beam == nullptr) return false;
    const bool disk = std::holds_alternative<DiskBeam>(light.kind);
    const glm::dvec3 direction = glm::normalize(beam->direction);
    const double u2 = glm::dot(beam->half_u_mm, beam->half_u_mm), v2 = glm::dot(beam->half_v_mm, beam->half_v_mm);
    const double tolerance = 1e-6 * (std::sqrt(u2) + std::sqrt(v2));
    for (const Shape& shape : scene.shapes) {
        if (shape.body != body) continue;
        for (const glm::uvec3& t : shape.mesh.triangles) {
            double low = INFINITY, high = -INFINITY;
            bool lit = false;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 way = glm::dvec3(shape.mesh.positions_mm[t[k]]) - beam->position_mm;
                const double height = glm::dot(way, direction);
                low = std::min(low, height);
                high = std::max(high, height);
                const double u = glm::dot(way, beam->half_u_mm) / u2, v = glm::dot(way, beam->half_v_mm) / v2;
                lit |= disk ? u * u + v * v < 1.0 : std::max(std::abs(u), std::abs(v)) < 1.0;
            }
            if (lit && low < -tolerance && high > tolerance) return true;
        }
    }
    return false;
}

}  // namespace

Container container_of_light(const Scene& scene, const Light& light) {
    std::vector<glm::dvec3> points;
    int self = -1;
    const auto beam = [&](const Beam& section) {
        for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}})
            points.push_back(section.position_mm + section.half_u_mm * static_cast<double>(u) +
                             section.half_v_mm * static_cast<double>(v));
    };
    std::visit(Overloaded{[&](const SurfaceLight& of) {
                              const Shape& shape = scene.shapes[static_cast<std::size_t>(of.shape)];
                              add_points(shape.mesh, points);
                              self = shape.body;
                          },
                          beam},
               light.kind);
    Container result = container_of(scene, points, self);
    const std::vector<bool> medium = bodies_with_medium(scene);
    for (int body = 0; body < scene.body_count && !result.whole; ++body)
        if (medium[static_cast<std::size_t>(body)] && section_cuts(scene, light, body) && is_solid(scene, body))
            result.part = body;
    return result;
}

Container container_of_camera(const Scene& scene) { return container_of(scene, {scene.camera.position_mm}, -1); }

}  // namespace stokes
