// Which way round the triangles of a body are.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

struct Orientation {
    std::size_t turned = 0;        // triangles
    std::size_t inconsistent = 0;  // edges whose two triangles face opposite sides
    glm::dvec3 place_mm{0.0};      // the middle of one of them
};

// Turns over the closed parts of a body that face inward, with all that lies within them; a cavity within a part that
// faces outward is left, and so is what has the eye inside. A part is what hangs together by edges of two triangles; it
// is closed where triangles pass each of its edges in both directions equally often, and faces inward where the volume
// within is negative. Vertices in the same place are one.
Orientation turn_outward(const std::vector<Mesh*>& meshes, const glm::dvec3& eye_mm);

// Whether triangles pass each edge of the body in both directions equally often.
bool is_closed(const std::vector<Mesh*>& meshes);

// Where every triangle has one in the same place that faces the other way, keeps one of each such two, if it may. Else
// paired: the triangles of sheets that have another one so; not those between solids that stand side by side.
struct Pairs {
    bool dropped = false;
    std::size_t paired = 0;
};
Pairs drop_reversed_twins(Mesh& mesh, bool may_drop);

}  // namespace stokes
