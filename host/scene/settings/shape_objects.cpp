// Shapes of a scene file, and the steps of their transforms.
#include "host/scene/mesh/shapes.hpp"
#include "host/scene/readers/mask.hpp"
#include "host/scene/settings/objects.hpp"

namespace stokes {
namespace {

constexpr NumberRange angle_range{-1e6, 1e6};
constexpr IntegerRange tile_range{1, 512};
const std::string flat = "In the plane y = 0 about the origin, facing +y.";
const std::string upright = "Upright, its base in the plane y = 0 about the origin.";

const Key own_name{"name", OwnName{}, optional, "Of its own, for messages and reports; by default its kind and index."};
const Key transform{"transform", ListOf{"transform"}, optional, "Steps, applied in order."};
const Key body{"body", OwnName{}, optional,
               "Shapes of one body, which have one material, share the light below their surfaces. By default a shape "
               "is a body of its own."};
const Key along_x{"width_mm", length_range, required, "Along x."};
const Key along_z{"height_mm", length_range, required, "Along z."};
const Key height{"height_mm", length_range, required, "From base to top."};

Key type(const std::string& word) { return {"type", OneWord{{word}}, required, "The kind of shape."}; }
Key radius(const char* of) { return {"radius_mm", length_range, required, of}; }
Key size(const char* help) { return {"size_mm", Vector{length_range}, required, help}; }
Key segments(const char* help = "Straight pieces around its edge.") {
    return {"segments", IntegerRange{4, 2048}, default_segments, help};
}

ObjectDeclaration shape(const std::string& word, const std::string& help, const std::vector<Key>& own,
                        const char* material = "A name in materials.") {
    ObjectDeclaration object{"shape_" + word, help, {type(word)}};
    object.keys.insert(object.keys.end(), own.begin(), own.end());
    object.keys.push_back({"material", NameIn{"materials"}, required, material});
    for (const Key& key : {own_name, body, transform}) object.keys.push_back(key);
    return object;
}

// A shape of several materials, which is a body of its own.
ObjectDeclaration compound(const std::string& word, const std::string& help, const char* materials,
                           const std::vector<Key>& own) {
    ObjectDeclaration object{"shape_" + word, help, {type(word)}};
    object.keys.push_back({"materials", ListOf{"name", 1}, required, materials});
    object.keys.insert(object.keys.end(), own.begin(), own.end());
    for (const Key& key : {own_name, transform}) object.keys.push_back(key);
    return object;
}

Objects transforms() {
    return {
        {"transform",
         "A step of a transform.",
         {},
         {},
         {},
         {"transform_scale", "transform_rotate", "transform_translate"}},
        {"transform_scale",
         "About the origin. A negative factor mirrors; the outside stays outside.",
         {{"scale", Declared{"scale"}, required, "One factor, or one each for x, y and z."}}},
        {"transform_rotate",
         "About an axis through the origin, counter-clockwise seen from its tip.",
         {{"rotate_axis", Direction{}, required, "The axis."}, {"angle_deg", angle_range, required, "Angle."}}},
        {"transform_translate", "Moves.", {{"translate_mm", Vector{}, required, "By this much."}}},
    };
}

ObjectDeclaration mesh() {
    ObjectDeclaration object = shape("mesh", "Triangles and polygons from a file, one unit of which is taken as 1 mm.",
                                     {{"file", Text{}, required, "A PLY, OBJ or STL file."}},
                                     "A name in materials. Needed unless `materials` names one for all faces.");
    for (Key& key : object.keys)
        if (key.name == "material") key.fallback = optional;
    object.keys.push_back({"materials", Declared{"materials_of_mesh"}, optional,
                           "For materials of an OBJ file, by their names after usemtl, names in the scene's materials. "
                           "All others have `material`."});
    object.rules = R"({"anyOf": [{"required": ["material"]}, {"required": ["materials"]}]})";
    return object;
}

}  // namespace

Objects shape_objects() {
    Objects objects{
        mesh(),
        shape("box", "Centred on the origin.", {size("Along x, y and z.")}),
        shape("sphere", "Centred on the origin.", {radius("Of its surface."), segments()}),
        shape("rectangle", flat, {along_x, along_z}),
        shape("disk", flat, {radius("Of its edge."), segments()}),
        shape("prism", upright,
              {{"sides", IntegerRange{3, 2048}, required, "Number of upright faces."},
               radius("From the axis to the corners, the first of which is on +x."),
               height}),
        shape("cylinder", upright, {radius("Of its edge."), height, segments()}),
        shape("mask",
              "A thin sheet in the plane y = 0 about the origin, the same from both sides, opaque where a picture is "
              "dark and open where it is bright or transparent. The picture's top left corner is at -x and -z.",
              {along_x,
               along_z,
               {"file", Text{}, required, "A PNG file of at most 8192 x 8192 pixels."},
               {"threshold", NumberRange{0.0, 1.0, true}, MaskTexels().threshold,
                "Linear luminance below which it is opaque."},
               {"invert", YesNo{}, MaskTexels().invert, "Whether it is opaque where the picture is bright instead."}},
              "A name in materials, of a black or diffuse one."),
        compound("tiles",
                 "A slab centred on the origin whose surface is divided into tiles. It is one body without walls "
                 "inside: light below the surface goes from tile to tile.",
                 "Names in materials, all with light below their surfaces or all without. The tile in column i and "
                 "row j has number (i + j) modulo their count.",
                 {{"columns", tile_range, required, "Tiles along x, from -x on."},
                  {"rows", tile_range, required, "Tiles along z, from -z on."},
                  size("Of the slab along x, y and z.")}),
        compound("sectors",
                 "An upright cylinder, its base in the plane y = 0 about the origin, whose surface is divided into "
                 "equal sectors. It is one body without walls inside.",
                 "Names in materials, all with light below their surfaces or all without, one for each sector, "
                 "counter-clockwise seen from above.",
                 {radius("Of its edge."),
                  height,
                  segments("Straight pieces around its edge, rounded up to a multiple of the sectors."),
                  {"start_deg", angle_range, 0.0,
                   "Where the first sector begins, counter-clockwise from +x seen from above."}}),
    };
    ObjectDeclaration any{"shape", "A surface of the scene.", {}, {}, {}, {}};
    for (const ObjectDeclaration& object : objects) any.alternatives.push_back(object.kind);
    objects.insert(objects.begin(), any);
    const Objects steps = transforms();
    objects.insert(objects.end(), steps.begin(), steps.end());
    return objects;
}

}  // namespace stokes
