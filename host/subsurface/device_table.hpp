// Photon power tables as kernels/lib/power_table.clh reads them.
#pragma once

#include <cstddef>
#include <vector>

#include "host/subsurface/power_table.hpp"
#include "kernels/shared/limits.h"
#include "kernels/shared/power_table.h"

namespace stokes {

// An axis of evenly spaced values: value i is first + i * step.
struct UniformAxis {
    std::size_t count = 0;
    double first = 0.0;
    double step = 1.0;  // 1 for a single value
};

// Throws InputError naming the table's component and the axis when the values are not evenly spaced.
UniformAxis uniform_axis(const PowerTable& table, const TableAxis& axis);

// The wavelengths of the values that device_layout() writes [nm].
UniformAxis device_wavelengths(const PowerTable& table);

// Rows are the values of theta, or a single row without such an axis. offset: the table's first entry in the
// buffer it goes to [entries]. Throws InputError as uniform_axis() does, or for fewer than two distances.
TableShape table_shape(const PowerTable& table, std::size_t offset = 0);

// The values as [row][r][lambda], in the table's unit.
std::vector<float> device_layout(const PowerTable& table);

// The entry (row, r) of the table: its values over all wavelengths.
const double* table_entry(const PowerTable& table, const TableShape& shape, std::size_t row, std::size_t r);

}  // namespace stokes
