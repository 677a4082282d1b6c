#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "host/core/error.hpp"
#include "host/scene/readers/mesh_reader.hpp"
#include "host/scene/readers/mesh_text.hpp"
#include "host/scene/readers/ply_header.hpp"
#include "host/scene/readers/ply_source.hpp"

namespace stokes {
namespace {

template <typename Source>
class PlyBody {
  public:
    PlyBody(const PlyHeader& header, Source source, const std::string& file)
        : header_(header), source_(source), file_(file) {}

    FileMesh parse() {
        std::size_t read = 0;
        for (; read < header_.elements.size() && !(have_vertices_ && have_faces_); ++read) {
            element_ = &header_.elements[read];
            require_room();
            if (element_->name == "vertex") {
                read_vertices();
            } else if (element_->name == "face") {
                read_faces();
            } else {
                skip_records();
            }
        }
        check_indices();
        remark_on_the_rest(read);
        finish_uv();
        if (const auto crossing = cut_polygons(mesh_, fans_); !crossing.empty())
            mesh_.remarks.push_back(
                crossing_remark(fmt::format("{}: face {}", file_, crossing.front()), crossing.size()));
        if (pictures_.size() > 1)
            mesh_.remarks.push_back(fmt::format(
                "{}: its faces have {} pictures (texnumber); a texture lies on all of them", file_, pictures_.size()));
        if (materials_.size() > 1)
            mesh_.remarks.push_back(
                fmt::format("{}: its faces have {} materials (material_index), which are not told apart", file_,
                            materials_.size()));
        return std::move(mesh_);
    }

  private:
    // What the file has beside vertices and faces. read: elements that were read so far.
    void remark_on_the_rest(std::size_t read) {
        for (const PlyElement& element : header_.elements) {
            const bool has_faces = element.property("vertex_indices") >= 0 || element.property("vertex_index") >= 0;
            if (element.count > 0 && element.name != "vertex" && element.name != "face" && has_faces)
                mesh_.remarks.push_back(
                    fmt::format("{}: its element {} is not read, only faces", file_, printable(element.name)));
        }
        try {
            for (; read < header_.elements.size(); ++read) {
                element_ = &header_.elements[read];
                require_room();
                skip_records();
            }
            if (source_.has_more())
                mesh_.remarks.push_back(file_ + ": it goes on after all that its header promises, which is not read");
        } catch (const InputError& error) {
            mesh_.remarks.emplace_back(error.what());
        }
    }

    [[noreturn]] void fail(const std::string& what) const {
        const std::string record = fmt::format("{} {}: ", printable(element_->name), record_);
        throw InputError(source_.place(file_, record + what));
    }

    // A count that the rest of the file cannot hold must not decide how much memory is taken.
    void require_room() const {
        if (element_->count == 0) return;
        const auto room = (source_.bytes_left() + 1) / element_->least_size(header_.format);
        if (static_cast<std::uint64_t>(element_->count) <= room) return;
        throw InputError(fmt::format("{}: the header promises {} of element {}, but the file is too short for them",
                                     file_, element_->count, printable(element_->name)));
    }

    double take(PlyType type) {
        double value = 0.0;
        if (!source_.take(type, value)) fail("expected a number, got " + source_.got());
        return value;
    }

    std::int64_t take_length(const PlyProperty& list) {
        const double length = take(list.count_type);
        if (length < 0.0) fail(fmt::format("a list of length {}", length));
        return static_cast<std::int64_t>(length);
    }

    void skip(const PlyProperty& property) {
        std::int64_t values = property.is_list ? take_length(property) : 1;
        for (; values > 0; --values) take(property.type);
    }

    void skip_records() {
        for (record_ = 0; record_ < element_->count; ++record_) {
            for (const PlyProperty& property : element_->properties) skip(property);
        }
    }

    void read_vertices() {
        if (have_vertices_) throw InputError(file_ + ": element vertex given twice");
        have_vertices_ = true;
        const int axes[3] = {element_->property("x"), element_->property("y"), element_->property("z")};
        for (const int axis : axes) {
            if (axis < 0 || element_->properties[static_cast<std::size_t>(axis)].is_list) {
                throw InputError(file_ + ": element vertex: expected the properties x, y and z");
            }
        }
        if (element_->count >= std::numeric_limits<std::uint32_t>::max()) {
            throw InputError(file_ + ": more vertices than 32-bit indices can count");
        }
        const auto [u, v] = uv_properties();
        const int properties[5] = {axes[0], axes[1], axes[2], u, v};
        mesh_.positions.reserve(static_cast<std::size_t>(element_->count));
        if (u >= 0) uvs_.reserve(static_cast<std::size_t>(element_->count));
        for (record_ = 0; record_ < element_->count; ++record_) take_vertex(properties);
        for (const int axis : axes)
            if (element_->properties[static_cast<std::size_t>(axis)].type == PlyType::float32)
                return remark_on_steps(mesh_, file_);
    }

