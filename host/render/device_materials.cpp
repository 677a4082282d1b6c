#include "host/render/device_materials.hpp"

#include "host/core/overloaded.hpp"
#include "host/render/pass_spectra.hpp"
#include "host/render/transport/transport_model.hpp"
#include "host/subsurface/fresnel.hpp"

namespace stokes {

namespace {

// index: of its tables.
void set_medium(MaterialRecord& record, const Medium& medium, std::uint32_t index, bool fresnel) {
    record.flags |= STOKES_MATERIAL_SUBSURFACE;
    record.medium = index;
    record.eta = static_cast<float>(medium.eta);
    if (!fresnel) return;
    record.flags |= STOKES_MATERIAL_FRESNEL;
    record.exit_scale = static_cast<float>(1.0 / (1.0 - diffuse_reflectance(medium.eta)));
}

}  // namespace

bool reflects(const Material& material, Transport transport) {
    const TranslucentMaterial* translucent = as_translucent(material);
    return translucent != nullptr && translucent->medium && translucent->fresnel &&
           transport_model(transport).has_fresnel();
}

bool may_mirror(const MaterialRecord& record) { return (record.flags & STOKES_MATERIAL_FRESNEL) != 0; }

std::vector<MaterialRecord> material_records(const Scene& scene) {
    const SpectraLayout layout(scene);
    const std::vector<MaterialUse> uses = material_uses(scene);
    std::vector<MaterialRecord> records;
    for (std::size_t u = 0; u < uses.size(); ++u) {
        const Material& of = scene.materials[static_cast<std::size_t>(uses[u].material)];
        const TransportModel& model = transport_model(uses[u].transport);
        MaterialRecord record{};
        record.transport = model.code();
        record.eta = 1.0f;
        const auto black = [&](const BlackMaterial&) { record.kind = STOKES_BLACK; };
        const auto diffuse = [&](const DiffuseMaterial&) { record.kind = STOKES_DIFFUSE; };
        const auto translucent = [&](const TranslucentMaterial& material) {
            record.kind = STOKES_TRANSLUCENT;
            if (!material.dyes.empty()) record.flags |= STOKES_MATERIAL_FLUORESCENT;
            record.fluorescent_fraction = static_cast<float>(fluorescent_fraction(material.dyes));
            record.excitation_row = layout.excitation_row[u];
            record.reradiation_row = record.excitation_row + 1;
            if (!material.medium) {
                record.transport = model.surface_code();
                return;
            }
            const auto medium = static_cast<std::uint32_t>(*material.medium);
            const bool fresnel = reflects(of, uses[u].transport);
            record.sigma_row = layout.sigma_row(*material.medium);
            if (settings_of(scene.render, uses[u].transport).branches == Branches::both)
                record.flags |= STOKES_MATERIAL_BRANCHES;
            set_medium(record, scene.media[medium], model.table_of(medium, fresnel), fresnel);
        };
        std::visit(Overloaded{black, diffuse, translucent}, of.kind);
        records.push_back(record);
    }
    return records;
}

}  // namespace stokes
