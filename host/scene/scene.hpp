// The scene as plain data, already checked, in world space. Lengths are millimetres, wavelengths nanometres.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/core/spectrum.hpp"
#include "host/scene/readers/picture.hpp"
#include "host/scene/settings/render_settings.hpp"

namespace stokes {

// A window of the picture, in fractions of its width and height from the top left corner.
struct Crop {
    double left = 0.0, top = 0.0;
    double width = 1.0, height = 1.0;
};

struct Camera {  // pinhole
    glm::dvec3 position_mm{0.0};
    glm::dvec3 target_mm{0.0, 0.0, -1.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    double vertical_fov_deg = 40.0;  // of the whole picture
    Crop crop;                       // what the film shows of it
};

struct Film {
    int width = 512;                    // pixels
    int height = 512;                   // pixels
    std::optional<double> exposure_ev;  // of the PNG; none: automatic
};

// sigma_s and sigma_a [1/mm] with the scene's scale factors already applied.
struct Medium {
    std::string name;
    Spectrum sigma_s;
    Spectrum sigma_a;
    double eta = 1.0;         // refractive index
    double dipole_eta = 1.0;  // refractive index in the dipole's A; 1 where the Fresnel factor is taken as 1
};

struct Fluorophore {
    std::string name;
    Spectrum excitation;         // relative
    Spectrum emission;           // relative
    double conversion = 2.0e-2;  // paper: eta of eq. 1 [1/nm]
    double quantum_yield = 1.0;  // conserving, walk: photons emitted for each taken up, in [0, 1]
};

enum class MaterialKind { black, diffuse, translucent };

struct Material {
    std::string name;
    MaterialKind kind = MaterialKind::black;
    Spectrum reflectance = Spectrum::constant(0.0);  // diffuse: in [0, 1]
    // diffuse: a picture without opacity; reflectance + luminance (white - reflectance) where it lies; or
    // none
    std::shared_ptr<const Picture> texture;
    Spectrum white = Spectrum::constant(0.0);  // in [0, 1]
    int medium = -1;                           // translucent with subsurface: index into Scene::media
    int fluorophore = -1;                      // translucent: index into Scene::fluorophores, -1: none
    double fluorescent_fraction = 0.0;         // c in [0, 1]
    bool subsurface = true;                    // false: surface fluorescence, light leaves where it came in
    bool fresnel = false;  // the surface reflects, outside and within; conserving, walk, with subsurface only
};

struct Mesh {
    std::vector<glm::vec3> positions_mm;
    std::vector<glm::uvec3> triangles;  // counter-clockwise seen from outside
    // Of each triangle's corners, the picture's top left corner at (0, 0), bottom right at (1, 1); empty:
    // none.
    std::vector<std::array<glm::vec2, 3>> uv = {};
    std::string uv_fault =
        {};  // why the texture coordinates of its file cannot be used; empty: they can, or there are none
};

// Shapes with the same body exchange light below their surfaces: an exit point may lie on any of them.
struct Shape {
    std::string name;
    int material = -1;
    int body = -1;
    int light = -1;          // index into Scene::lights when this shape is the surface of an emitter
    bool two_sided = false;  // the back is like the front, else black; opaque materials only
    Mesh mesh;
};

enum class LightKind { beam, surface };
enum class BeamSection { disk, rectangle };

struct Light {
    std::string name;
    LightKind kind = LightKind::surface;
    Spectrum flux;  // absolute spectral flux [W/nm], over the whole light
    // surface: one-sided diffuse emission from the front of this shape
    int shape = -1;
    // beam: parallel light through a flat cross-section at right angles to direction
    BeamSection section = BeamSection::disk;
    glm::dvec3 position_mm{0.0};  // centre of the cross-section
    glm::dvec3 direction{0.0, -1.0, 0.0};
    glm::dvec3 half_u_mm{
        0.0};  // half-axes of the cross-section: of the disk its radii, of the rectangle half its sides
    glm::dvec3 half_v_mm{0.0};
};

struct Scene {
    std::string file;  // as given on the command line
    RenderSettings render;
    Film film;
    Camera camera;
    std::vector<Medium> media;
    std::vector<Fluorophore> fluorophores;
    std::vector<Material> materials;
    std::vector<Light> lights;
    std::vector<Shape> shapes;
    int body_count = 0;
};

}  // namespace stokes
