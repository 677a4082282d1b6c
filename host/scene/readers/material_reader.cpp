#include "host/scene/readers/material_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/media_limits.hpp"
#include "host/scene/readers/input_files.hpp"
#include "host/scene/scene_keys.hpp"

namespace stokes {
namespace {

constexpr NumberRange eta_range{1.0, 5.0};
constexpr NumberRange dipole_eta_range{1.0, largest_dipole_eta};
constexpr NumberRange sigma_t_range{smallest_sigma_t_per_mm, largest_sigma_t_per_mm};
constexpr NumberRange scale_range{0.0, 1e6};
constexpr NumberRange unit_range{0.0, 1.0};

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
    const double emission_sum = fluorophore.emission.sum_1nm();
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

Material read_diffuse(const JsonCursor& where, SpectrumReader& spectra, TextureFiles& textures) {
    where.expect_keys(keys::material_diffuse);
    Material material;
    material.kind = MaterialKind::diffuse;
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

void check_fresnel(const JsonCursor& fresnel, const Material& material, const Scene& scene) {
    if (material.medium < 0) fresnel.fail("Fresnel reflection needs a medium and subsurface light");
    const double eta = scene.media[static_cast<std::size_t>(material.medium)].eta;
    if (eta > largest_green_eta)
        fresnel.fail(
            fmt::format("Fresnel reflection needs a medium with eta up to {:g}, got {:g}", largest_green_eta, eta));
}

Material read_translucent(const JsonCursor& where, const Scene& scene) {
    where.expect_keys(keys::material_translucent);
    Material material;
    material.kind = MaterialKind::translucent;
    const auto subsurface = where.find("subsurface");
    material.subsurface = !subsurface || subsurface->boolean();
    const auto medium = where.find("medium");
    if (medium) material.medium = index_of_name(*medium, "media", scene.media);
    if (!medium && material.subsurface) where.fail("missing key \"medium\", which subsurface light needs");
    if (!material.subsurface) material.medium = -1;
    if (const auto fresnel = where.find("fresnel")) {
        material.fresnel = fresnel->boolean();
        if (material.fresnel) check_fresnel(*fresnel, material, scene);
    }

    const auto fluorophore = where.find("fluorophore");
    const auto fraction = where.find("fluorescent_fraction");
    if (fluorophore) {
        material.fluorophore = index_of_name(*fluorophore, "fluorophores", scene.fluorophores);
        if (!fraction) where.fail("missing key \"fluorescent_fraction\", which belongs to a fluorophore");
    } else if (!material.subsurface) {
        where.fail("missing key \"fluorophore\": without subsurface light it is all that this material does");
    }
    if (fraction) material.fluorescent_fraction = fraction->number(unit_range);
    if (!fluorophore && material.fluorescent_fraction > 0.0) {
        fraction->fail("a fluorescent fraction without the key \"fluorophore\"");
    }
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
                material = read_diffuse(where, spectra, textures);
                break;
            case 1:
                where.expect_keys(keys::material_black);
                break;
            default:
                material = read_translucent(where, scene);
        }
        material.name = name;
        result.push_back(std::move(material));
    }
    return result;
}

}  // namespace stokes
