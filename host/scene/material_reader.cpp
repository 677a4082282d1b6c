#include "host/scene/material_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/media_limits.hpp"
#include "host/scene/input_files.hpp"

namespace stokes {
namespace {

constexpr NumberRange eta_range{1.0, 5.0};
constexpr NumberRange dipole_eta_range{1.0, largest_dipole_eta};
constexpr NumberRange sigma_t_range{smallest_sigma_t_per_mm, largest_sigma_t_per_mm};
constexpr NumberRange scale_range{0.0, 1e6};
constexpr NumberRange unit_range{0.0, 1.0};
constexpr double fraction_rounding = 1e-9;  // 0.1, 0.2 and 0.7 may add up to a little more than 1
// Where the renderer may ask for spectra.
constexpr int first_lambda_nm = 300;
constexpr int last_lambda_nm = 830;

Medium read_medium(const std::string& name, const JsonCursor& where, SpectrumReader& spectra) {
    where.expect_keys(keys::medium);
    Medium medium;
    medium.name = name;
    medium.sigma_s = spectra.read(where.at("sigma_s_per_mm"), Outside::hold)
                         .scaled(where.number_or("scale_sigma_s", 1.0, scale_range));
    medium.sigma_a = spectra.read(where.at("sigma_a_per_mm"), Outside::hold)
                         .scaled(where.number_or("scale_sigma_a", 1.0, scale_range));
    medium.eta = where.number_or("eta", 1.0, eta_range);
    medium.dipole_eta = where.number_or("dipole_eta", 1.0, dipole_eta_range);
    for (int lambda = first_lambda_nm; lambda <= last_lambda_nm; ++lambda) {
        const double sigma_t = medium.sigma_s.at(lambda) + medium.sigma_a.at(lambda);
        if (sigma_t_range.contains(sigma_t)) continue;
        where.fail(fmt::format("expected sigma_s + sigma_a {} 1/mm from {} to {} nm, got {} at {} nm",
                               sigma_t_range.text(), first_lambda_nm, last_lambda_nm, sigma_t, lambda));
    }
    return medium;
}

Fluorophore read_fluorophore(const std::string& name, const JsonCursor& where, SpectrumReader& spectra) {
    where.expect_keys(keys::fluorophore);
    Fluorophore fluorophore;
    fluorophore.name = name;
    fluorophore.excitation = spectra.read(where.at("excitation"), Outside::zero, 1.0);
    fluorophore.emission = spectra.read(where.at("emission"), Outside::zero, 1.0);
    fluorophore.conversion = where.number_or("conversion_per_nm", fluorophore.conversion, unit_range);
    const double emission_sum = fluorophore.emission.sum_1nm(first_lambda_nm, last_lambda_nm);
    if (!(emission_sum > 0.0)) {
        where.at("emission")
            .fail(fmt::format("expected some emission from {} to {} nm, got none at any whole nanometre",
                              first_lambda_nm, last_lambda_nm));
    }
    fluorophore.quantum_yield =
        where.number_or("quantum_yield", std::min(1.0, fluorophore.conversion * emission_sum), unit_range);
    return fluorophore;
}

// As it looks on white paper.
std::shared_ptr<const Picture> read_texture(const std::string& path) {
    Picture picture = read_picture(path);
    for (std::size_t i = 0; i < picture.opacity.size(); ++i) picture.luminance[i] = picture.luminance_over(1.0f, i);
    picture.opacity.clear();
    return std::make_shared<const Picture>(std::move(picture));
}

using TextureFiles = InputFiles<std::shared_ptr<const Picture>, read_texture>;

DiffuseMaterial read_diffuse(const JsonCursor& where, SpectrumReader& spectra, TextureFiles& textures) {
    where.expect_keys(keys::material_diffuse);
    DiffuseMaterial material;
    const JsonCursor reflectance = where.at("reflectance");
    if (!reflectance.is(JsonValue::Type::object) || !reflectance.has("texture")) {
        material.reflectance = spectra.read(reflectance, Outside::hold, 1.0);
        return material;
    }
    reflectance.expect_keys(keys::reflectance_texture);
    material.reflectance = spectra.read(reflectance.at("black"), Outside::hold, 1.0);
    material.white = spectra.read(reflectance.at("white"), Outside::hold, 1.0);
    material.texture = textures.read(reflectance.at("texture"));
    return material;
}

void check_fresnel(const JsonCursor& fresnel, const TranslucentMaterial& material, const Scene& scene) {
    if (!material.medium) fresnel.fail("Fresnel reflection needs a medium and subsurface light");
    const double eta = scene.media[static_cast<std::size_t>(*material.medium)].eta;
    if (eta > largest_green_eta)
        fresnel.fail(
            fmt::format("Fresnel reflection needs a medium with eta up to {:g}, got {:g}", largest_green_eta, eta));
}

Dye read_dye(const JsonCursor& fluorophore, const JsonCursor& fraction, const Scene& scene) {
    return {index_of_name(fluorophore, "fluorophores", scene.fluorophores), fraction.number(unit_range)};
}

// "fluorophores" with the share of each, or the short form for one: "fluorophore" and "fluorescent_fraction".
std::vector<Dye> read_dyes(const JsonCursor& where, const Scene& scene) {
    const auto list = where.find("fluorophores"), one = where.find("fluorophore");
    const auto fraction = where.find("fluorescent_fraction");
    if (list && (one || fraction))
        list->fail("expected either this or \"fluorophore\" and \"fluorescent_fraction\", got both");
    if (one && !fraction) where.fail("missing key \"fluorescent_fraction\", which belongs to a fluorophore");
    if (one) return {read_dye(*one, *fraction, scene)};
    if (fraction && fraction->number(unit_range) > 0.0)
        fraction->fail("a fluorescent fraction without the key \"fluorophore\"");
    std::vector<Dye> dyes;
    if (!list) return dyes;
    for (const JsonCursor& item : list->items()) {
        item.expect_keys(keys::dye);
        const Dye dye = read_dye(item.at("fluorophore"), item.at("fraction"), scene);
        const auto same = [&](const Dye& other) { return other.fluorophore == dye.fluorophore; };
        if (std::any_of(dyes.begin(), dyes.end(), same))
            item.at("fluorophore").fail(fmt::format("\"{}\" given twice", item.at("fluorophore").text()));
        dyes.push_back(dye);
    }
    if (dyes.empty()) list->fail_expected("one or more fluorophores");
    if (const double sum = fluorescent_fraction(dyes); sum > 1.0 + fraction_rounding)
        list->fail(fmt::format("expected fractions that add up to 1 at most, got {:g}", sum));
    return dyes;
}

TranslucentMaterial read_translucent(const JsonCursor& where, const Scene& scene) {
    where.expect_keys(keys::material_translucent);
    TranslucentMaterial material;
    const auto subsurface = where.find("subsurface");
    const auto medium = where.find("medium");
    if (medium) material.medium = index_of_name(*medium, "media", scene.media);
    if (subsurface && !subsurface->boolean())
        material.medium.reset();
    else if (!medium)
        where.fail("missing key \"medium\", which subsurface light needs");
    if (const auto fresnel = where.find("fresnel")) {
        material.fresnel = fresnel->boolean();
        if (material.fresnel) check_fresnel(*fresnel, material, scene);
    }
    material.dyes = read_dyes(where, scene);
    if (material.dyes.empty() && !material.medium)
        where.fail("missing key \"fluorophore\": without subsurface light it is all that this material does");
    return material;
}

}  // namespace

std::vector<Medium> read_media(const JsonCursor& media, SpectrumReader& spectra) {
    std::vector<Medium> result;
    for (const auto& [name, where] : media.named_members()) result.push_back(read_medium(name, where, spectra));
    return result;
}

std::vector<Fluorophore> read_fluorophores(const JsonCursor& fluorophores, SpectrumReader& spectra) {
    std::vector<Fluorophore> result;
    for (const auto& [name, where] : fluorophores.named_members())
        result.push_back(read_fluorophore(name, where, spectra));
    return result;
}

std::vector<Material> read_materials(const JsonCursor& materials, SpectrumReader& spectra, const Scene& scene) {
    TextureFiles textures(spectra.folder());
    std::vector<Material> result;
    for (const auto& [name, where] : materials.named_members()) {
        Material material;
        switch (where.at("type").choice({"diffuse", "black", "translucent"})) {
            case 0:
                material.kind = read_diffuse(where, spectra, textures);
                break;
            case 1:
                where.expect_keys(keys::material_black);
                break;
            default:
                material.kind = read_translucent(where, scene);
        }
        material.name = name;
        result.push_back(std::move(material));
    }
    return result;
}

}  // namespace stokes
