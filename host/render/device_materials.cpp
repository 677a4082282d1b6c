#include "host/render/device_materials.hpp"

#include "host/core/overloaded.hpp"
#include "host/render/pass_spectra.hpp"
#include "host/subsurface/fresnel.hpp"
#include "kernels/shared/pass.h"

namespace stokes {

namespace {

std::uint32_t transport_code(Transport transport) {
    return transport == Transport::paper        ? STOKES_TRANSPORT_PAPER
           : transport == Transport::conserving ? STOKES_TRANSPORT_CONSERVING
                                                : STOKES_TRANSPORT_WALK;
}

void set_medium(MaterialRecord& record, const Medium& medium, std::uint32_t index, bool fresnel) {
    record.flags |= STOKES_MATERIAL_SUBSURFACE;
    record.medium = record.transport == STOKES_TRANSPORT_PAPER ? index : 2 * index + (fresnel ? 1 : 0);
    record.eta = static_cast<float>(medium.eta);
    if (!fresnel) return;
    record.flags |= STOKES_MATERIAL_FRESNEL;
    record.exit_scale = static_cast<float>(1.0 / (1.0 - diffuse_reflectance(medium.eta)));
}

}  // namespace

bool reflects(const Material& material, Transport transport) {
    const TranslucentMaterial* translucent = as_translucent(material);
    return translucent != nullptr && translucent->medium && translucent->fresnel && transport != Transport::paper;
}

std::vector<MaterialRecord> material_records(const Scene& scene, Transport transport) {
    const SpectraLayout layout(scene);
    std::vector<MaterialRecord> records;
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        MaterialRecord record{};
        record.transport = transport_code(transport);
        record.eta = 1.0f;
        const auto black = [&](const BlackMaterial&) { record.kind = STOKES_BLACK; };
        const auto diffuse = [&](const DiffuseMaterial&) { record.kind = STOKES_DIFFUSE; };
        const auto translucent = [&](const TranslucentMaterial& material) {
            record.kind = STOKES_TRANSLUCENT;
            if (!material.dyes.empty()) record.flags |= STOKES_MATERIAL_FLUORESCENT;
            record.fluorescent_fraction = static_cast<float>(fluorescent_fraction(material.dyes));
            record.excitation_row = layout.excitation_row[m];
            record.reradiation_row = record.excitation_row + 1;
            if (!material.medium) {  // which walks have no part in
                if (transport == Transport::walk) record.transport = STOKES_TRANSPORT_CONSERVING;
                return;
            }
            record.sigma_row = layout.sigma_row(*material.medium);
            set_medium(record, scene.media[static_cast<std::size_t>(*material.medium)],
                       static_cast<std::uint32_t>(*material.medium), reflects(scene.materials[m], transport));
        };
        std::visit(Overloaded{black, diffuse, translucent}, scene.materials[m].kind);
        records.push_back(record);
    }
    return records;
}

}  // namespace stokes
