#include "host/subsurface/device_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/core/error.hpp"

namespace stokes {
namespace {

const TableAxis& required_axis(const PowerTable& table, const std::string& name) {
    const TableAxis* axis = table.axis(name);
    if (axis == nullptr)
        throw InputError(fmt::format("{} table of \"{}\": no axis {}", table.component, table.medium.name, name));
    return *axis;
}

}  // namespace

UniformAxis uniform_axis(const PowerTable& table, const TableAxis& axis) {
    UniformAxis even{axis.values.size(), axis.values.front(), 1.0};
    if (even.count == 1) return even;
    even.step = (axis.values.back() - even.first) / static_cast<double>(even.count - 1);
    for (std::size_t i = 0; i < even.count; ++i)
        if (std::abs(axis.values[i] - (even.first + static_cast<double>(i) * even.step)) > 1e-4 * even.step)
            throw InputError(fmt::format("{} table of \"{}\": axis {} is not evenly spaced at {} {}", table.component,
                                         table.medium.name, axis.name, axis.values[i], axis.unit));
    return even;
}

UniformAxis device_wavelengths(const PowerTable& table) { return uniform_axis(table, required_axis(table, "lambda")); }

TableShape table_shape(const PowerTable& table, std::size_t offset) {
    const UniformAxis r = uniform_axis(table, required_axis(table, "r"));
    if (r.count < 2)
        throw InputError(fmt::format("{} table of \"{}\": axis r has {} value, expected at least 2", table.component,
                                     table.medium.name, r.count));
    const TableAxis* theta = table.axis("theta");
    const UniformAxis rows = theta == nullptr ? UniformAxis{1, 0.0, 1.0} : uniform_axis(table, *theta);
    TableShape shape{};
    shape.offset = static_cast<unsigned>(offset);
    shape.row_count = static_cast<unsigned>(rows.count);
    shape.row_first = static_cast<float>(rows.first);
    shape.row_step = static_cast<float>(rows.step);
    shape.r_count = static_cast<unsigned>(r.count);
    shape.r_first = static_cast<float>(r.first);
    shape.r_step = static_cast<float>(r.step);
    return shape;
}

const double* table_entry(const PowerTable& table, const TableShape& shape, std::size_t row, std::size_t r) {
    const std::size_t lambdas = table.axes.back().values.size();
    return table.values.data() + (r * shape.row_count + row) * lambdas;
}

std::vector<float> device_layout(const PowerTable& table) {
    const TableShape shape = table_shape(table);
    const std::size_t lambdas = table.axes.back().values.size();
    std::vector<float> layout;
    layout.reserve(table.values.size());
    for (std::size_t row = 0; row < shape.row_count; ++row)
        for (std::size_t r = 0; r < shape.r_count; ++r) {
            const double* entry = table_entry(table, shape, row, r);
            for (std::size_t i = 0; i < lambdas; ++i) layout.push_back(static_cast<float>(entry[i]));
        }
    return layout;
}

}  // namespace stokes
