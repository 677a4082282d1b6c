// Spectra, media, fluorophores and materials of a scene file.
#include "host/core/csv_spectrum.hpp"
#include "host/core/media_limits.hpp"
#include "host/scene/scene.hpp"
#include "host/scene/settings/objects.hpp"

namespace stokes {
namespace {

constexpr NumberRange value_range{0.0, largest_spectrum_value};
constexpr NumberRange scale_range{0.0, 1e6};
constexpr NumberRange unit_range{0.0, 1.0};
const Domain up_to_1 = SpectrumUpTo{1.0};

const Key outside{"outside", OneWord{{"zero", "hold"}}, optional,
                  "Value beyond the ends of the table. By default media and reflectances hold the last one, and "
                  "everything else is zero."};

const Key unit{"unit", OneWord{words_of<WavelengthUnit>}, optional,
               "Of the wavelengths; eV, cm-1 and THz are photon energies, wavenumbers and frequencies. By default what "
               "the name of the file's first column says (\"wavelength_um\", \"energy (eV)\"), or nm."};
const Key per{
    "per", OneWord{words_of<Per>}, std::string("nm"),
    "What the values of a light or an emission are densities over: nm, whatever the unit of the wavelengths, or "
    "that unit, in which case they are brought to densities per nm."};
const Key negative{
    "negative", OneWord{words_of<Negative>}, optional,
    "What becomes of values below zero. By default those down to -0.02 of the largest value, noise about a "
    "dark level, become zero with a warning, and lower ones are an error."};

Objects spectrum_objects() {
    return {
        {"spectrum_object",
         "A spectrum that is written out.",
         {},
         {},
         {},
         {"spectrum_file", "spectrum_illuminant", "spectrum_pairs", "spectrum_constant"}},
        {"spectrum_file",
         "A column of a table: comments, a line of column names, rows, wavelengths in the first column. Straight lines "
         "between the rows, of which every whole nanometre has the mean over itself.",
         {{"file", Text{}, required, "Its path, from the scene's folder."},
          {"column", Text{}, required,
           "Its name; or its number, \"2\" for the first after the wavelengths, in a file without a line of names."},
          {"scale", value_range, 1.0, "Times this."},
          unit,
          per,
          negative,
          outside}},
        {"spectrum_illuminant",
         "A CIE illuminant, 100 at 560 nm; zero outside 300-830 nm.",
         {{"illuminant", OneWord{{"A", "D65", "E"}}, required, "Its name."}}},
        {"spectrum_pairs",
         "Straight lines between points, of which every whole nanometre has the mean over itself. One point alone, "
         "zero "
         "outside, stands for the nanometre about it.",
         {{"pairs", ListOf{"spectrum_pair", 1}, required,
           "[wavelength in nm, or in the unit, value], wavelengths increasing, or decreasing."},
          unit,
          per,
          outside}},
        {"spectrum_constant", "The same at every wavelength.", {{"constant", value_range, required, "Its value."}}},
    };
}

Objects materials() {
    return {
        {"material",
         "What a surface does with light.",
         {},
         {},
         {},
         {"material_diffuse", "material_black", "material_translucent"}},
        {"material_diffuse",
         "Opaque and matt.",
         {{"type", OneWord{{"diffuse"}}, required, "The kind of material."},
          {"reflectance", Declared{"reflectance"}, required, "Share of the light that is reflected."}}},
        {"material_black", "Takes up all light.", {{"type", OneWord{{"black"}}, required, "The kind of material."}}},
        {"material_translucent",
         "Light scatters below the surface, or a fluorophore takes it up, or both.",
         {{"type", OneWord{{"translucent"}}, required, "The kind of material."},
          {"medium", NameIn{"media"}, optional, "A name in media; needed unless subsurface is false."},
          {"fluorophore", NameIn{"fluorophores"}, optional, "A name in fluorophores."},
          {"fluorescent_fraction", unit_range, 0.0,
           "Probability that a photon meets the fluorophore. Given with a fluorophore, and only then above zero."},
          {"fluorophores", ListOf{"dye", 1}, optional,
           "Several fluorophores, each once, in place of fluorophore and fluorescent_fraction. The fractions add up to "
           "1 at most."},
          {"subsurface", YesNo{}, true, "false: fluorescence of the surface alone, which needs a fluorophore."},
          {"fresnel",
           YesNo{},
           false,
           "true: the surface is smooth and reflects, outside and within, by the medium's eta; only with subsurface "
           "light.",
           {{Transport::conserving, Transport::walk}}}},
         {},
         R"({
             "allOf": [{"if": {"properties": {"subsurface": {"const": false}}, "required": ["subsurface"]},
                        "then": {"anyOf": [{"required": ["fluorophore"]}, {"required": ["fluorophores"]}],
                                 "properties": {"fresnel": {"const": false}}},
                        "else": {"required": ["medium"]}},
                       {"if": {"required": ["fluorophores"]},
                        "then": {"properties": {"fluorophore": false, "fluorescent_fraction": false}}}],
             "dependentRequired": {"fluorophore": ["fluorescent_fraction"]}
         })"},
        {"dye",
         "A fluorophore of a material and its share.",
         {{"fluorophore", NameIn{"fluorophores"}, required, "A name in fluorophores."},
          {"fraction", unit_range, required, "Probability that a photon meets this fluorophore."}}},
        {"reflectance_texture",
         "Between two spectra, by the linear luminance of a picture, which lies over rectangles and disks with its "
         "top left corner at -x and -z and over meshes by their texture coordinates.",
         {{"texture", Text{}, required, "A PNG file of at most 8192 x 8192 pixels."},
          {"black", up_to_1, required, "Where the luminance is 0."},
          {"white", up_to_1, required, "Where it is 1."},
          {"wrap", OneWord{words_of<TextureWrap>}, word_of(TextureWrap::repeat),
           "What lies where the texture coordinates of a mesh are beyond 0 to 1: the picture again, or its edge drawn "
           "out."}}},
    };
}

}  // namespace

