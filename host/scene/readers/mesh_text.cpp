#include "host/scene/readers/mesh_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "host/core/error.hpp"

namespace stokes {
namespace {

// Steps of single precision above this share of a mesh's size show.
constexpr double largest_step = 2e-4;

bool is_lone_return(std::string_view text, std::size_t i) {
    return text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n');
}

}  // namespace

std::string_view without_mark(std::string_view text, const std::string& file) {
    for (const std::string_view mark : {"\xff\xfe", "\xfe\xff"})
        if (text.substr(0, 2) == mark) throw InputError(file + ": expected UTF-8 text, got UTF-16");
    if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
    return text;
}

void mend_line_ends(std::string& text, std::size_t end) {
    for (std::size_t i = 0; i < std::min(end, text.size()); ++i)
        if (is_lone_return(text, i)) text[i] = '\n';
}

bool has_lone_returns(std::string_view text) {
    for (std::size_t i = text.find('\r'); i != std::string_view::npos; i = text.find('\r', i + 1))
        if (is_lone_return(text, i)) return true;
    return false;
}

std::string crossing_remark(const std::string& place, std::size_t faces) {
    return fmt::format("{}: this face {}, so parts of {} may overlap or be seen from behind", place,
                       faces == 1 ? "crosses itself" : fmt::format("and {} more cross themselves", faces - 1),
                       faces == 1 ? "it" : "them");
}

void remark_on_steps(FileMesh& mesh, const std::string& file) {
    if (mesh.positions.empty()) return;
    glm::dvec3 low = mesh.positions.front(), high = low;
    for (const glm::dvec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 far = glm::max(glm::abs(low), glm::abs(high)), size = high - low;
    const double step = std::numeric_limits<float>::epsilon() * std::max({far.x, far.y, far.z});
    const double extent = std::max({size.x, size.y, size.z});
    if (step > largest_step * extent)
        mesh.remarks.push_back(
            fmt::format("{}: its coordinates are in single precision (float) with steps of {:.2g}, far from their "
                        "origin beside its "
                        "size of {:.3g}; as doubles, or nearer to the origin, they would keep its form",
                        file, step, extent));
}

}  // namespace stokes
