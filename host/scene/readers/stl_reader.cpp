#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "host/core/error.hpp"
#include "host/core/text_input.hpp"
#include "host/scene/readers/mesh_reader.hpp"
#include "host/scene/readers/mesh_text.hpp"

namespace stokes {
namespace {

constexpr std::size_t head_bytes = 84;      // 80 of text, then the number of triangles
constexpr std::size_t triangle_bytes = 50;  // normal and three corners of three floats each, two bytes more

std::string lower(std::string_view word) {
    std::string text(word);
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

std::uint32_t triangle_count(std::string_view text) {
    std::uint32_t count = 0;
    std::memcpy(&count, text.data() + head_bytes - sizeof count, sizeof count);
    return count;
}

// Binary files may begin with "solid", as ascii files do: their size tells.
bool is_binary(std::string_view text) {
    if (text.size() < head_bytes) return false;
    return text.size() == head_bytes + triangle_bytes * std::size_t{triangle_count(text)} ||
           lower(text.substr(0, 5)) != "solid";
}

FileMesh parse_binary(std::string_view text, const std::string& file) {
    const std::size_t count = triangle_count(text), there = (text.size() - head_bytes) / triangle_bytes;
    if (count > there)
        throw InputError(
            fmt::format("{}: the header promises {} triangles, but the file is too short for them", file, count));
    FileMesh mesh;
    mesh.positions.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        float corners[9];
        std::memcpy(corners, text.data() + head_bytes + triangle_bytes * i + 12, sizeof corners);
        for (int k = 0; k < 3; ++k) mesh.positions.emplace_back(corners[3 * k], corners[3 * k + 1], corners[3 * k + 2]);
        if (!std::all_of(corners, corners + 9, [](float x) { return std::isfinite(x); }))
            throw InputError(fmt::format("{}: triangle {}: expected finite coordinates", file, i));
    }
    remark_on_steps(mesh, file);
    return mesh;
}

FileMesh parse_ascii(std::string_view text, const std::string& file) {
    FileMesh mesh;
    TextScanner scanner(text);
    std::size_t corners = 0;  // of the triangle so far
    const auto fail = [&](const std::string& what) {
        throw InputError(fmt::format("{}:{}: {}", file, scanner.line(), what));
    };
    for (; !scanner.at_end(); scanner.take_line()) {
        const std::string word = lower(scanner.token());
        if (word == "outer") corners = 0;
        if (word == "endloop" && corners != 3) fail(fmt::format("expected a triangle, got {} vertices", corners));
        if (word != "vertex") continue;
        ++corners;
        glm::dvec3 position(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view token = scanner.token();
            position[axis] = parse_double(token).value_or(NAN);
            if (!std::isfinite(static_cast<float>(position[axis])))
                fail(fmt::format("expected 3 finite coordinates, got \"{}\"", printable(token)));
        }
        mesh.positions.push_back(position);
    }
    if (mesh.positions.size() % 3 != 0) fail("the file ends within a triangle");
    return mesh;
}

}  // namespace

FileMesh parse_stl(std::string_view text, const std::string& file) {
    FileMesh mesh;
    if (is_binary(text)) {
        mesh = parse_binary(text, file);
    } else {
        std::string mended(without_mark(text, file));
        if (lower(TextScanner(mended).token()) != "solid")
            throw InputError(file + ":1: expected \"solid\", the first word of an ascii STL file");
        mend_line_ends(mended, mended.size());
        mesh = parse_ascii(mended, file);
    }
    if (mesh.positions.empty()) throw InputError(file + ": no triangles");
    for (std::uint32_t i = 0; i < mesh.positions.size(); i += 3) mesh.triangles.push_back({i, i + 1, i + 2});
    return mesh;
}

}  // namespace stokes