Objects material_objects() {
    Objects objects = spectrum_objects();
    objects.push_back({"medium",
                       "The inside of a translucent material. sigma_s + sigma_a is 1e-9 to 1e9 from 300 to 830 nm.",
                       {{"sigma_s_per_mm", any_spectrum, required, "Scattering coefficient."},
                        {"sigma_a_per_mm", any_spectrum, required, "Absorption coefficient."},
                        {"scale_sigma_s", scale_range, 1.0, "Times this."},
                        {"scale_sigma_a", scale_range, 1.0, "Times this."},
                        {"eta", NumberRange{1.0, 5.0}, 1.0,
                         "Refractive index, for the direction of refracted light and for Fresnel reflection, which "
                         "needs 4 or less."},
                        {"dipole_eta",
                         NumberRange{1.0, largest_dipole_eta},
                         1.0,
                         "Refractive index in the boundary condition of multiple scattering; 1: no internal "
                         "reflection.",
                         {{Transport::paper}}}}});
    objects.push_back(
        {"fluorophore",
         "A substance that takes up light and gives it off at longer wavelengths.",
         {{"excitation", up_to_1, required,
           "Share of the light that meets the fluorophore and is taken up; it has its scale."},
          {"emission", any_spectrum, required,
           "Relative, of any scale; not zero everywhere. In photons per nm for transport conserving and "
           "walk, in energy per nm for paper."},
          {"conversion_per_nm",
           unit_range,
           Fluorophore().conversion,
           "Emission at the peak, the largest value of its table, per exciting flux.",
           {{Transport::paper}, "quantum_yield"}},
          {"quantum_yield",
           unit_range,
           optional,
           "Photons emitted for each one taken up. By default conversion_per_nm times the sum over whole nanometres of "
           "the emission over its peak, 1 at most.",
           {{Transport::conserving, Transport::walk}}},
          {"stokes_rule", OneWord{words_of<StokesRule>}, optional,
           "Light is emitted above the exciting wavelength only. keep_yield brings what is left of the "
           "emission back to the whole; truncate does not, so that less is emitted where excitation and "
           "emission overlap. Where nothing is left, nothing is emitted. By default keep_yield, for "
           "transport paper truncate."}}});
    const Objects kinds = materials();
    objects.insert(objects.end(), kinds.begin(), kinds.end());
    return objects;
}

}  // namespace stokes
