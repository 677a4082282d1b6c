#include "host/render/device_materials.hpp"

#include "host/render/pass_spectra.hpp"
#include "host/subsurface/fresnel.hpp"

namespace stokes {

namespace {

// Index of the owner of a material's tables.
std::uint32_t table_owner(const Scene& scene, const Material& material) {
    const auto medium = static_cast<std::uint32_t>(material.medium);
    if (scene.render.transport == Transport::paper) return medium;
    return 2 * medium + (reflects(scene, material) ? 1 : 0);
}

}  // namespace

bool has_subsurface(const Material& material) {
    return material.kind == MaterialKind::translucent && material.subsurface;
}

bool reflects(const Scene& scene, const Material& material) {
    return has_subsurface(material) && material.fresnel && scene.render.transport != Transport::paper;
}

std::vector<MaterialRecord> material_records(const Scene& scene) {
    const SpectraLayout layout(scene);
    std::vector<MaterialRecord> records;
    for (const Material& material : scene.materials) {
        MaterialRecord record{};
        record.kind = material.kind == MaterialKind::diffuse       ? STOKES_DIFFUSE
                      : material.kind == MaterialKind::translucent ? STOKES_TRANSLUCENT
                                                                   : STOKES_BLACK;
        const bool subsurface = has_subsurface(material);
        record.medium = subsurface ? table_owner(scene, material) : STOKES_NONE;
        record.fluorescent_fraction = static_cast<float>(material.fluorescent_fraction);
        const double eta = subsurface ? scene.media[static_cast<std::size_t>(material.medium)].eta : 1.0;
        record.eta = static_cast<float>(eta);
        const bool fluorescent = material.fluorophore >= 0;
        record.excitation_row = fluorescent ? layout.excitation_row(material.fluorophore) : STOKES_NONE;
        record.reradiation_row = fluorescent ? layout.reradiation_row(material.fluorophore) : STOKES_NONE;
        record.sigma_row = subsurface ? layout.sigma_row(material.medium) : STOKES_NONE;
        record.exit_scale =
            reflects(scene, material) ? static_cast<float>(1.0 / (1.0 - diffuse_reflectance(eta))) : 0.0f;
        records.push_back(record);
    }
    return records;
}

}  // namespace stokes
