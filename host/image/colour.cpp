#include "host/image/colour.hpp"

#include <cmath>

#include "host/core/csv_spectrum.hpp"
#include "host/core/embedded.hpp"
#include "host/core/error.hpp"

namespace stokes {
namespace {

// Columns are the XYZ of a primary of luminance 1 at chromaticity (x, y).
glm::dvec3 at_chromaticity(double x, double y) { return {x / y, 1.0, (1.0 - x - y) / y}; }

glm::dmat3 make_xyz_from_rec709() {
    const glm::dmat3 primaries(at_chromaticity(0.64, 0.33), at_chromaticity(0.30, 0.60), at_chromaticity(0.15, 0.06));
    const glm::dvec3 weight = glm::inverse(primaries) * at_chromaticity(0.3127, 0.3290);
    return {primaries[0] * weight.x, primaries[1] * weight.y, primaries[2] * weight.z};
}

const glm::dmat3& xyz_from_rec709() {
    static const glm::dmat3 matrix = make_xyz_from_rec709();
    return matrix;
}

// Oklab's two matrices, each row of the publication a row here: multiply from the left, vector * matrix.
const glm::dmat3 cones_from_rec709(0.4122214708, 0.5363325363, 0.0514459929,  //
                                   0.2119034982, 0.6806995451, 0.1073969566,  //
                                   0.0883024619, 0.2817188376, 0.6299787005);
const glm::dmat3 oklab_from_cube_roots(0.2104542553, 0.7936177850, -0.0040720468,  //
                                       1.9779984951, -2.4285922050, 0.4505937099,  //
                                       0.0259040371, 0.7827717662, -0.8086757660);

}  // namespace

Spectrum cie_spectrum(const std::string& file, const std::string& column) {
    const std::string path = "tables/cie/" + file;
    const auto found = embedded_files().find(path);
    if (found == embedded_files().end()) throw InputError(path + ": no such table in this program");
    return csv_spectrum(parse_csv(found->second, path), column, Outside::zero);
}

const ColourMatching& cie1931() {
    const char* file = "cie1931_2deg_1nm.csv";
    static const ColourMatching functions{cie_spectrum(file, "xbar"), cie_spectrum(file, "ybar"),
                                          cie_spectrum(file, "zbar")};
    return functions;
}

glm::dvec3 xyz_of(const Spectrum& radiance) {
    const ColourMatching& matching = cie1931();
    glm::dvec3 sum(0.0);
    for (int lambda = first_lambda_nm; lambda <= last_lambda_nm; ++lambda)
        sum += radiance.at(lambda) * glm::dvec3(matching.x.at(lambda), matching.y.at(lambda), matching.z.at(lambda));
    return luminous_efficacy * sum;
}

const glm::dmat3& rec709_from_xyz() {
    static const glm::dmat3 matrix = glm::inverse(xyz_from_rec709());
    return matrix;
}

glm::dvec3 rec709_of_xyz(const glm::dvec3& xyz) { return rec709_from_xyz() * xyz; }

glm::dvec3 xyz_of_rec709(const glm::dvec3& rgb) { return xyz_from_rec709() * rgb; }

std::optional<glm::dmat3> xyz_from_primaries(const Primaries& primaries) {
    const auto direction = [](const glm::dvec2& at) { return glm::dvec3(at.x, at.y, 1.0 - at.x - at.y); };
    const glm::dmat3 columns(direction(primaries.red), direction(primaries.green), direction(primaries.blue));
    // Chromaticities are single precision: a smaller area than this is none.
    if (!(std::abs(glm::determinant(columns)) > 1e-6) || !(primaries.white.y > 0.0)) return std::nullopt;
    const glm::dvec3 weight = glm::inverse(columns) * (direction(primaries.white) / primaries.white.y);
    const glm::dmat3 matrix(columns[0] * weight.x, columns[1] * weight.y, columns[2] * weight.z);
    for (int c = 0; c < 3; ++c)
        if (!std::isfinite(matrix[c].x + matrix[c].y + matrix[c].z) || weight[c] == 0.0) return std::nullopt;
    return matrix;
}

glm::dvec3 oklab_of_rec709(const glm::dvec3& rgb) {
    const glm::dvec3 cones = rgb * cones_from_rec709;
    return glm::dvec3(std::cbrt(cones.x), std::cbrt(cones.y), std::cbrt(cones.z)) * oklab_from_cube_roots;
}

glm::dvec3 rec709_of_oklab(const glm::dvec3& lab) {
    static const glm::dmat3 rec709_from_cones = glm::inverse(cones_from_rec709);
    static const glm::dmat3 cube_roots_from_oklab = glm::inverse(oklab_from_cube_roots);
    const glm::dvec3 root = lab * cube_roots_from_oklab;
    return (root * root * root) * rec709_from_cones;
}

}  // namespace stokes
