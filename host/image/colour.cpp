#include "host/image/colour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>
#include <vector>

#include "host/core/embedded.hpp"
#include "host/core/error.hpp"

namespace stokes {
namespace {

std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> fields;
    for (;;) {
        const std::size_t comma = line.find(',');
        fields.push_back(line.substr(0, comma));
        if (comma == std::string_view::npos) return fields;
        line.remove_prefix(comma + 1);
    }
}

double number(std::string_view text, const std::string& file, int line) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        throw InputError(fmt::format("{}:{}: expected a number, found \"{}\"", file, line, text));
    return value;
}

// Columns are the XYZ of a primary of luminance 1 at chromaticity (x, y).
glm::dvec3 at_chromaticity(double x, double y) {
    return {x / y, 1.0, (1.0 - x - y) / y};
}

glm::dmat3 make_xyz_from_rec709() {
    const glm::dmat3 primaries(at_chromaticity(0.64, 0.33), at_chromaticity(0.30, 0.60),
                               at_chromaticity(0.15, 0.06));
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

    Spectrum spectrum;
    std::istringstream text(found->second);
    std::string line;
    std::size_t wanted = 0;
    for (int line_number = 1; std::getline(text, line); ++line_number) {
        if (line.empty() || line[0] == '#') continue;
        const std::vector<std::string_view> fields = split(line);
        if (wanted == 0) {
            wanted =
                static_cast<std::size_t>(std::find(fields.begin(), fields.end(), column) - fields.begin());
            if (wanted == 0 || wanted == fields.size())
                throw InputError(fmt::format("{}:{}: no column \"{}\"", path, line_number, column));
            continue;
        }
        if (fields.size() <= wanted)
            throw InputError(fmt::format("{}:{}: expected {} fields", path, line_number, wanted + 1));
        spectrum.lambda_nm.push_back(number(fields[0], path, line_number));
        spectrum.value.push_back(number(fields[wanted], path, line_number));
    }
    return spectrum;
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
    for (int lambda = 300; lambda <= 830; ++lambda)
        sum += radiance.at(lambda) *
               glm::dvec3(matching.x.at(lambda), matching.y.at(lambda), matching.z.at(lambda));
    return luminous_efficacy * sum;
}

const glm::dmat3& rec709_from_xyz() {
    static const glm::dmat3 matrix = glm::inverse(xyz_from_rec709());
    return matrix;
}

glm::dvec3 rec709_of_xyz(const glm::dvec3& xyz) {
    return rec709_from_xyz() * xyz;
}

glm::dvec3 xyz_of_rec709(const glm::dvec3& rgb) {
    return xyz_from_rec709() * rgb;
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

double srgb_encode(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double srgb_decode(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace stokes
