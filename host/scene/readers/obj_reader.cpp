#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/core/error.hpp"
#include "host/core/text_input.hpp"
#include "host/scene/readers/mesh_reader.hpp"
#include "host/scene/readers/mesh_text.hpp"

namespace stokes {
namespace {

class ObjParser {
  public:
    ObjParser(std::string_view text, const std::string& file) : scanner_(text), file_(file) {}

    FileMesh parse() {
        while (!scanner_.at_end()) {
            const std::string_view keyword = token();
            if (keyword == "v") read_vertex();
            if (keyword == "vt") read_uv();
            if (keyword == "f" || keyword == "fo") read_face();
            if (keyword == "usemtl") material_name_ = name();
            if (keyword == "o") object_ = true;
            if (keyword == "g") group_name_ = name();
            if (is_free_form(keyword) && free_forms_++ == 0) free_form_line_ = scanner_.line();
            scanner_.take_line();
        }
        if (largest_index_ >= static_cast<std::int64_t>(mesh_.positions.size())) {
            fail_index(largest_index_line_, largest_index_ + 1);
        }
        if (mesh_.triangles.empty())
            throw InputError(file_ + (mesh_.positions.empty() ? ": no triangles" : ": no triangles, only points"));
        finish_uv();
        finish_polygons();
        mesh_.groups = separate_groups();
        if (free_forms_ > 0)
            mesh_.remarks.push_back(
                fmt::format("{}:{}: {} not read (curv, surf ..), only faces", file_, free_form_line_,
                            free_forms_ == 1 ? "a free form is" : fmt::format("{} free forms are", free_forms_)));
        return std::move(mesh_);
    }

  private:
    // Statements that draw something; those about them (cstype, deg, parm, end ..) go with these.
    static bool is_free_form(std::string_view keyword) {
        constexpr std::array<std::string_view, 7> all = {"curv", "curv2", "surf", "bsp", "bzp", "cdc", "cdp"};
        return std::find(all.begin(), all.end(), keyword) != all.end();
    }

    [[noreturn]] void fail(std::int64_t line, const std::string& what) const {
        throw InputError(fmt::format("{}:{}: {}", file_, line, what));
    }

    [[noreturn]] void fail_index(std::int64_t line, std::int64_t index) const {
        fail(line,
             fmt::format("vertex index {} out of range: the file has {} vertices", index, mesh_.positions.size()));
    }

    // The next token of a line, which goes on behind a backslash at its end.
    std::string_view token() {
        std::string_view found = scanner_.token();
        while (!found.empty() && found.back() == '\\') {
            scanner_.take_line();
            found.remove_suffix(1);
            if (!found.empty() || scanner_.at_end()) break;
            found = scanner_.token();
        }
        return found;
    }

    // The rest of the line, which may have blanks inside.
    std::string name() {
        std::string_view rest = scanner_.rest();
        rest = rest.substr(0, rest.find_first_of("\r\n"));
        const std::size_t first = rest.find_first_not_of(" \t"), last = rest.find_last_not_of(" \t");
        return std::string(first == std::string_view::npos ? std::string_view() : rest.substr(first, last + 1 - first));
    }

    void read_vertex() {
        glm::dvec3 position(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view coordinate = token();
            const auto value = parse_double(coordinate);
            position[axis] = value.value_or(0.0);
            if (!value || !std::isfinite(static_cast<float>(position[axis]))) {
                fail(scanner_.line(), fmt::format("expected 3 finite coordinates, got \"{}\"", printable(coordinate)));
            }
        }
        if (mesh_.positions.size() >= std::numeric_limits<std::uint32_t>::max()) {
            fail(scanner_.line(), "more vertices than 32-bit indices can count");
        }
        mesh_.positions.push_back(position);
    }

    // What is no pair of finite numbers makes the mesh one without texture coordinates.
    void read_uv() {
        const auto u = parse_double(token());
        const std::string_view second = token();
        const auto v = second.empty() ? 0.0 : parse_double(second);  // a single coordinate stands for (u, 0)
        const glm::dvec2 uv(u.value_or(NAN), 1.0 - v.value_or(NAN));
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
            drop_uv(scanner_.line(), "expected two finite texture coordinates");
        uvs_.push_back(uv);
    }

