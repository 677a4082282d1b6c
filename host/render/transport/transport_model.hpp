// What distinguishes the transport models, one class each, beside the kernels that they launch (SubsurfaceTransport):
// what they make of materials, what they ask of a scene, and where they fail.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host/render/transport/subsurface_transport.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

class TransportModel {
  public:
    virtual ~TransportModel() = default;

    // STOKES_TRANSPORT_*, of bodies with a medium, and of surfaces without, whose light leaves where it came in.
    virtual std::uint32_t code() const = 0;
    virtual std::uint32_t surface_code() const { return code(); }

    // Surfaces reflect where their material says so.
    virtual bool has_fresnel() const { return true; }

    // Place of a medium's tables among those of the model, by index of Scene::media.
    virtual std::uint32_t table_of(std::uint32_t medium, bool fresnel) const = 0;

    // What becomes of the emission that Stokes' law cuts off, of fluorophores that do not say it.
    virtual StokesRule stokes_rule() const { return StokesRule::keep_yield; }

    // Light that a fluorophore emits at em_nm per light that it takes up at ex_nm [1/nm], by energy: Q f(em) ex/em, f
    // the emission as photons per nm of unit integral (PHYSICS section 4), without Stokes' law. emission_sum: of the
    // emission at whole nanometres.
    virtual double reradiated_per_nm(const Fluorophore& dye, double emission_sum, int ex_nm, int em_nm) const {
        return dye.quantum_yield * dye.emission.at(em_nm) / emission_sum * ex_nm / em_nm;
    }

    // InputError for bodies of this transport that the model cannot do.
    virtual void check(const Scene&) const {}

    // What the model ignores or makes of the scene's materials, one line each.
    virtual std::vector<std::string> remarks(const Scene&) const { return {}; }

    // Whether the model takes a body for a half-space; another one takes it as its mesh is, closed or flat.
    virtual bool takes_bodies_for_half_spaces() const { return true; }

    // Whether light that was re-emitted may be taken up again below the same surface.
    virtual bool takes_up_again(bool /*first_collision_only*/) const { return false; }

    // Where light leaves is known from the medium alone, not from tables of a fixed reach.
    virtual bool reaches_any_distance() const { return true; }

    // Its kernels and tables.
    virtual std::unique_ptr<SubsurfaceTransport> make(const Device& device, const Scene& scene,
                                                      const DeviceScene& on_device) const = 0;
};

const TransportModel& transport_model(Transport transport);

// The transport of a body.
Transport transport_of_body(const Scene& scene, int body);

// A material, and the transport of the bodies that have it. Kernels know a material by its index among these: the first
// are the scene's materials, in their order, with the transport of the render; the others are those of bodies of their
// own.
struct MaterialUse {
    int material;
    Transport transport;
};
std::vector<MaterialUse> material_uses(const Scene& scene);

// The models that the scene's materials use, each once.
std::vector<Transport> transports_of(const Scene& scene);

// By shape: index of its material among the uses.
std::vector<std::uint32_t> uses_of_shapes(const Scene& scene);

}  // namespace stokes
