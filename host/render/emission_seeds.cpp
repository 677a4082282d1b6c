#include "host/render/emission_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "host/render/translucent_bodies.hpp"

namespace stokes {

namespace {

// A body that fewer trial photons would meet is aimed at beforehand.
constexpr double few_photons = 100.0;

// Points of all bodies together when their shares are measured, and of a set when it becomes seeds.
constexpr std::size_t measured_points = 1u << 16, most_points_of_body = 256, seed_points = 4096;

// A region is wider than its samples by a share of their extent, and at least by this; along a coordinate of which it
// would leave out little there is none.
constexpr float region_margin = 0.05f, smallest_region = 0x1p-20f, largest_region = 0.5f;

// A light of few photons still has so much of a set's.
constexpr double least_weight = 0.02;

double uniform(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11) * 0x1p-53; }

struct SeedTriangle {
    glm::dvec3 corner, e1, e2, normal;
    double area_before;
};

}  // namespace

std::vector<SeedPoint> points_of_body(const Scene& scene, int body, std::size_t count) {
    std::vector<SeedTriangle> triangles;
    double area = 0.0;
    for (const Shape& shape : scene.shapes) {
        if (shape.body != body) continue;
        for (const glm::uvec3& t : shape.mesh.triangles) {
            const glm::dvec3 a(shape.mesh.positions_mm[t.x]), e1 = glm::dvec3(shape.mesh.positions_mm[t.y]) - a,
                                                              e2 = glm::dvec3(shape.mesh.positions_mm[t.z]) - a,
                                                              vector = 0.5 * glm::cross(e1, e2);
            if (!(glm::length(vector) > 0.0)) continue;
            triangles.push_back({a, e1, e2, glm::normalize(vector), area});
            area += glm::length(vector);
        }
    }
    std::vector<SeedPoint> points;
    if (triangles.empty()) return points;
    std::mt19937_64 generator(static_cast<std::uint64_t>(body) + 1);
    for (std::size_t i = 0; i < count; ++i) {
        const double at = (static_cast<double>(i) + uniform(generator)) / static_cast<double>(count) * area;
        const auto next = std::upper_bound(triangles.begin(), triangles.end(), at,
                                           [](double value, const SeedTriangle& t) { return value < t.area_before; });
        const SeedTriangle& t = *(next - 1);
        const double root = std::sqrt(uniform(generator)), v = uniform(generator);
        const glm::vec3 p(t.corner + t.e1 * (root * (1.0 - v)) + t.e2 * (root * v)), n(t.normal);
        points.push_back({{p.x, p.y, p.z, n.x, n.y, n.z}, area / static_cast<double>(count)});
    }
    return points;
}

std::vector<SeedPoint> visible_points(const CameraRecord& camera, const std::vector<GatherPoint>& points) {
    const glm::dvec3 eye(camera.position_x, camera.position_y, camera.position_z);
    const glm::dvec3 right(camera.right_x, camera.right_y, camera.right_z);
    const glm::dvec3 down(camera.down_x, camera.down_y, camera.down_z);
    const glm::dvec3 axis = glm::normalize(glm::cross(right, down));
    const double pixel_area = glm::length(right) * glm::length(down);  // at distance 1 along the axis
    const std::size_t step = std::max<std::size_t>(points.size() / seed_points, 1);
    std::vector<SeedPoint> visible;
    for (std::size_t i = 0; i < points.size(); i += step) {
        const GatherPoint& p = points[i];
        if (p.reflected != 0 || p.maps == 0) continue;
        const glm::dvec3 to(p.x - eye.x, p.y - eye.y, p.z - eye.z);
        const double depth = glm::dot(to, axis), facing = std::abs(glm::dot(to, glm::dvec3(p.nx, p.ny, p.nz)));
        const double area = pixel_area * depth * depth * depth / std::max(facing, 1e-3 * depth);
        if (area > 0.0) visible.push_back({{p.x, p.y, p.z, p.nx, p.ny, p.nz}, area * static_cast<double>(step)});
    }
    return visible;
}

EmissionSeeds::EmissionSeeds(const Device& device, const Scene& scene, const DeviceScene& on_device)
    : device_(device),
      scene_(scene),
      on_device_(on_device),
      find_places_(Program(device, "emit_photons.cl").kernel("find_emission_places")) {}

