// Masks: thin sheets that let light pass where a picture says so.
#pragma once

#include "host/scene/readers/picture.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

inline constexpr std::size_t most_mask_triangles = 2'000'000;

struct MaskTexels {
    double threshold = 0.5;  // linear luminance
    bool invert = false;     // false: opaque below the threshold; true: opaque from the threshold on
};

// The opaque texels of a picture as a sheet in the plane y = 0: width along x, height along z, the picture's
// top left corner at -x and -z, so that it stands upright seen from above with -z away from the viewer.
// Transparent parts of the picture are open. Runs of opaque texels of equal ends in consecutive rows are one
// rectangle of two triangles. Where runs of unequal ends meet, one reaches half a texel into the other, or a
// rectangle of their common width bridges them: so a ray that meets an opaque texel meets the inside of a
// rectangle, and none slips between two. Nothing covers an open texel. Throws InputError, without a file
// name, where no texel is opaque or more than most_mask_triangles are needed.
Mesh make_mask(const Picture& picture, double width_mm, double height_mm, const MaskTexels& texels);

}  // namespace stokes