    // Indices of the texture coordinates; -1 without them.
    std::pair<int, int> uv_properties() const {
        const auto number = [&](const char* name) {
            const int i = element_->property(name);
            return i < 0 || element_->properties[static_cast<std::size_t>(i)].is_list ? -1 : i;
        };
        for (const auto& [u, v] : {std::pair("u", "v"), std::pair("s", "t"), std::pair("texture_u", "texture_v")})
            if (number(u) >= 0 && number(v) >= 0) return {number(u), number(v)};
        return {-1, -1};
    }

    // wanted: which properties are x, y, z, u and v.
    void take_vertex(const int (&wanted)[5]) {
        double values[5] = {};
        for (int i = 0; i < static_cast<int>(element_->properties.size()); ++i) {
            const PlyProperty& property = element_->properties[static_cast<std::size_t>(i)];
            const auto* found = std::find(wanted, wanted + 5, i);
            if (found == wanted + 5) {
                skip(property);
                continue;
            }
            const double value = take(property.type);
            const bool is_uv = found - wanted >= 3, is_finite = std::isfinite(static_cast<float>(value));
            if (!is_finite && !is_uv) fail("expected finite coordinates");
            if (!is_finite) drop(vertex_uv_, "expected finite texture coordinates");
            values[found - wanted] = value;
        }
        mesh_.positions.emplace_back(values[0], values[1], values[2]);
        if (wanted[3] >= 0) uvs_.emplace_back(values[3], 1.0 - values[4]);
    }

    void read_faces() {
        if (have_faces_) throw InputError(file_ + ": element face given twice");
        have_faces_ = true;
        const auto list_of = [&](const char* name) {
            const int i = element_->property(name);
            return i >= 0 && element_->properties[static_cast<std::size_t>(i)].is_list ? i : -1;
        };
        const int indices = std::max(list_of("vertex_indices"), list_of("vertex_index"));
        const int uvs = std::max(list_of("texcoord"), list_of("texcoords"));
        const int picture = element_->property("texnumber"), material = element_->property("material_index");
        if (indices < 0) throw InputError(file_ + ": element face: expected a list property vertex_indices");
        corner_uv_.there = uvs >= 0;
        mesh_.triangles.reserve(static_cast<std::size_t>(element_->count));
        for (record_ = 0; record_ < element_->count; ++record_) {
            const std::size_t first_triangle = mesh_.triangles.size();
            for (int i = 0; i < static_cast<int>(element_->properties.size()); ++i) {
                const PlyProperty& property = element_->properties[static_cast<std::size_t>(i)];
                if (i == indices) {
                    take_face(property);
                } else if (i == uvs) {
                    take_corner_uvs(property);
                } else if (i == picture && !property.is_list) {
                    note_number(pictures_, take(property.type));
                } else if (i == material && !property.is_list) {
                    note_number(materials_, take(property.type));
                } else {
                    skip(property);
                }
            }
            if (corner_uv_.there) place_corner_uvs(mesh_.triangles.size() - first_triangle);
        }
    }

    void take_face(const PlyProperty& list) {
        const std::int64_t corners = take_length(list);
        if (corners < 3) fail(fmt::format("expected 3 or more vertices, got {}", corners));
        const std::size_t first_triangle = mesh_.triangles.size();
        const std::uint32_t first = take_index(list.type);
        std::uint32_t before = take_index(list.type);
        for (std::int64_t k = 2; k < corners; ++k) {
            const std::uint32_t index = take_index(list.type);
            mesh_.triangles.push_back({first, before, index});
            before = index;
        }
        if (corners > 3) fans_.push_back({first_triangle, mesh_.triangles.size() - first_triangle, record_});
    }

    void take_corner_uvs(const PlyProperty& list) {
        face_uvs_.clear();
        for (std::int64_t left = take_length(list); left > 0; --left) face_uvs_.push_back(take(list.type));
    }