    void read_face() {
        const std::int64_t line = scanner_.line();
        const std::size_t first_triangle = mesh_.triangles.size();
        glm::uvec3 triangle(0);
        std::array<std::uint32_t, 3> uvs{};
        int corners = 0;
        for (std::string_view corner = token(); !corner.empty(); corner = token()) {
            if (corner.front() == '#') break;
            const std::uint32_t index = read_index(corner), uv = read_uv_index(corner);
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
        if (corners < 3) fail(line, fmt::format("expected a face of 3 or more vertices, got {}", corners));
        const std::size_t triangles = mesh_.triangles.size() - first_triangle;
        if (triangles > 1) fans_.push_back({first_triangle, triangles, line});
        take_material(triangles);
    }

    void take_group(std::size_t triangles) {
        if (groups_.empty() || groups_[group_] != group_name_) {
            const auto found = std::find(groups_.begin(), groups_.end(), group_name_);
            group_ = static_cast<std::size_t>(found - groups_.begin());
            if (found == groups_.end()) groups_.push_back(group_name_);
        }
        group_of_.insert(group_of_.end(), triangles, static_cast<std::uint32_t>(group_));
    }

    std::size_t separate_groups() const {
        std::vector<std::uint32_t> parent(groups_.size());
        std::iota(parent.begin(), parent.end(), 0u);
        const auto root = [&](std::uint32_t g) {
            while (parent[g] != g) g = parent[g];
            return g;
        };
        std::vector<std::uint32_t> of_vertex(groups_.size() > 1 ? mesh_.positions.size() : 0, no_group);
        for (std::size_t i = 0; i < mesh_.triangles.size() && !of_vertex.empty(); ++i)
            for (int k = 0; k < 3; ++k) {
                std::uint32_t& of = of_vertex[mesh_.triangles[i][k]];
                if (of != no_group) parent[root(of)] = root(group_of_[i]);
                of = group_of_[i];
            }
        std::size_t separate = 0;
        for (std::uint32_t g = 0; g < parent.size(); ++g) separate += parent[g] == g ? 1 : 0;
        return separate;
    }

    void take_material(std::size_t triangles) {
        take_group(triangles);
        if (object_) ++mesh_.objects;
        object_ = false;
        if (mesh_.materials.empty() || mesh_.materials[material_] != material_name_) {
            const auto found = std::find(mesh_.materials.begin(), mesh_.materials.end(), material_name_);
            material_ = static_cast<std::size_t>(found - mesh_.materials.begin());
            if (found == mesh_.materials.end()) mesh_.materials.push_back(material_name_);
        }
        mesh_.material.insert(mesh_.material.end(), triangles, static_cast<std::uint32_t>(material_));
    }

    void finish_uv() {
        if (largest_uv_ != no_uv && largest_uv_ >= static_cast<std::int64_t>(uvs_.size()))
            drop_uv(largest_uv_line_, fmt::format("texture coordinate {} of {}", largest_uv_ + 1, uvs_.size()));
        if (uvs_.empty()) mesh_.uv_fault.clear();
        if (largest_uv_ != no_uv)
            for (const auto& t : uv_triangles_) mesh_.uv.push_back({uvs_[t[0]], uvs_[t[1]], uvs_[t[2]]});
    }

    void finish_polygons() {
        const std::vector<std::int64_t> crossing = cut_polygons(mesh_, fans_);
        if (crossing.empty()) return;
        mesh_.remarks.push_back(crossing_remark(fmt::format("{}:{}", file_, crossing.front()), crossing.size()));
    }

    // "7", "7/1", "7//3", "7/1/3" or, counted back from the last vertex, "-2".
    std::uint32_t read_index(std::string_view token) {
        const auto number = parse_integer(token.substr(0, token.find('/')));
        if (!number || *number == 0) {
            fail(scanner_.line(), fmt::format("expected a vertex index, got \"{}\"", printable(token)));
        }
        const auto count = static_cast<std::int64_t>(mesh_.positions.size());
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

    static constexpr std::uint32_t no_group = std::numeric_limits<std::uint32_t>::max();
    static constexpr std::int64_t no_uv = std::numeric_limits<std::int64_t>::max();

    TextScanner scanner_;
    const std::string& file_;
    FileMesh mesh_;
    std::vector<FanOfMesh> fans_;  // of the polygons
    std::string material_name_;    // of the faces that follow
    std::size_t material_ = 0;     // its index, once a face had it
    bool object_ = false;          // one began that has no face yet
    std::string group_name_;       // of the faces that follow
    std::size_t group_ = 0;        // its index, once a face had it
    std::vector<std::string> groups_;
    std::vector<std::uint32_t> group_of_;  // of each triangle
    std::int64_t free_forms_ = 0, free_form_line_ = 0;
    std::vector<glm::dvec2> uvs_;
    std::vector<std::array<std::uint32_t, 3>> uv_triangles_;  // indices of uvs_, until one is missing
    std::int64_t largest_uv_line_ = 0;
    std::int64_t largest_uv_ = -1;     // no_uv: the mesh has no texture coordinates
    std::int64_t largest_index_ = -1;  // a face may come before its vertices, so this is checked at the end
    std::int64_t largest_index_line_ = 0;
};

}  // namespace

FileMesh parse_obj(std::string_view text, const std::string& file) {
    text = without_mark(text, file);
    if (!has_lone_returns(text)) return ObjParser(text, file).parse();
    std::string mended(text);
    mend_line_ends(mended, mended.size());
    return ObjParser(mended, file).parse();
}

}  // namespace stokes
