// Shapes on their way into a scene: in double precision until the scene's origin is known.
#pragma once

#include <string>
#include <vector>

#include "host/core/json_cursor.hpp"
#include "host/scene/mesh/file_mesh.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

class Placement {
  public:
    // Appends a shape, whose mesh transform brings to its place. Returns the index that it will have in the scene.
    int add(const JsonCursor& where, Shape shape, FileMesh mesh, const glm::dmat4& transform, bool from_file = false);
    int add(const JsonCursor& where, Shape shape, const Mesh& mesh, const glm::dmat4& transform);

    // Chooses Scene::origin_mm, moves camera and beams, and appends the shapes to the scene, rounded to single
    // precision about the origin. Drops triangles without area, there or already before, and turns closed meshes of
    // files over that face inward, with warnings, and warns of those that show the camera their back. Throws InputError
    // at the shape when no triangle is left, when a coordinate is not finite or too large, or when its material has a
    // texture and the mesh no uv.
    void settle(const JsonCursor& root, Scene& scene);

  private:
    struct Placed {
        JsonCursor where;
        Shape shape;  // all but its mesh
        FileMesh mesh;
        glm::dmat4 transform;
        bool from_file;
    };

    void move_to_origin(Placed& placed, Scene& scene) const;
    void settle_reversed_twins(const Placed& placed, Shape& shape, const Material& material) const;
    std::vector<int> orientation_groups(Scene& scene) const;
    void turn_inside_out(Scene& scene) const;

    std::vector<Placed> shapes_;
};

}  // namespace stokes