    // Of a face that has become this many triangles, as a fan.
    void place_corner_uvs(std::size_t triangles) {
        const std::size_t corners = triangles + 2;
        if (face_uvs_.size() != 2 * corners)
            drop(corner_uv_, fmt::format("expected 2 texture coordinates for each of {} corners, got {}", corners,
                                         face_uvs_.size()));
        const auto is_finite = [](double x) { return std::isfinite(static_cast<float>(x)); };
        if (!std::all_of(face_uvs_.begin(), face_uvs_.end(), is_finite))
            drop(corner_uv_, "expected finite texture coordinates");
        if (!corner_uv_.there) return;
        const auto corner = [&](std::size_t k) { return glm::dvec2(face_uvs_[2 * k], 1.0 - face_uvs_[2 * k + 1]); };
        for (std::size_t k = 2; k < corners; ++k) mesh_.uv.push_back({corner(0), corner(k - 1), corner(k)});
    }

    // Of a picture or a material; faces without one have -1.
    static void note_number(std::vector<double>& known, double number) {
        const bool is_new = std::find(known.begin(), known.end(), number) == known.end();
        if (number >= 0.0 && is_new && known.size() < 1000) known.push_back(number);
    }

    std::uint32_t take_index(PlyType type) {
        const double index = take(type);
        const double limit = have_vertices_ ? static_cast<double>(mesh_.positions.size()) : 4294967295.0;
        if (index >= 0.0 && index < limit && index == std::floor(index)) return static_cast<std::uint32_t>(index);
        fail(fmt::format("vertex index {} out of range", index));
    }

    // Texture coordinates that are in the file and can be used.
    struct UvSource {
        bool there = true;
    };

    // The first reason is kept.
    void drop(UvSource& source, const std::string& reason) {
        source.there = false;
        if (!mesh_.uv_fault.empty()) return;
        mesh_.uv_fault = source_.place(file_, fmt::format("{} {}: {}", element_->name, record_, reason));
    }

    // Those of the corners go before those of the vertices.
    void finish_uv() {
        if (corner_uv_.there && !mesh_.uv.empty()) return mesh_.uv_fault.clear();
        mesh_.uv.clear();
        if (!vertex_uv_.there || uvs_.empty()) return;
        mesh_.uv_fault.clear();
        for (const glm::uvec3& t : mesh_.triangles) mesh_.uv.push_back({uvs_[t.x], uvs_[t.y], uvs_[t.z]});
    }

    // For faces that came before their vertices.
    void check_indices() const {
        if (mesh_.triangles.empty()) throw InputError(file_ + no_triangles());
        const std::size_t count = mesh_.positions.size();
        for (const glm::uvec3& t : mesh_.triangles) {
            const std::uint32_t largest = std::max({t.x, t.y, t.z});
            if (largest < count) continue;
            throw InputError(
                fmt::format("{}: vertex index {} out of range: the file has {} vertices", file_, largest, count));
        }
    }

    std::string no_triangles() const {
        for (const PlyElement& element : header_.elements)
            if (element.name == "tristrips") return ": no triangles but strips, which are not read";
        return mesh_.positions.empty() ? ": no triangles" : ": no triangles, only points";
    }

    const PlyHeader& header_;
    Source source_;
    const std::string& file_;
    const PlyElement* element_ = nullptr;
    std::int64_t record_ = 0;
    bool have_vertices_ = false;
    bool have_faces_ = false;
    FileMesh mesh_;
    std::vector<FanOfMesh> fans_;               // of the polygons
    std::vector<glm::dvec2> uvs_;               // of the vertices, where they have texture coordinates
    std::vector<double> face_uvs_;              // of the corners of one face
    std::vector<double> pictures_, materials_;  // numbers of those that faces have
    UvSource vertex_uv_, corner_uv_;
};

}  // namespace

FileMesh parse_ply(std::string_view text, const std::string& file) {
    text = without_mark(text, file);
    // Where the first line ends in a carriage return alone, all of the header does, and the body of an ascii file.
    std::string mended;
    const bool lone_returns = text.substr(0, 4) == "ply\r" && text.substr(0, 5) != "ply\r\n";
    if (lone_returns) {
        mended = text;
        const std::size_t end = text.find("\rend_header\r");
        mend_line_ends(mended, end == std::string_view::npos ? text.size() : end + 1);
        if (end != std::string_view::npos) mended[end + 11] = '\n';
        text = mended;
    }
    TextScanner scanner(text);
    const PlyHeader header = read_ply_header(scanner, file);
    if (header.format == PlyFormat::ascii) {
        if (lone_returns) mend_line_ends(mended, mended.size());
        return PlyBody<AsciiSource>(header, AsciiSource(scanner), file).parse();
    }
    const BinarySource source(scanner, header.format == PlyFormat::big_endian);
    return PlyBody<BinarySource>(header, source, file).parse();
}

}  // namespace stokes
