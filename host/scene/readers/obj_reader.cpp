#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "host/core/error.hpp"
#include "host/core/text_input.hpp"
#include "host/scene/readers/mesh_reader.hpp"

namespace stokes {
namespace {

class ObjParser {
  public:
    ObjParser(std::string_view text, const std::string& file) : scanner_(text), file_(file) {}

    Mesh parse() {
        while (!scanner_.at_end()) {
            const std::string_view keyword = scanner_.token();
            if (keyword == "v") read_vertex();
            if (keyword == "vt") read_uv();
            if (keyword == "f") read_face();
            scanner_.take_line();
        }
        if (largest_index_ >= static_cast<std::int64_t>(mesh_.positions_mm.size())) {
            fail_index(largest_index_line_, largest_index_ + 1);
        }
        if (mesh_.triangles.empty()) throw InputError(file_ + ": no triangles");
        if (largest_uv_ != no_uv && largest_uv_ >= static_cast<std::int64_t>(uvs_.size()))
            drop_uv(largest_uv_line_, fmt::format("texture coordinate {} of {}", largest_uv_ + 1, uvs_.size()));
        if (uvs_.empty()) mesh_.uv_fault.clear();
        if (largest_uv_ != no_uv)
            for (const auto& t : uv_triangles_) mesh_.uv.push_back({uvs_[t[0]], uvs_[t[1]], uvs_[t[2]]});
        return std::move(mesh_);
    }

  private:
    [[noreturn]] void fail(std::int64_t line, const std::string& what) const {
        throw InputError(fmt::format("{}:{}: {}", file_, line, what));
    }

    [[noreturn]] void fail_index(std::int64_t line, std::int64_t index) const {
        fail(line,
             fmt::format("vertex index {} out of range: the file has {} vertices", index, mesh_.positions_mm.size()));
    }

    void read_vertex() {
        glm::vec3 position(0.0F);
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view token = scanner_.token();
            const auto value = parse_double(token);
            position[axis] = static_cast<float>(value.value_or(0.0));
            if (!value || !std::isfinite(position[axis])) {
                fail(scanner_.line(), fmt::format("expected 3 finite coordinates, got \"{}\"", printable(token)));
            }
        }
        if (mesh_.positions_mm.size() >= std::numeric_limits<std::uint32_t>::max()) {
            fail(scanner_.line(), "more vertices than 32-bit indices can count");
        }
        mesh_.positions_mm.push_back(position);
    }

    // What is no pair of finite numbers makes the mesh one without texture coordinates.
    void read_uv() {
        const auto u = parse_double(scanner_.token()), v = parse_double(scanner_.token());
        const glm::vec2 uv(static_cast<float>(u.value_or(NAN)), 1.0f - static_cast<float>(v.value_or(NAN)));
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
            drop_uv(scanner_.line(), "expected two finite texture coordinates");
        uvs_.push_back(uv);
    }

    void read_face() {
        glm::uvec3 triangle(0);
        std::array<std::uint32_t, 3> uvs{};
        int corners = 0;
        for (std::string_view token = scanner_.token(); !token.empty(); token = scanner_.token()) {
            if (token.front() == '#') break;
            const std::uint32_t index = read_index(token), uv = read_uv_index(token);
            if (corners < 2) {
                triangle[corners] = index;
                uvs[static_cast<std::size_t>(corners)] = uv;
            } else {
                triangle.z = index;
                uvs[2] = uv;
                mesh_.triangles.push_back(triangle);
                if (largest_uv_ != no_uv) uv_triangles_.push_back(uvs);
                triangle.y = index;
                uvs[1] = uv;
            }
            ++corners;
        }
        if (corners < 3) fail(scanner_.line(), fmt::format("expected a face of 3 or more vertices, got {}", corners));
    }

    // "7", "7/1", "7//3", "7/1/3" or, counted back from the last vertex, "-2".
    std::uint32_t read_index(std::string_view token) {
        const auto number = parse_integer(token.substr(0, token.find('/')));
        if (!number || *number == 0) {
            fail(scanner_.line(), fmt::format("expected a vertex index, got \"{}\"", printable(token)));
        }
        const auto count = static_cast<std::int64_t>(mesh_.positions_mm.size());
        const bool too_far_back = *number < -count;
        if (too_far_back || *number > std::numeric_limits<std::uint32_t>::max()) fail_index(scanner_.line(), *number);
        const std::int64_t index = *number > 0 ? *number - 1 : count + *number;
        if (index > largest_index_) {
            largest_index_ = index;
            largest_index_line_ = scanner_.line();
        }
        return static_cast<std::uint32_t>(index);
    }

    // The second number of "7/1/3".
    std::uint32_t read_uv_index(std::string_view token) {
        const std::size_t first = token.find('/');
        const std::string_view rest = first == std::string_view::npos ? "" : token.substr(first + 1);
        const auto number = parse_integer(rest.substr(0, rest.find('/')));
        const auto count = static_cast<std::int64_t>(uvs_.size());
        if (!number || *number == 0 || *number < -count || *number > std::numeric_limits<std::uint32_t>::max()) {
            if (largest_uv_ != no_uv) drop_uv(scanner_.line(), "expected a texture coordinate at every corner");
            return 0;
        }
        const std::int64_t index = *number > 0 ? *number - 1 : count + *number;
        if (index > largest_uv_) {
            largest_uv_ = index;
            largest_uv_line_ = scanner_.line();
        }
        return static_cast<std::uint32_t>(index);
    }

    // The mesh is one without texture coordinates, whatever else the file has of them. The first reason is kept.
    void drop_uv(std::int64_t line, const std::string& reason) {
        largest_uv_ = no_uv;
        if (mesh_.uv_fault.empty()) mesh_.uv_fault = fmt::format("{}:{}: {}", file_, line, reason);
    }

    static constexpr std::int64_t no_uv = std::numeric_limits<std::int64_t>::max();

    TextScanner scanner_;
    const std::string& file_;
    Mesh mesh_;
    std::vector<glm::vec2> uvs_;
    std::vector<std::array<std::uint32_t, 3>> uv_triangles_;  // indices of uvs_, until one is missing
    std::int64_t largest_uv_line_ = 0;
    std::int64_t largest_uv_ = -1;     // no_uv: the mesh has no texture coordinates
    std::int64_t largest_index_ = -1;  // a face may come before its vertices, so this is checked at the end
    std::int64_t largest_index_line_ = 0;
};

}  // namespace

Mesh parse_obj(std::string_view text, const std::string& file) { return ObjParser(text, file).parse(); }

}  // namespace stokes
