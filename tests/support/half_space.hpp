// What exact transport theory says of a half-space, without random numbers.
#pragma once

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "host/subsurface/escape.hpp"
#include "host/subsurface/quadrature.hpp"

namespace stokes {

// Quadrature of integral_0^inf f(t) exp(-t) dt, panels graded toward 0: nodes and weights.
struct FirstCollision {
    std::vector<double> t, weight;

    FirstCollision() {
        const GaussLegendre rule(16);
        std::vector<double> edges{0.0};
        for (int k = -14; k <= 5; ++k) edges.push_back(std::ldexp(1.0, k));
        edges.push_back(45.0);
        for (std::size_t p = 0; p + 1 < edges.size(); ++p)
            for (std::size_t i = 0; i < rule.node.size(); ++i) {
                t.push_back(edges[p] + (edges[p + 1] - edges[p]) * rule.node[i]);
                weight.push_back((edges[p + 1] - edges[p]) * rule.weight[i] * std::exp(-t.back()));
            }
    }
};

// Share of the light that first collisions send on isotropically which leaves at once, and which ever leaves. It
// arrives within the medium at cosine mu; ratio: sigma_t of the light sent on over that of the light that arrives;
// albedo: of the former. eta: of the boundary.
struct Escaping {
    double direct = 0.0, total = 0.0;
};

inline Escaping escaping_share(double eta, double mu, double albedo, double ratio = 1.0) {
    static const FirstCollision first;
    static std::map<std::pair<double, double>, HalfSpaceEscape> known;  // by eta and scale of the depths
    const std::pair<double, double> key{eta, mu * ratio};
    if (known.count(key) == 0) {
        std::vector<double> depths;
        for (const double t : first.t) depths.push_back(t * mu * ratio);
        known.emplace(key, HalfSpaceEscape(eta, depths));
    }
    const HalfSpaceEscape& escape = known.at(key);
    const std::vector<double> total = escape.total(albedo);
    Escaping result;
    for (std::size_t i = 0; i < total.size(); ++i) {
        result.direct += first.weight[i] * escape.unscattered()[i];
        result.total += first.weight[i] * total[i];
    }
    return result;
}

// The reflectance of a half-space, 1 - sqrt(1 - a) H(mu), to the digits that PHYSICS section 4 gives (Chandrasekhar,
// "Radiative Transfer", 1960).
inline constexpr struct {
    double albedo, mu, expected;
} chandrasekhar[] = {{0.9, 1.0, 0.4149475},
                     {0.9, 0.5, 0.5079389},
                     {0.5, 1.0, 0.1152259},
                     {0.99, 1.0, 0.7527207},
                     {0.998, 0.5, 0.9133801}};

// Cosine below the surface of light that arrives at cosine mu.
inline double cosine_within(double eta, double mu) { return std::sqrt(1.0 - (1.0 - mu * mu) / (eta * eta)); }

}  // namespace stokes
