// The universal Green's function table of a half-space, of the transport model `conserving`: where the light
// of an isotropic point source at depth z leaves after it has been scattered or internally reflected.
//
// All lengths are in mean free paths, so that one table per refractive index serves every medium and every
// wavelength.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stokes {

struct GreenTable {
    double eta = 1.0;            // refractive index relative to the outside
    std::vector<double> rho;     // lateral distance; node 0 at 0, the others logarithmic
    std::vector<double> z;       // depth of the source; likewise
    std::vector<double> albedo;  // strictly increasing, the first 0, the last 1
    // 2 pi rho G1, the escape density over rho [1/mfp], [albedo][z][rho]. Piecewise linear in rho, its
    // integral is u1.
    std::vector<float> h1;
    std::vector<float> u0;  // [z] probability of leaving unscattered and not internally reflected
    std::vector<float> u1;  // [albedo][z] probability of leaving otherwise

    std::size_t row(std::size_t a, std::size_t z_index) const { return (a * z.size() + z_index) * rho.size(); }
};

// The nodes of the shipped tables, with u0 and u1 and an empty h1: rho 0 and 0.003 .. 600, z 0 and 0.01 ..
// 32, 32 albedos of which 1 - a falls geometrically from 1 to 1e-4 and then is 0. Throws InputError for eta
// outside [1, 4].
GreenTable green_table_nodes(double eta);

// Octaves between the nodes of a logarithmic axis, from node 1 on.
double octaves_per_node(const std::vector<double>& axis);

// Trapezoid integral over rho of one row of h1.
double green_row_integral(const GreenTable& table, std::size_t a, std::size_t z_index);

// Scales every row to the integral u1; a row without light stays as it is.
void normalise_green_rows(GreenTable& table);

// Takes noise out: log(h1) at a node is replaced by that of the parabola in log(rho), then in log(z), that
// fits it and its two neighbours on either side best (Savitzky and Golay 1964). Nodes without such neighbours
// keep their values.
void smooth_green_rows(GreenTable& table);

// u1 between the nodes, by cubic interpolation in log(z) and sqrt(1 - a), with the leading terms z and z
// log(z) above the first depth; beyond the last it falls off as light does deep in the medium.
class GreenTotals {
  public:
    explicit GreenTotals(const GreenTable& table);
    // z >= 0, albedo in [0, 1]. Error below 1e-4 for z up to 20.
    double at(double z, double albedo) const;

  private:
    double at_node(std::size_t a, double z) const;
    std::vector<double> z_, log_z_, root_, kappa_, u1_;
};

// JSON, format "photon-power-table" version 1, model "conserving", axes rho, z, albedo, compressed by gzip.
// The densities keep four digits. Complete or not at all; throws RunError when the file cannot be written.
void write_green_table(const GreenTable& table, const std::string& path);

// Reads and checks a table: format, version, model, axes, finite values that are not negative, probabilities,
// and rows whose integral is u1 up to rounding. The rows are then scaled to it exactly. Throws InputError
// "PATH: ...".
GreenTable read_green_table(const std::string& path);

// The same from a file's content; name stands for the path in complaints.
GreenTable parse_green_table(std::string_view content, const std::string& name);

}  // namespace stokes
