#include "host/scene/readers/mask.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/error.hpp"

namespace stokes {
namespace {

// x in texels, z in half texels.
struct Rectangle {
    int x0, x1;
    int z0, z1;
};

using Rectangles = std::vector<Rectangle>;

class Sweep {
  public:
    Sweep(const Picture& picture, const MaskTexels& texels) : picture_(picture), texels_(texels) {}

    Rectangles rectangles() {
        for (int row = 0; row < picture_.height; ++row) take_row(row);
        finish(above_);
        return std::move(done_);
    }

  private:
    bool is_opaque(std::size_t texel) const {
        const float luminance = picture_.luminance_over(texels_.invert ? 0.0f : 1.0f, texel);
        return (static_cast<double>(luminance) < texels_.threshold) != texels_.invert;
    }

    Rectangles runs_of(int row) const {
        Rectangles runs;
        const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(picture_.width);
        bool within = false;
        for (int x = 0; x < picture_.width; ++x) {
            const bool opaque = is_opaque(first + static_cast<std::size_t>(x));
            if (opaque && !within) runs.push_back({x, x, 2 * row, 2 * row + 2});
            if (opaque) runs.back().x1 = x + 1;
            within = opaque;
        }
        return runs;
    }

    // Joins the row's runs to the rectangles that end above it; both are in order of x and do not overlap.
    void take_row(int row) {
        Rectangles runs = runs_of(row);
        std::vector<bool> goes_on(above_.size(), false);
        std::size_t a = 0, b = 0;
        while (a < above_.size() && b < runs.size()) {
            if (above_[a].x0 < runs[b].x1 && runs[b].x0 < above_[a].x1) goes_on[a] = join(above_[a], runs[b], 2 * row);
            if (above_[a].x1 < runs[b].x1)
                ++a;
            else
                ++b;
        }
        Rectangles ended;
        for (std::size_t i = 0; i < above_.size(); ++i)
            if (!goes_on[i]) ended.push_back(above_[i]);
        finish(ended);
        above_ = std::move(runs);
    }

    // seam: where they meet. True where the run continues the rectangle.
    bool join(Rectangle& above, Rectangle& run, int seam) {
        if (above.x0 == run.x0 && above.x1 == run.x1) {
            run.z0 = above.z0;
            return true;
        }
        if (above.x0 >= run.x0 && above.x1 <= run.x1)
            above.z1 = seam + 1;
        else if (run.x0 >= above.x0 && run.x1 <= above.x1)
            run.z0 = seam - 1;
        else
            finish({{std::max(above.x0, run.x0), std::min(above.x1, run.x1), seam - 1, seam + 1}});
        return false;
    }

    void finish(const Rectangles& rectangles) {
        done_.insert(done_.end(), rectangles.begin(), rectangles.end());
        if (2 * done_.size() > most_mask_triangles)
            throw InputError(fmt::format("expected a picture of fewer edges: its mask has more than {} triangles",
                                         most_mask_triangles));
    }

    const Picture& picture_;
    const MaskTexels& texels_;
    Rectangles above_;  // those that end at the row before, which may go on
    Rectangles done_;
};

}  // namespace

Mesh make_mask(const Picture& picture, double width_mm, double height_mm, const MaskTexels& texels) {
    const Rectangles rectangles = Sweep(picture, texels).rectangles();
    if (rectangles.empty()) throw InputError("expected a picture with an opaque texel, found none");
    Mesh mesh;
    mesh.positions_mm.reserve(4 * rectangles.size());
    mesh.triangles.reserve(2 * rectangles.size());
    const auto x_mm = [&](int texels_along) {
        return static_cast<float>(width_mm * (static_cast<double>(texels_along) / picture.width - 0.5));
    };
    const auto z_mm = [&](int half_texels_down) {
        return static_cast<float>(height_mm * (0.5 * half_texels_down / picture.height - 0.5));
    };
    for (const Rectangle& r : rectangles) {
        const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
        const float x0 = x_mm(r.x0), x1 = x_mm(r.x1), z0 = z_mm(r.z0), z1 = z_mm(r.z1);
        mesh.positions_mm.insert(mesh.positions_mm.end(), {{x0, 0, z0}, {x0, 0, z1}, {x1, 0, z1}, {x1, 0, z0}});
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    }
    return mesh;
}

}  // namespace stokes
