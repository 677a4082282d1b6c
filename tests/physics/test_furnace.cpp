#include <cmath>
#include <utility>

#include "host/image/colour.hpp"
#include "host/render/renderer.hpp"
#include "host/render/wavelengths.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

// Every point of a closed diffuse enclosure that emits 1 and reflects R has radiance 1 + R + R^2 .. = 1 / (1 - R)
// (PHYSICS section 7). The film's Y of a radiance L constant over wavelength is, in a pass with the set of wavelengths
// that was drawn, 683.002 L N/n sum of ybar over the set: no noise from the wavelengths is left in the comparison.
TEST_CASE("radiance in a closed furnace is 1 / (1 - R)", "[furnace]") {
    for (const auto& [reflectance, direct] :
         {std::pair(0.0, Direct::photons), std::pair(0.5, Direct::photons), std::pair(0.8, Direct::photons),
          std::pair(0.0, Direct::rays), std::pair(0.5, Direct::rays), std::pair(0.8, Direct::rays)}) {
        const bool rays = direct == Direct::rays;
        CAPTURE(reflectance, rays);
        Scene scene = furnace_scene(reflectance);
        scene.render.direct = direct;
        scene.render.radius_mm = 6.0;
        Renderer renderer(test_device(), scene);
        double weight = 0.0;
        const std::uint32_t passes = 4;
        for (std::uint32_t pass = 0; pass < passes; ++pass) {
            renderer.render_pass(pass);
            for (const int lambda : draw_wavelengths(scene.render.seed, pass, 300, 780))
                weight += luminous_efficacy * image_weight_nm(300, 780) * cie1931().y.at(lambda) / passes;
        }
        const FilmImage image = renderer.image();
        Sample radiance;
        for (std::size_t i = 0; i < image.pixels(); ++i) {
            double y = 0.0;
            for (const auto& layer : image.xyz) y += static_cast<double>(layer[i * 3 + 1]);
            radiance.add(y / weight);
        }
        const double expected = 1.0 / (1.0 - reflectance);
        CAPTURE(radiance.mean(), radiance.standard_error());
        // Pixels share photons, so the spread over pixels understates the error of their mean; the bound is that of
        // the roughly 1e5 photons a pass, plus the facets of the sphere.
        CHECK(radiance.mean() == Approx(expected).epsilon(0.01));
        const Balance ledger = renderer.book().ledger().power;
        CHECK(std::abs(ledger.imbalance()) < 1e-4);
        CHECK(ledger.escaped == 0.0);
        // Each photon is stored once at every event: the flux that arrives is emitted / (1 - R). By rays, but for the
        // first.
        CHECK(ledger.stored == Approx(ledger.emitted * (rays ? expected - 1.0 : expected)).epsilon(0.02));
    }
}
