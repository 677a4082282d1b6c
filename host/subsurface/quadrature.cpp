#include "host/subsurface/quadrature.hpp"

#include <cmath>

namespace stokes {

GaussLegendre::GaussLegendre(int order) : node(order), weight(order) {
    for (int i = 0; i < order; ++i) {
        double x = std::cos(M_PI * (i + 0.75) / (order + 0.5)), slope = 0.0;
        for (int iteration = 0; iteration < 100; ++iteration) {
            double previous = 1.0, current = x;
            for (int n = 2; n <= order; ++n) {
                const double next = ((2 * n - 1) * x * current - (n - 1) * previous) / n;
                previous = current;
                current = next;
            }
            slope = order * (x * current - previous) / (x * x - 1.0);
            const double step = current / slope;
            x -= step;
            if (std::abs(step) < 1e-16) break;
        }
        node[i] = 0.5 * (1.0 - x);
        weight[i] = 1.0 / ((1.0 - x * x) * slope * slope);
    }
}

}  // namespace stokes
