// Gauss-Legendre quadrature.
#pragma once

#include <vector>

namespace stokes {

// Nodes and weights on [0, 1], exact for polynomials up to degree 2 order - 1.
struct GaussLegendre {
    explicit GaussLegendre(int order);
    std::vector<double> node, weight;

    template <class Function>
    double integral(double low, double high, Function&& f) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < node.size(); ++i) sum += weight[i] * f(low + (high - low) * node[i]);
        return (high - low) * sum;
    }
};

}  // namespace stokes
