#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>

#include "host/core/error.hpp"
#include "host/scene/readers/mesh_reader.hpp"
#include "host/scene/readers/ply_header.hpp"

namespace stokes {
namespace {

// Values of an ascii body, one token each.
class AsciiSource {
  public:
    explicit AsciiSource(const TextScanner& body) : scanner_(body) {}

    std::size_t bytes_left() const { return scanner_.rest().size(); }
    std::string place(const std::string& file, const std::string& record) const {
        return fmt::format("{}:{}: {}", file, scanner_.line(), record);
    }
    // False: no such value here.
    bool take(PlyType type, double& value) {
        token_ = scanner_.token_across_lines();
        if (type == PlyType::float32 || type == PlyType::float64) {
            const auto number = parse_double(token_);
            value = number.value_or(0.0);
            return number.has_value();
        }
        const auto number = parse_integer(token_);
        value = static_cast<double>(number.value_or(0));
        return number.has_value();
    }
    std::string got() const { return token_.empty() ? "the end of the file" : '"' + printable(token_) + '"'; }

  private:
    TextScanner scanner_;
    std::string_view token_;
};

// Values of a binary body. A double holds each of the types exactly.
class BinarySource {
  public:
    BinarySource(const TextScanner& body, bool big_endian) : rest_(body.rest()), big_endian_(big_endian) {}

    std::size_t bytes_left() const { return rest_.size(); }
    std::string place(const std::string& file, const std::string& record) const { return file + ": " + record; }
    bool take(PlyType type, double& value) {
        switch (type) {
            case PlyType::int8:
                return take_as<std::int8_t>(value);
            case PlyType::uint8:
                return take_as<std::uint8_t>(value);
            case PlyType::int16:
                return take_as<std::int16_t>(value);
            case PlyType::uint16:
                return take_as<std::uint16_t>(value);
            case PlyType::int32:
                return take_as<std::int32_t>(value);
            case PlyType::uint32:
                return take_as<std::uint32_t>(value);
            case PlyType::float32:
                return take_as<float>(value);
            case PlyType::float64:
                break;
        }
        return take_as<double>(value);
    }
    std::string got() const { return "the end of the file"; }

  private:
    template <typename T>
    bool take_as(double& value) {
        if (rest_.size() < sizeof(T)) return false;
        char bytes[sizeof(T)];
        std::memcpy(bytes, rest_.data(), sizeof bytes);
        if (big_endian_) std::reverse(std::begin(bytes), std::end(bytes));
        T typed;
        std::memcpy(&typed, bytes, sizeof bytes);
        rest_.remove_prefix(sizeof bytes);
        value = static_cast<double>(typed);
        return true;
    }

    std::string_view rest_;
    bool big_endian_;
};

template <typename Source>
class PlyBody {
  public:
    PlyBody(const PlyHeader& header, Source source, const std::string& file)
        : header_(header), source_(source), file_(file) {}

    Mesh parse() {
        for (const PlyElement& element : header_.elements) {
            if (have_vertices_ && have_faces_) break;
            element_ = &element;
            require_room();
            if (element.name == "vertex") {
                read_vertices();
            } else if (element.name == "face") {
                read_faces();
            } else {
                skip_records();
            }
        }
        check_indices();
        if (has_uv_ && !uvs_.empty())
            for (const glm::uvec3& t : mesh_.triangles) mesh_.uv.push_back({uvs_[t.x], uvs_[t.y], uvs_[t.z]});
        return std::move(mesh_);
    }

