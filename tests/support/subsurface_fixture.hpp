// Translucent materials with made-up power tables, the photons that arrive at them, and double-precision
// twins.
#pragma once

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "kernels/shared/material.h"
#include "kernels/shared/power_table.h"
#include "tests/support/normals.hpp"
#include "tests/support/photon_fixture.hpp"

namespace stokes {

// An exit of a path, 2 mm along its normal, that keeps that light; nothing of its event beside it.
inline ExitPoint exit_at(const glm::dvec3& normal, std::uint32_t path, const LightSum& kept, bool found,
                         std::uint32_t material = 0) {
    ExitPoint exit{};
    const glm::vec3 n(normal), p = 2.0f * n;
    exit.x = p.x, exit.y = p.y, exit.z = p.z;
    exit.nx = n.x, exit.ny = n.y, exit.nz = n.z;
    exit.r_mm = 1.5f, exit.row = 20.0f, exit.way_mm = 0.7f;  // nothing that follows depends on them
    exit.path = path;
    exit.material = material;
    exit.scale = 1.0f;
    exit.kept = kept;
    exit.found = found ? 1 : 0;
    return exit;
}

// Two media of three tables. Each component has distances of its own, 0.. for fluorescence, 10.. for single
// and 20.. for multiple scattering, so that a distance tells which table it came from; multiple scattering
// has a single row.
struct MadeUpTables {
    std::vector<TableShape> shapes;
    std::vector<Flux16> at_wavelengths;
    std::vector<float> mean_rows, cumulative_rows;
    std::uint32_t drawn_rows = 0;  // where other densities of the same shapes start, to draw distances from

    MadeUpTables() {
        std::mt19937 generator(101);
        std::uniform_real_distribution<float> uniform(0.2f, 1.0f);
        for (unsigned table = 0; table < 6; ++table) {
            const unsigned component = table % 3;
            TableShape shape{};
            shape.offset = unsigned(mean_rows.size());
            shape.row_count = component == STOKES_MAP_MULTIPLE ? 1 : 4 - component + table / 3;
            shape.row_step = 90.0f / float(shape.row_count);
            shape.r_count = 5 + table;
            shape.r_first = 10.0f * float(component);
            shape.r_step = 0.25f;
            shapes.push_back(shape);
            for (unsigned row = 0; row < shape.row_count; ++row)
                for (unsigned r = 0; r < shape.r_count; ++r) {
                    at_wavelengths.push_back(random_flux(generator, 0.05, component == 0 ? 1.6 : 0.6));
                    add_density(uniform(generator), r, shape.r_step);
                }
        }
        drawn_rows = std::uint32_t(mean_rows.size());
        for (const TableShape& shape : shapes)
            for (unsigned i = 0; i < shape.row_count * shape.r_count; ++i)
                add_density(uniform(generator), i % shape.r_count, shape.r_step);
    }

    // The density with which a distance is drawn at that row [1/mm], from the densities that start at first.
    double density(unsigned table, double row_deg, double r_mm, std::uint32_t first) const {
        const TableShape& shape = shapes[table];
        const auto at = [](double value, double begin, double step, unsigned count) {
            return std::clamp((value - begin) / step, 0.0, double(count - 1));
        };
        const double row = at(row_deg, double(shape.row_first), double(shape.row_step), shape.row_count),
                     r = at(r_mm, double(shape.r_first), double(shape.r_step), shape.r_count);
        double value = 0.0, total = 0.0;
        for (unsigned i = 0; i < shape.row_count; ++i) {
            const double share = std::max(0.0, 1.0 - std::abs(row - i));
            const std::size_t start = first + shape.offset + i * shape.r_count;
            for (unsigned k = 0; k < shape.r_count; ++k)
                value += share * std::max(0.0, 1.0 - std::abs(r - k)) * double(mean_rows[start + k]);
            total += share * double(cumulative_rows[start + shape.r_count - 1]);
        }
        return value / total;
    }

  private:
    void add_density(float density, unsigned r, float step) {
        cumulative_rows.push_back(r == 0 ? 0.0f : cumulative_rows.back() + 0.5f * (mean_rows.back() + density) * step);
        mean_rows.push_back(density);
    }