EmissionSeeds::Found EmissionSeeds::find(std::uint32_t light, const std::vector<SeedPoint>& points) const {
    struct alignas(8) OnLight {
        float at[2];
    };
    std::vector<EmissionTarget> targets;
    std::vector<OnLight> on_light;
    std::mt19937_64 generator(light + 1);
    for (const SeedPoint& point : points) {
        targets.push_back(point.at);
        const double u = uniform(generator), v = uniform(generator);
        on_light.push_back({{static_cast<float>(u), static_cast<float>(v)}});
    }
    const auto count = static_cast<std::uint32_t>(points.size());
    const Buffer<Place> places(device_, "places of emission seeds", count);
    const Buffer<float> densities(device_, "densities of emission seeds", count);
    find_places_.launch(count, on_device_.arguments(),
                        Arguments("count", count)
                            .add("light", light)
                            .add("targets", Buffer<EmissionTarget>(device_, "targets of emission", targets))
                            .add("places_on_light", Buffer<OnLight>(device_, "places on lights", on_light), "float2")
                            .add("places", places, "float4")
                            .add("densities", densities));
    return {places.download(), densities.download()};
}

double EmissionSeeds::share(const std::vector<SeedPoint>& points) const {
    double share = 0.0;
    for (std::uint32_t light = 0; light < on_device_.light_count && !points.empty(); ++light) {
        const double probability = on_device_.light_probability[light];
        if (!(probability > 0.0)) continue;
        const std::vector<float> densities = find(light, points).densities;
        for (std::size_t i = 0; i < points.size(); ++i)
            share += probability * static_cast<double>(densities[i]) * points[i].area_mm2;
    }
    return share;
}

// Photons start in proportion to the root of what a part holds times its square (EmissionCells::aimed), so that a point
// that stands for a volume v of the cube has the square w^2/v.
void EmissionSeeds::add(const std::vector<SeedPoint>& points) {
    for (std::uint32_t light = 0; light < on_device_.light_count && !points.empty(); ++light) {
        const double probability = on_device_.light_probability[light];
        if (!(probability > 0.0)) continue;
        const Found found = find(light, points);
        const double weight = std::max(probability, least_weight) / static_cast<double>(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double volume = probability * static_cast<double>(found.densities[i]) * points[i].area_mm2;
            if (!(volume > 0.0)) continue;
            EmissionSample sample;
            sample.light = light;
            std::copy(std::begin(found.places[i].at), std::end(found.places[i].at), sample.place.begin());
            sample.square = weight * weight / volume;
            samples_.push_back(sample);
        }
    }
}

void EmissionSeeds::set_regions(std::vector<EmittingLight>& lights) const {
    for (std::uint32_t l = 0; l < lights.size(); ++l)
        for (std::size_t d = 0; d < lights[l].dimensions; ++d) {
            std::vector<float> places;
            for (const EmissionSample& sample : samples_)
                if (sample.light == l) places.push_back(sample.place[d]);
            if (places.empty()) continue;
            const auto [least, most] = std::minmax_element(places.begin(), places.end());
            const float wider = region_margin * (*most - *least) + smallest_region;
            const float low = *least - wider, high = *most + wider;
            if (high - low > largest_region) continue;
            lights[l].region_low[d] = std::max(low, 0.0f);
            lights[l].region_high[d] = std::min(high, 1.0f);
        }
}

std::vector<std::vector<SeedPoint>> rare_bodies(const Scene& scene, const EmissionSeeds& seeds, double photons) {
    const std::vector<int> bodies = translucent_bodies(scene);
    std::vector<std::vector<SeedPoint>> rare;
    if (bodies.empty()) return rare;
    const std::size_t count = std::clamp<std::size_t>(measured_points / bodies.size(), 4, most_points_of_body);
    std::vector<int> found;
    for (const int body : bodies)
        if (seeds.share(points_of_body(scene, body, count)) * photons < few_photons) found.push_back(body);
    for (const int body : found)
        rare.push_back(points_of_body(scene, body, std::max(seed_points / found.size(), count)));
    return rare;
}

}  // namespace stokes