  private:
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
        mesh_.positions_mm.reserve(static_cast<std::size_t>(element_->count));
        if (u >= 0) uvs_.reserve(static_cast<std::size_t>(element_->count));
        for (record_ = 0; record_ < element_->count; ++record_) take_vertex(properties);
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
        float values[5] = {};
        for (int i = 0; i < static_cast<int>(element_->properties.size()); ++i) {
            const PlyProperty& property = element_->properties[static_cast<std::size_t>(i)];
            const auto* found = std::find(wanted, wanted + 5, i);
            if (found == wanted + 5) {
                skip(property);
                continue;
            }
            const auto value = static_cast<float>(take(property.type));
            const bool is_uv = found - wanted >= 3;
            if (!std::isfinite(value) && !is_uv) fail("expected finite coordinates");
            if (!std::isfinite(value)) {
                has_uv_ = false;
                mesh_.uv_fault =
                    fmt::format("{}: vertex {}: expected finite texture coordinates", file_, mesh_.positions_mm.size());
            }
            values[found - wanted] = value;
        }
        mesh_.positions_mm.emplace_back(values[0], values[1], values[2]);
        if (wanted[3] >= 0) uvs_.emplace_back(values[3], 1.0f - values[4]);
    }

    void read_faces() {
        if (have_faces_) throw InputError(file_ + ": element face given twice");
        have_faces_ = true;
        const int plural = element_->property("vertex_indices");
        const int list = plural >= 0 ? plural : element_->property("vertex_index");
        if (list < 0 || !element_->properties[static_cast<std::size_t>(list)].is_list) {
            throw InputError(file_ + ": element face: expected a list property vertex_indices");
        }
        mesh_.triangles.reserve(static_cast<std::size_t>(element_->count));
        for (record_ = 0; record_ < element_->count; ++record_) {
            for (int i = 0; i < static_cast<int>(element_->properties.size()); ++i) {
                const PlyProperty& property = element_->properties[static_cast<std::size_t>(i)];
                if (i == list) {
                    take_face(property);
                } else {
                    skip(property);
                }
            }
        }
    }

    void take_face(const PlyProperty& list) {
        const std::int64_t corners = take_length(list);
        if (corners < 3) fail(fmt::format("expected 3 or more vertices, got {}", corners));
        const std::uint32_t first = take_index(list.type);
        std::uint32_t before = take_index(list.type);
        for (std::int64_t k = 2; k < corners; ++k) {
            const std::uint32_t index = take_index(list.type);
            mesh_.triangles.push_back({first, before, index});
            before = index;
        }
    }

    std::uint32_t take_index(PlyType type) {
        const double index = take(type);
        const double limit = have_vertices_ ? static_cast<double>(mesh_.positions_mm.size()) : 4294967295.0;
        if (index >= 0.0 && index < limit && index == std::floor(index)) return static_cast<std::uint32_t>(index);
        fail(fmt::format("vertex index {} out of range", index));
    }

    // For faces that came before their vertices.
    void check_indices() const {
        if (mesh_.triangles.empty()) throw InputError(file_ + ": no triangles");
        const std::size_t count = mesh_.positions_mm.size();
        for (const glm::uvec3& t : mesh_.triangles) {
            const std::uint32_t largest = std::max({t.x, t.y, t.z});
            if (largest < count) continue;
            throw InputError(
                fmt::format("{}: vertex index {} out of range: the file has {} vertices", file_, largest, count));
        }
    }

    const PlyHeader& header_;
    Source source_;
    const std::string& file_;
    const PlyElement* element_ = nullptr;
    std::int64_t record_ = 0;
    bool have_vertices_ = false;
    bool have_faces_ = false;
    Mesh mesh_;
    std::vector<glm::vec2> uvs_;  // of the vertices, where they have texture coordinates
    bool has_uv_ = true;          // false: one of them is no number
};

}  // namespace

Mesh parse_ply(std::string_view text, const std::string& file) {
    TextScanner scanner(text);
    const PlyHeader header = read_ply_header(scanner, file);
    if (header.format == PlyFormat::ascii) {
        return PlyBody<AsciiSource>(header, AsciiSource(scanner), file).parse();
    }
    const BinarySource source(scanner, header.format == PlyFormat::big_endian);
    return PlyBody<BinarySource>(header, source, file).parse();
}

Mesh read_mesh(const std::string& path) {
    const std::string ending = path.size() < 4 ? std::string() : path.substr(path.size() - 4);
    if (ending == ".ply") return parse_ply(read_file(path), path);
    if (ending == ".obj") return parse_obj(read_file(path), path);
    throw InputError(path + ": expected a mesh file that ends in .ply or .obj");
}

}  // namespace stokes
