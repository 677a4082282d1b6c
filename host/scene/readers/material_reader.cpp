#include "host/scene/readers/material_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/log.hpp"
#include "host/core/media_limits.hpp"
#include "host/scene/readers/input_files.hpp"

namespace stokes {
namespace {

constexpr NumberRange sigma_t_range{smallest_sigma_t_per_mm, largest_sigma_t_per_mm};
constexpr double fraction_rounding = 1e-9;  // 0.1, 0.2 and 0.7 may add up to a little more than 1

Medium read_medium(const std::string& name, const JsonCursor& place, SpectrumReader& spectra) {
    const ObjectReader where(place, "medium");
    Medium medium;
    medium.name = name;
    medium.sigma_s = spectra.read_per_mm(where, "sigma_s_per_mm", where.number("scale_sigma_s"));
    medium.sigma_a = spectra.read_per_mm(where, "sigma_a_per_mm", where.number("scale_sigma_a"));
    medium.eta = where.number("eta");
    medium.dipole_eta = where.number("dipole_eta");
    medium.limited_keys = where.limited_keys();
    for (int lambda = first_lambda_nm; lambda <= last_lambda_nm; ++lambda) {
        const double sigma_t = medium.sigma_s.at(lambda) + medium.sigma_a.at(lambda);
        if (sigma_t_range.contains(sigma_t)) continue;
        where.fail(fmt::format("expected sigma_s + sigma_a {} 1/mm from {} to {} nm, got {} at {} nm",
                               sigma_t_range.text(), first_lambda_nm, last_lambda_nm, sigma_t, lambda));
    }
    return medium;
}

Spectrum read_emission(const ObjectReader& where, SpectrumReader& spectra) {
    Spectrum emission = spectra.read_relative(where, "emission");
    if (!(emission.sum_1nm() > 0.0))
        where.at("emission")
            .fail(fmt::format("expected some emission from {} to {} nm, got none", first_lambda_nm, last_lambda_nm));
    return emission;
}

Fluorophore read_fluorophore(const std::string& name, const JsonCursor& place, SpectrumReader& spectra) {
    const ObjectReader where(place, "fluorophore");
    Fluorophore fluorophore;
    fluorophore.name = name;
    fluorophore.excitation = spectra.read(where, "excitation", Outside::zero);
    if (const std::string doubt = doubt_of_probability(fluorophore.excitation); !doubt.empty())
        warn(where.at("excitation").at_place(doubt));
    fluorophore.emission = read_emission(where, spectra);
    fluorophore.conversion = where.number("conversion_per_nm");
    fluorophore.limited_keys = where.limited_keys();
    if (const auto rule = where.find("stokes_rule")) fluorophore.stokes_rule = rule->word<StokesRule>();
    fluorophore.quantum_yield = where.has("quantum_yield")
                                    ? where.number("quantum_yield")
                                    : std::min(1.0, fluorophore.conversion * fluorophore.emission.sum_1nm());
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

DiffuseMaterial read_diffuse(const ObjectReader& where, SpectrumReader& spectra, TextureFiles& textures) {
    DiffuseMaterial material;
    if (!where.at("reflectance").has("texture")) {
        material.reflectance = spectra.read(where.at("reflectance"), Outside::hold, 1.0);
        return material;
    }
    const ObjectReader reflectance(where.at("reflectance"), "reflectance_texture");
    material.reflectance = spectra.read(reflectance, "black", Outside::hold);
    material.white = spectra.read(reflectance, "white", Outside::hold);
    material.texture = textures.read(reflectance.at("texture"));
    if (const auto wrap = reflectance.find("wrap")) material.wrap = wrap->word<TextureWrap>();
    return material;
}

void check_fresnel(const JsonCursor& fresnel, const TranslucentMaterial& material, const Scene& scene) {
    if (!material.medium) fresnel.fail("Fresnel reflection needs a medium and subsurface light");
    const double eta = scene.media[static_cast<std::size_t>(*material.medium)].eta;
    if (eta > largest_green_eta)
        fresnel.fail(
            fmt::format("Fresnel reflection needs a medium with eta up to {:g}, got {:g}", largest_green_eta, eta));
}

// "fluorophores" with the share of each, or the short form for one: "fluorophore" and "fluorescent_fraction".
std::vector<Dye> read_dyes(const ObjectReader& where, const Scene& scene) {
    const auto index = [&](const JsonCursor& name) { return index_of_name(name, "fluorophores", scene.fluorophores); };
    const auto list = where.find("fluorophores"), one = where.find("fluorophore");
    const auto fraction = where.find("fluorescent_fraction");
    if (list && (one || fraction))
        list->fail("expected either this or \"fluorophore\" and \"fluorescent_fraction\", got both");
    if (one && !fraction) where.fail("missing key \"fluorescent_fraction\", which belongs to a fluorophore");
    if (one) return {{index(*one), where.number("fluorescent_fraction")}};
    if (where.number("fluorescent_fraction") > 0.0)
        fraction->fail("a fluorescent fraction without the key \"fluorophore\"");
    std::vector<Dye> dyes;
    if (!list) return dyes;
    for (const JsonCursor& item : list->items()) {
        const ObjectReader dye(item, "dye");
        const int fluorophore = index(dye.at("fluorophore"));
        const auto same = [&](const Dye& other) { return other.fluorophore == fluorophore; };
        if (std::any_of(dyes.begin(), dyes.end(), same))
            dye.at("fluorophore").fail(fmt::format("\"{}\" given twice", dye.at("fluorophore").text()));
        dyes.push_back({fluorophore, dye.number("fraction")});
    }
    if (dyes.empty()) list->fail_expected("one or more fluorophores");
    if (const double sum = fluorescent_fraction(dyes); sum > 1.0 + fraction_rounding)
        list->fail(fmt::format("expected fractions that add up to 1 at most, got {:g}", sum));
    return dyes;
}

TranslucentMaterial read_translucent(const ObjectReader& where, const Scene& scene) {
    TranslucentMaterial material;
    const auto medium = where.find("medium");
    if (medium) material.medium = index_of_name(*medium, "media", scene.media);
    if (!where.boolean("subsurface"))
        material.medium.reset();
    else if (!medium)
        where.fail("missing key \"medium\", which subsurface light needs");
    material.fresnel = where.boolean("fresnel");
    if (material.fresnel) check_fresnel(where.at("fresnel"), material, scene);
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
    for (const auto& [name, place] : materials.named_members()) {
        const ObjectReader where(place, "material");
        Material material;
        if (where.kind() == "material_diffuse")
            material.kind = read_diffuse(where, spectra, textures);
        else if (where.kind() == "material_translucent")
            material.kind = read_translucent(where, scene);
        else if (where.kind() == "material_black")
            material.kind = BlackMaterial{};
        else
            where.fail_unread();
        material.name = name;
        material.limited_keys = where.limited_keys();
        result.push_back(std::move(material));
    }
    return result;
}

}  // namespace stokes
