#include "host/render/transport/transport_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/error.hpp"
#include "host/render/transport/conserving_transport.hpp"
#include "host/render/transport/paper_transport.hpp"
#include "host/render/transport/walk_transport.hpp"
#include "host/scene/mesh/mesh_topology.hpp"

namespace stokes {

namespace {

class PaperModel : public TransportModel {
  public:
    std::uint32_t code() const override { return STOKES_TRANSPORT_PAPER; }
    bool has_fresnel() const override { return false; }
    std::uint32_t table_of(std::uint32_t medium, bool) const override { return medium; }
    StokesRule stokes_rule() const override { return StokesRule::truncate; }
    // Eq. 1-2 of the paper.
    double reradiated_per_nm(const Fluorophore& dye, double, int, int em_nm) const override {
        return dye.conversion * dye.emission.at(em_nm);
    }
    bool reaches_any_distance() const override { return false; }
    // Fluorophores that give off more than they take up.
    std::vector<std::string> remarks(const Scene& scene) const override {
        std::vector<std::string> lines;
        for (const Fluorophore& dye : scene.fluorophores) {
            const double gain = dye.conversion * dye.emission.sum_1nm();
            if (gain > 1.0)
                lines.push_back(fmt::format(
                    "{}: fluorophores.{}: emits up to {:.3g} times what it takes up (conversion_per_nm times the "
                    "sum of its emission)",
                    scene.file, dye.name, gain));
        }
        return lines;
    }
    std::unique_ptr<SubsurfaceTransport> make(const Device& device, const Scene& scene,
                                              const DeviceScene&) const override {
        return std::make_unique<PaperTransport>(device, scene);
    }
};

class ConservingModel : public TransportModel {
  public:
    std::uint32_t code() const override { return STOKES_TRANSPORT_CONSERVING; }
    std::uint32_t table_of(std::uint32_t medium, bool fresnel) const override { return 2 * medium + (fresnel ? 1 : 0); }
    std::unique_ptr<SubsurfaceTransport> make(const Device& device, const Scene& scene,
                                              const DeviceScene& on_device) const override {
        return std::make_unique<ConservingTransport>(device, scene, on_device);
    }
};

class WalkModel : public TransportModel {
  public:
    std::uint32_t code() const override { return STOKES_TRANSPORT_WALK; }
    // Walks have no part in light that does not go below a surface; it is as in `conserving`.
    std::uint32_t surface_code() const override { return STOKES_TRANSPORT_CONSERVING; }
    std::uint32_t table_of(std::uint32_t medium, bool) const override { return medium; }
    void check(const Scene& scene) const override {
        check_walkable(scene, [&](int body) { return transport_of_body(scene, body) == Transport::walk; });
    }
    bool takes_bodies_for_half_spaces() const override { return false; }
    bool takes_up_again(bool first_collision_only) const override { return !first_collision_only; }
    std::unique_ptr<SubsurfaceTransport> make(const Device& device, const Scene&,
                                              const DeviceScene& on_device) const override {
        return std::make_unique<WalkTransport>(device, on_device);
    }
};

}  // namespace

const TransportModel& transport_model(Transport transport) {
    static const PaperModel paper;
    static const ConservingModel conserving;
    static const WalkModel walk;
    switch (transport) {
        case Transport::paper:
            return paper;
        case Transport::conserving:
            return conserving;
        case Transport::walk:
            return walk;
    }
    throw RunError("a transport without a model");
}

Transport transport_of_body(const Scene& scene, int body) {
    const auto own = scene.body_transports.find(body);
    return own == scene.body_transports.end() ? scene.render.transport : own->second;
}

std::vector<MaterialUse> material_uses(const Scene& scene) {
    std::vector<MaterialUse> uses;
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        uses.push_back({static_cast<int>(m), scene.render.transport});
    for (const Shape& shape : scene.shapes) {
        const MaterialUse use{shape.material, transport_of_body(scene, shape.body)};
        const auto same = [&](const MaterialUse& other) {
            return other.material == use.material && other.transport == use.transport;
        };
        const bool translucent = as_translucent(scene.materials[static_cast<std::size_t>(use.material)]) != nullptr;
        if (translucent && std::none_of(uses.begin(), uses.end(), same)) uses.push_back(use);
    }
    return uses;
}

std::vector<Transport> transports_of(const Scene& scene) {
    std::vector<Transport> transports;
    for (const MaterialUse& use : material_uses(scene))
        if (std::find(transports.begin(), transports.end(), use.transport) == transports.end())
            transports.push_back(use.transport);
    return transports;
}

std::vector<std::uint32_t> uses_of_shapes(const Scene& scene) {
    const std::vector<MaterialUse> uses = material_uses(scene);
    std::vector<std::uint32_t> result;
    for (const Shape& shape : scene.shapes) {
        auto use = static_cast<std::uint32_t>(shape.material);
        for (std::size_t i = scene.materials.size(); i < uses.size(); ++i)
            if (uses[i].material == shape.material && uses[i].transport == transport_of_body(scene, shape.body))
                use = static_cast<std::uint32_t>(i);
        result.push_back(use);
    }
    return result;
}

// Walks store before the exits of light that leaves where it came in.
std::vector<std::unique_ptr<SubsurfaceTransport>> make_transports(const Device& device, const Scene& scene,
                                                                  const DeviceScene& on_device) {
    std::vector<std::unique_ptr<SubsurfaceTransport>> transports;
    const std::vector<MaterialUse> uses = material_uses(scene);
    for (const Transport transport : {Transport::walk, Transport::paper, Transport::conserving}) {
        const TransportModel& model = transport_model(transport);
        const auto used = [&](const MaterialUse& use) {
            const Material& material = scene.materials[static_cast<std::size_t>(use.material)];
            const TransportModel& own = transport_model(use.transport);
            return as_translucent(material) != nullptr &&
                   model.code() == (medium_of(material) ? own.code() : own.surface_code());
        };
        if (std::any_of(uses.begin(), uses.end(), used)) transports.push_back(model.make(device, scene, on_device));
    }
    return transports;
}

}  // namespace stokes
