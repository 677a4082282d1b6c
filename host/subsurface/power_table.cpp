#include "host/subsurface/power_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/core/json_text.hpp"
#include "host/core/media_limits.hpp"
#include "host/subsurface/paper_transport.hpp"
#include "host/subsurface/table_json.hpp"

namespace stokes {
namespace {

void check_increasing(const std::string& name, const std::vector<double>& values, double low, double high) {
    if (values.empty()) throw InputError(fmt::format("table grid: axis {} is empty", name));
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!(values[i] >= low && values[i] <= high))
            throw InputError(fmt::format("table grid: {} = {} is outside of [{}, {}]", name, values[i], low, high));
        if (i > 0 && values[i] <= values[i - 1])
            throw InputError(fmt::format("table grid: axis {} is not strictly increasing at {}", name, values[i]));
    }
}

void check_grid(const TableGrid& grid) {
    check_increasing("r", grid.r_mm, 0.0, 1e6);
    check_increasing("theta", grid.theta_deg, 0.0, 90.0);
    check_increasing("lambda", grid.lambda_nm, 1.0, 1e6);
}

void check_coefficients(const std::string& medium, double lambda_nm, double sigma_s, double sigma_a) {
    const auto fail = [&](const std::string& reason) {
        throw InputError(fmt::format("medium \"{}\" at {} nm: {}", medium, lambda_nm, reason));
    };
    if (!std::isfinite(sigma_s) || sigma_s < 0.0)
        fail(fmt::format("sigma_s = {} 1/mm, expected a finite number of at least 0", sigma_s));
    if (!std::isfinite(sigma_a) || sigma_a < 0.0)
        fail(fmt::format("sigma_a = {} 1/mm, expected a finite number of at least 0", sigma_a));
    const double sigma_t = sigma_s + sigma_a;
    if (sigma_t < smallest_sigma_t_per_mm || sigma_t > largest_sigma_t_per_mm)
        fail(fmt::format("sigma_t = sigma_s + sigma_a = {} 1/mm, expected {} to {}", sigma_t, smallest_sigma_t_per_mm,
                         largest_sigma_t_per_mm));
}

PowerTable empty_table(const std::string& component, const std::string& unit, const MediumSpectra& medium,
                       const TableGrid& grid, bool with_theta) {
    check_grid(grid);
    PowerTable table;
    table.model = "paper";
    table.component = component;
    table.unit = unit;
    table.medium = table_medium(medium, grid.lambda_nm);
    table.axes.push_back({"r", "mm", grid.r_mm});
    if (with_theta) table.axes.push_back({"theta", "deg", grid.theta_deg});
    table.axes.push_back({"lambda", "nm", grid.lambda_nm});
    std::size_t count = 1;
    for (const TableAxis& axis : table.axes) count *= axis.values.size();
    table.values.resize(count);
    return table;
}

// Sets table.values[distance and angle][lambda] = power(sigma_s, sigma_a, r, theta). Measured spectra are
// often constant over part of the range: equal coefficients are computed once.
template <class Power>
void fill(PowerTable& table, const std::vector<double>& theta_deg, const Power& power) {
    const TableMedium& medium = table.medium;
    const std::vector<double>& r_mm = table.axes.front().values;
    const std::size_t lambdas = medium.sigma_s.size();
    std::map<std::pair<double, double>, std::size_t> first_with;
    std::vector<std::size_t> same_as(lambdas);
    for (std::size_t i = 0; i < lambdas; ++i)
        same_as[i] = first_with.insert({{medium.sigma_s[i], medium.sigma_a[i]}, i}).first->second;

    std::vector<RefractionAngle> angles;
    for (double theta : theta_deg) angles.push_back(RefractionAngle::from_degrees(theta));
    double* row = table.values.data();
    for (double r : r_mm)
        for (const RefractionAngle& angle : angles) {
            for (std::size_t i = 0; i < lambdas; ++i)
                row[i] = same_as[i] < i ? row[same_as[i]] : power(medium.sigma_s[i], medium.sigma_a[i], r, angle);
            row += lambdas;
        }
}

}  // namespace

const TableAxis* PowerTable::axis(const std::string& name) const {
    for (const TableAxis& candidate : axes)
        if (candidate.name == name) return &candidate;
    return nullptr;
}

TableGrid::TableGrid() {
    for (int i = 0; i < 100; ++i) {
        r_mm.push_back(i / 10.0);
        theta_deg.push_back(i * 9 / 10.0);
        lambda_nm.push_back(300.0 + 5.0 * i);
    }
}

TableMedium table_medium(const MediumSpectra& medium, const std::vector<double>& lambda_nm) {
    TableMedium result{medium.name, {}, {}, medium.eta, medium.dipole_eta};
    for (const double lambda : lambda_nm) {
        const double sigma_s = medium.sigma_s.at(lambda), sigma_a = medium.sigma_a.at(lambda);
        check_coefficients(medium.name, lambda, sigma_s, sigma_a);
        result.sigma_s.push_back(sigma_s);
        result.sigma_a.push_back(sigma_a);
    }
    return result;
}

PowerTable make_fluorescence_table(const MediumSpectra& medium, const TableGrid& grid) {
    PowerTable table = empty_table("fluorescence", "mm", medium, grid, true);
    fill(table, grid.theta_deg, [](double sigma_s, double sigma_a, double r, const RefractionAngle& theta) {
        return fluorescence_power(sigma_s + sigma_a, r, theta);
    });
    return table;
}

PowerTable make_single_table(const MediumSpectra& medium, const TableGrid& grid) {
    PowerTable table = empty_table("single", "1", medium, grid, true);
    fill(table, grid.theta_deg, [](double sigma_s, double sigma_a, double r, const RefractionAngle& theta) {
        return single_power(sigma_s, sigma_s + sigma_a, r, theta);
    });
    return table;
}

PowerTable make_multiple_table(const MediumSpectra& medium, const TableGrid& grid) {
    const double dipole_a = dipole_boundary(medium.dipole_eta);
    PowerTable table = empty_table("multiple", "1/mm^2", medium, grid, false);
    fill(table, {0.0}, [&](double sigma_s, double sigma_a, double r, const RefractionAngle&) {
        return multiple_power(sigma_a, sigma_s + sigma_a, dipole_a, r);
    });
    return table;
}

void write_power_table(const PowerTable& table, const std::string& path) {
    const TableMedium& medium = table.medium;
    nlohmann::ordered_json json = table_json(table.model, table.component);
    json["medium"] = {{"name", medium.name},
                      {"eta", medium.eta},
                      {"dipole_eta", medium.dipole_eta},
                      {"sigma_s", medium.sigma_s},
                      {"sigma_a", medium.sigma_a}};
    json["axes"] = axes_json(table.axes);
    json["unit"] = table.unit;
    json["values"] = table.values;
    write_file_atomically(path, json_text(json, -1));
}

}  // namespace stokes
