#include "host/render/probe_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "host/core/error.hpp"

namespace stokes {

namespace {

// A square in the plane y = 0, facing up, of squares within squares: where the beam enters the triangles are
// small, and intersections with them as precise.
Mesh sheet(double half_inner_mm, double half_outer_mm) {
    Mesh mesh;
    const auto add_square = [&](double half_mm) {
        for (const auto& [x, z] : {std::pair{-1.0, -1.0}, {-1.0, 1.0}, {1.0, 1.0}, {1.0, -1.0}})
            mesh.positions_mm.emplace_back(x * half_mm, 0.0, z * half_mm);
    };
    add_square(half_inner_mm);
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (double half_mm = half_inner_mm; half_mm < half_outer_mm;) {
        half_mm = std::min(4.0 * half_mm, half_outer_mm);
        const auto inner = static_cast<unsigned>(mesh.positions_mm.size()) - 4, outer = inner + 4;
        add_square(half_mm);
        for (unsigned i = 0; i < 4; ++i) {
            const unsigned next = (i + 1) % 4;
            mesh.triangles.emplace_back(outer + i, outer + next, inner + next);
            mesh.triangles.emplace_back(outer + i, inner + next, inner + i);
        }
    }
    return mesh;
}

}  // namespace

FreePaths mean_free_paths(const ProbeMaterial& material) {
    if (!material.medium) return {};
    FreePaths result{std::numeric_limits<double>::infinity(), 0.0};
    for (int lambda = first_lambda_nm; lambda <= last_lambda_nm; ++lambda) {
        const double mfp_mm = 1.0 / (material.medium->sigma_s.at(lambda) + material.medium->sigma_a.at(lambda));
        result.shortest_mm = std::min(result.shortest_mm, mfp_mm);
        result.longest_mm = std::max(result.longest_mm, mfp_mm);
    }
    return result;
}

Spectrum line_of(int lambda_nm) {
    return {{lambda_nm - 0.5, double(lambda_nm), lambda_nm + 0.5}, {0.0, 1.0, 0.0}, Outside::zero};
}

Scene probe_scene(const ProbeMaterial& source, const ProbeSettings& settings) {
    Scene scene;
    scene.file = source.name;
    scene.render.transport = settings.transport;
    scene.render.first_collision_only = settings.first_collision_only;
    scene.render.seed = settings.seed;
    scene.render.wavelengths = Wavelengths::uniform;  // not drawn: probe_sets() has them
    scene.render.lambda_min_nm = first_lambda_nm;
    scene.render.lambda_max_nm = last_lambda_nm;
    TranslucentMaterial material;
    if (source.medium) {
        scene.media = {*source.medium};
        material.medium = 0;
    }
    for (const ProbeDye& dye : source.dyes) {
        material.dyes.push_back({static_cast<int>(scene.fluorophores.size()), dye.fraction});
        scene.fluorophores.push_back(dye.fluorophore);
    }
    material.fresnel = source.fresnel;
    scene.materials = {{source.name, material}};

    // Light leaves up to a million mean free paths away, the paper's within 10 mm.
    const FreePaths mfp = mean_free_paths(source);
    const double inner_mm = mfp.shortest_mm, outer_mm = std::clamp(1e6 * mfp.longest_mm, 1e3, 1e11);
    Shape shape;
    shape.name = "half-space";
    shape.material = shape.body = 0;
    shape.mesh = sheet(inner_mm, outer_mm);
    for (glm::vec3& p : shape.mesh.positions_mm) p += glm::vec3(0.3 * inner_mm, 0.0, 0.1 * inner_mm);
    scene.shapes = {shape};
    scene.body_count = 1;

    const double angle = settings.angle_deg * M_PI / 180.0;
    DiskBeam beam;
    beam.direction = {std::sin(angle), -std::cos(angle), 0.0};
    beam.position_mm = -0.1 * inner_mm * beam.direction;
    scene.lights = {{"beam", line_of(first_lambda_nm), beam}};
    return scene;
}

ProbeMaterial probe_material(const Scene& scene, const std::string& name) {
    std::string names;
    for (const Material& material : scene.materials) {
        const TranslucentMaterial* translucent = as_translucent(material);
        if (translucent != nullptr) names += (names.empty() ? "" : ", ") + material.name;
        if (material.name != name) continue;
        if (translucent == nullptr)
            throw InputError(
                fmt::format("{}: material \"{}\" is not translucent: nothing enters it", scene.file, name));
        ProbeMaterial result;
        result.name = name;
        if (translucent->medium) result.medium = scene.media[static_cast<std::size_t>(*translucent->medium)];
        for (const Dye& dye : translucent->dyes)
            result.dyes.push_back({scene.fluorophores[static_cast<std::size_t>(dye.fluorophore)], dye.fraction});
        result.fresnel = translucent->fresnel;
        return result;
    }
    throw InputError(
        fmt::format("{}: no material \"{}\"; translucent are: {}", scene.file, name, names.empty() ? "none" : names));
}

}  // namespace stokes
