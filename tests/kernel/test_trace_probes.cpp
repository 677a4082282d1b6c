// trace_probe against a plain double-precision search over all triangles.
#include <cmath>
#include <limits>
#include <random>

#include "tests/support/catch.hpp"
#include "tests/support/traced_scene.hpp"
#include "tests/support/triangle_meshes.hpp"

using namespace stokes;

TEST_CASE("probes find the nearest surface of their body on their own side") {
    std::vector<Triangle> triangles = sphere_mesh(30, 60, 10.0f, glm::vec3(0.0f), 0);
    append(triangles, sphere_mesh(30, 60, 6.0f, glm::vec3(12.0f, 0.0f, 0.0f), 1));
    append(triangles, box_mesh(glm::vec3(-30.0f, -20.0f, -30.0f), glm::vec3(30.0f, -10.0f, 30.0f), 1));
    Traced scene(triangles);
    std::mt19937 random(23);
    std::vector<Probe> probes;
    for (const Ray& r : random_rays(4000, -14.0f, 14.0f, 24)) {
        const float reach = 0.5f + static_cast<float>(random() % 100) / 10.0f;
        probes.push_back({r.ox, r.oy, r.oz, reach, r.dx, r.dy, r.dz, static_cast<unsigned>(random() % 2)});
    }
    const auto hits = scene.probe(probes);
    int wrong = 0, found = 0, above = 0;
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const Probe& p = probes[i];
        const glm::dvec3 o(p.x, p.y, p.z), n(p.nx, p.ny, p.nz);
        double best = infinity;
        bool too_close = false;  // to an edge or to the reach's end
        for (const Triangle& t : triangles) {
            if (t.body != p.body || glm::dot(glm::cross(e1_of(t), e2_of(t)), n) <= 0.0) continue;
            const double inner = crossing(t, o, -n, 1e-4), outer = crossing(t, o, -n, -1e-4);
            too_close = too_close || std::fabs(std::fabs(outer) - p.reach_mm) < 1e-3 ||
                        (std::isnan(inner) && std::fabs(outer) < p.reach_mm);
            if (std::fabs(inner) < p.reach_mm && std::fabs(inner) < std::fabs(best)) best = inner;
        }
        if (too_close) continue;
        const bool hit = hits[i].triangle != STOKES_NONE;
        found += hit, above += hit && hits[i].t < 0.0f;
        wrong += hit != std::isfinite(best);
        if (hit) wrong += std::fabs(hits[i].t - best) > 1e-3 || triangles.at(hits[i].triangle).body != p.body;
    }
    CHECK(wrong == 0);
    CHECK(found > 500);
    CHECK(above > 100);
}

TEST_CASE("probes on a flat surface, past its end, into its back, and not to be traced", "[tiny]") {
    Traced scene(box_mesh(glm::vec3(-10.0f), glm::vec3(10.0f), 3));
    const auto probe = [](float x, float y, float reach, unsigned body) {
        return Probe{x, y, 0.3f, reach, 0.0f, 1.0f, 0.0f, body};
    };
    const auto hits =
        scene.probe({probe(1.0f, 10.0f, 0.5f, 3), probe(1.0f, 10.0f, 0.0f, 3), probe(10.5f, 10.0f, 5.0f, 3),
                     probe(1.0f, 10.4f, 0.5f, 3), probe(1.0f, 9.6f, 0.5f, 3), probe(1.0f, -10.0f, 5.0f, 3),
                     probe(1.0f, 10.0f, 0.5f, 2), probe(1.0f, 10.0f, -1.0f, 3)});
    CHECK(hits[0].triangle != STOKES_NONE);
    CHECK(hits[0].t == Approx(0.0).margin(1e-5));
    CHECK(hits[1].triangle != STOKES_NONE);
    CHECK(hits[2].triangle == STOKES_NONE);
    CHECK(hits[3].t == Approx(0.4).margin(1e-5));   // the surface lies below
    CHECK(hits[4].t == Approx(-0.4).margin(1e-5));  // above
    CHECK(hits[4].triangle != STOKES_NONE);
    CHECK(hits[5].triangle == STOKES_NONE);  // only the back of the bottom is there
    CHECK(hits[6].triangle == STOKES_NONE);  // another body
    CHECK(hits[7].triangle == STOKES_NONE);
}
