#include "tests/image/reference_renders.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

namespace {

// All comparisons of a picture together may fail once in a thousand choices of the seed.
constexpr double family_level = 1e-3;
constexpr std::uint32_t test_seed = 7;  // the references' are 1000 and above

// Values that differ from the reference by more than noise. The error of a mean over the test's passes is
// estimated from their spread, and from the spread of the reference's renders, which have as many passes: the
// larger counts, for a pixel that few rays see at all may have no spread in one render. Student's t with the
// test's passes less one. factor, swapped: what the negative controls do to the picture.
std::size_t count_differences(const LayerSamples& samples, const Reference& reference, double factor = 1.0,
                              std::array<std::size_t, layer_count> layers = {0, 1, 2, 3}) {
    const double level = sidak_level(family_level, layer_count * reference_values);
    std::size_t failures = 0;
    for (std::size_t c = 0; c < layer_count; ++c)
        for (std::size_t i = 0; i < reference_values; ++i) {
            const Sample& sample = samples[layers[c]][i];
            const double reference_error = reference.standard_error[c][i];
            const double own =
                std::max(factor * sample.standard_error(), reference_error * std::sqrt(reference.renders));
            const double error = std::hypot(own, reference_error);
            const double difference = factor * sample.mean() - reference.mean[c][i];
            if (difference == 0.0) continue;
            if (normal_two_sided(normal_of_t(difference / error, reference_passes - 1.0)) < level) ++failures;
        }
    return failures;
}

}  // namespace

TEST_CASE("renders of the shipped scenes agree with their references", "[references]") {
    for (const ReferenceSetting& setting : reference_settings) {
        CAPTURE(setting.name);
        const Reference reference = read_reference(setting);
        Renderer renderer(test_device(), reference_scene(setting, test_seed));
        PassImages images(renderer);
        LayerSamples samples;
        for (std::uint32_t pass = 0; pass < reference_passes; ++pass) add_values(samples, images.next(pass));
        for (std::size_t c = 0; c < layer_count; ++c) {
            const Sample& picture = samples[c][reference_values - 2];
            UNSCOPED_INFO(layer_rows[c].name << ": mean Y " << picture.mean() << " +- " << picture.standard_error()
                                             << ", reference " << reference.mean[c][reference_values - 2] << " +- "
                                             << reference.standard_error[c][reference_values - 2]);
        }
        CHECK(count_differences(samples, reference) == 0);
        // The comparison must be able to fail: for a picture 3 % darker, and for layers in each other's
        // place.
        CHECK(count_differences(samples, reference, 0.97) > 0);
        CHECK(count_differences(samples, reference, 1.0, {2, 1, 0, 3}) > 20);
        CHECK(count_differences(samples, reference, 1.0, {0, 2, 1, 3}) > 20);
        CHECK(count_differences(samples, reference, 1.0, {0, 1, 3, 2}) > 20);
    }
}

// Run by scripts/make_references alone.
TEST_CASE("the references are written", "[.make_references]") {
    for (const ReferenceSetting& setting : reference_settings) {
        LayerSamples samples;
        for (std::uint32_t render = 0; render < reference_renders; ++render) {
            Scene scene = reference_scene(setting, first_reference_seed + render);
            scene.render.emission = Emission::random;  // the test's photons are aimed
            Renderer renderer(test_device(), scene);
            for (std::uint32_t pass = 0; pass < reference_passes; ++pass) renderer.render_pass(pass);
            add_values(samples, renderer.image());
        }
        write_reference(setting, samples);
        CHECK(read_reference(setting).renders == reference_renders);
    }
}