  public:
    // Bilinear in row and distance, held beyond the ends.
    std::array<double, 16> look_up(unsigned medium, unsigned component, double r_mm, double row_deg) const {
        const TableShape& shape = shapes[medium * 3 + component];
        const auto place = [](double value, double first, double step, unsigned count, unsigned& lower) {
            const double at = std::clamp((value - first) / step, 0.0, double(count - 1));
            lower = std::min(unsigned(at), count - 1);
            return at - lower;
        };
        unsigned row = 0, r = 0;
        const double row_share = place(row_deg, double(shape.row_first), double(shape.row_step), shape.row_count, row);
        const double r_share = place(r_mm, double(shape.r_first), double(shape.r_step), shape.r_count, r);
        std::array<double, 16> result{};
        for (unsigned i = 0; i < 2; ++i)
            for (unsigned j = 0; j < 2; ++j) {
                const unsigned a = std::min(row + i, shape.row_count - 1), b = std::min(r + j, shape.r_count - 1);
                const double share = (i == 1 ? row_share : 1.0 - row_share) * (j == 1 ? r_share : 1.0 - r_share);
                for (std::size_t k = 0; k < 16; ++k)
                    result[k] += share * double(at_wavelengths[shape.offset + a * shape.r_count + b].v[k]);
            }
        return result;
    }
};

// Materials 0 and 1 have subsurface scattering in media 1 and 0, material 2 has surface fluorescence.
inline std::vector<MaterialRecord> translucent_materials() {
    constexpr std::uint32_t below = STOKES_MATERIAL_SUBSURFACE | STOKES_MATERIAL_FLUORESCENT;
    std::vector<MaterialRecord> materials = {translucent_record(below, 0.5f, 1.5f), translucent_record(below, 0.3f),
                                             translucent_record(STOKES_MATERIAL_FLUORESCENT, 1.0f)};
    materials[0].medium = 1;
    for (std::uint32_t i = 0; i < 3; ++i) {
        materials[i].excitation_row = i == 1 ? 20 : 3;
        materials[i].reradiation_row = materials[i].excitation_row + 1;
    }
    return materials;
}

// Three rows of reflectance, then excitation and re-radiation of two fluorophores; emission only above the
// excitation.
inline std::vector<Flux16> translucent_spectra() {
    std::mt19937 generator(102);
    std::vector<Flux16> rows(3, constant_flux(0.0f));
    for (int fluorophore = 0; fluorophore < 2; ++fluorophore) {
        rows.push_back(random_flux(generator, 0.3, 1.0));
        for (int ex = 0; ex < 16; ++ex) {
            rows.push_back(random_flux(generator, 0.0, 0.15));
            for (int em = 0; em <= ex; ++em) rows.back().v[em] = 0.0f;
        }
    }
    return rows;
}

inline bool has(const MaterialRecord& material, std::uint32_t flag) { return (material.flags & flag) != 0; }

// Sum over excitation wavelengths of flux there times the row of what it becomes (eq. 1-2).
inline std::array<double, 16> reradiated(const MaterialRecord& material, const std::vector<Flux16>& spectra,
                                         const Flux16& flux) {
    std::array<double, 16> result{};
    for (std::size_t ex = 0; ex < 16; ++ex)
        for (std::size_t em = 0; em < 16; ++em)
            result[em] += double(flux.v[ex]) * double(spectra[material.reradiation_row + ex].v[em]);
    return result;
}

// Photons at surfaces of those materials, from all directions above them.
struct SubsurfaceArrivals {
    std::vector<SurfacePoint> points;
    std::vector<Ray> rays;
    std::vector<Flux16> flux;
    std::vector<PathLedger> ledgers;
    std::vector<std::uint32_t> fluorescence, elastic;  // lists

    // Path i is at material i % 3; those at material 2, and every second other, fluoresce.
    explicit SubsurfaceArrivals(std::uint32_t paths) {
        std::mt19937 generator(paths);
        for (std::uint32_t i = 0; i < paths; ++i) {
            const glm::dvec3 p = 3.0 * random_direction(generator), n = random_direction(generator);
            glm::dvec3 d = random_direction(generator);
            if (glm::dot(d, n) > 0.0) d = -d;
            const glm::vec3 at(p), normal(n), direction(d);
            points.push_back({at.x, at.y, at.z, i % 3, normal.x, normal.y, normal.z, i % 7});
            rays.push_back({0, 0, 0, 0, direction.x, direction.y, direction.z, 1e30f});
            flux.push_back(random_flux(generator, 0.1, 2.0));
            ledgers.push_back(open_ledger(flux.back()));
            ledgers.back().conversions = i % 5 == 0 ? 15 : i % 4;
            (i % 3 == 2 || generator() % 2 == 0 ? fluorescence : elastic).push_back(i);
        }
    }
};

}  // namespace stokes
