#include "host/image/compare.hpp"

#include <fmt/format.h>

#include <memory>

#include "host/commands/commands.hpp"
#include "host/commands/compare_output.hpp"
#include "host/commands/number_in.hpp"
#include "host/commands/outputs.hpp"
#include "host/core/console.hpp"
#include "host/core/error.hpp"
#include "host/image/exr.hpp"
#include "host/image/png.hpp"

namespace stokes {

namespace {

struct CompareOptions {
    std::string picture_file, reference_file, layer, diff_file;
    double tolerance = 0.0, diff_max = 0.0;
    bool json = false;
};

void check_same_layers(const CompareOptions& options, const ExrImage& picture, const ExrImage& reference) {
    std::string text;
    const auto check = [&](const ExrImage& has, const ExrImage& has_not, const std::string& file,
                           const std::string& other) {
        const auto layers = missing_layers(layers_in_order(has.layers), has_not.layers);
        if (!layers.empty())
            text += fmt::format("{}{}: no layer {}, which {} has", text.empty() ? "" : "; ", file, shown_layers(layers),
                                other);
    };
    check(picture, reference, options.reference_file, options.picture_file);
    check(reference, picture, options.picture_file, options.reference_file);
    if (!text.empty()) throw InputError(text);
}

// The layer of --layer, which both must have, or all of them.
std::vector<std::string> chosen_layers(const CompareOptions& options, const ExrImage& picture,
                                       const ExrImage& reference) {
    if (options.layer.empty()) {
        check_same_layers(options, picture, reference);
        return layers_in_order(picture.layers);
    }
    const std::string layer = options.layer == shown_layer("") ? "" : options.layer;
    for (const auto& [image, file] :
         {std::pair(&picture, &options.picture_file), std::pair(&reference, &options.reference_file)})
        if (image->layers.count(layer) == 0)
            throw InputError(fmt::format("--layer: no \"{}\" in {}; there are: {}", options.layer, *file,
                                         shown_layers(layers_in_order(image->layers))));
    return {layer};
}

void check_same_size(const CompareOptions& options, const ExrImage& picture, const ExrImage& reference) {
    if (picture.width != reference.width || picture.height != reference.height)
        throw InputError(fmt::format("expected pictures of the same size; {} has {} x {} pixels, {} {} x {}",
                                     options.picture_file, picture.width, picture.height, options.reference_file,
                                     reference.width, reference.height));
    const PictureFrame &a = picture.frame, &b = reference.frame;
    if (a.left != b.left || a.top != b.top || a.width != b.width || a.height != b.height)
        throw InputError(
            fmt::format("expected pictures of the same window; {} holds {} x {} pixels from ({}, {}) of a "
                        "picture of {} x {}, {} from ({}, {}) of {} x {}",
                        options.picture_file, picture.width, picture.height, a.left, a.top, a.width, a.height,
                        options.reference_file, b.left, b.top, b.width, b.height));
}

void write_map(const Comparison& comparison) {
    write_png(comparison.diff_file, comparison.diff.image,
              {{"Software", "stokes " STOKES_VERSION},
               {"Source", comparison.picture + " against " + comparison.reference},
               {"Description", scale_text(comparison.diff, comparison.diff_layer)},
               {"stokes.errorTo_cd_m2", fmt::format("{:.8g}", comparison.diff.largest_shown)}});
}

void compare(const CLI::App& command, const CompareOptions& options) {
    check_outputs({options.diff_file}, "");
    check_keeps({options.diff_file}, options.picture_file, "a picture that is compared");
    check_keeps({options.diff_file}, options.reference_file, "a picture that is compared");
    check_endings({{"--diff", options.diff_file, ".png"}});
    const ExrImage picture = read_exr(options.picture_file), reference = read_exr(options.reference_file);
    check_same_size(options, picture, reference);
    const std::vector<std::string> layers = chosen_layers(options, picture, reference);

    Comparison comparison;
    comparison.picture = options.picture_file;
    comparison.reference = options.reference_file;
    comparison.width = picture.width;
    comparison.height = picture.height;
    if (command.count("--tolerance")) comparison.tolerance = options.tolerance;
    for (const std::string& layer : layers)
        comparison.layers.emplace_back(
            shown_layer(layer), compare_layer(picture.layers.at(layer), reference.layers.at(layer), picture.width));
    if (!options.diff_file.empty()) {
        const std::string& layer = layers.front();
        std::optional<double> largest;
        if (command.count("--diff-max")) largest = options.diff_max;
        comparison.diff_file = options.diff_file;
        comparison.diff_layer = shown_layer(layer);
        comparison.diff =
            draw_errors(pixel_errors(picture.layers.at(layer), reference.layers.at(layer)), picture.width, largest);
        write_map(comparison);
    }
    print(options.json ? comparison_json(comparison) : comparison_table(comparison));
    if (!options.json && !options.diff_file.empty())
        print(fmt::format("{}: {}\n", options.diff_file, scale_text(comparison.diff, comparison.diff_layer)));
    const std::string complaint = comparison.complaint();
    if (!complaint.empty()) throw RunError(complaint);
}

}  // namespace

void add_compare_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "compare", "Measure how far a picture is from a reference, by layer, in X, Y and Z [cd/m^2]");
    const auto options = std::make_shared<CompareOptions>();
    command->add_option("picture", options->picture_file, "Picture")->required()->type_name("A.exr");
    command->add_option("reference", options->reference_file, "Reference of the same size and layers")
        ->required()
        ->type_name("B.exr");
    command->add_option("--layer", options->layer, "This layer alone; \"whole\" is R, G, B; default: all")
        ->type_name("NAME");
    command->add_flag("--json", options->json, "Print JSON");
    command
        ->add_option("--tolerance", options->tolerance,
                     "Exit with 1 when a layer's RMSE over the mean of the reference's absolute values is larger")
        ->type_name("T")
        ->check(number_in(0.0, 1e12));
    CLI::Option* diff =
        command->add_option("--diff", options->diff_file, "Map of the error of --layer, or of the whole, in colours")
            ->type_name("OUT.png")
            ->check(output_name());
    command
        ->add_option("--diff-max", options->diff_max,
                     "Error that has the map's last colour [cd/m^2]; default: the 99th percentile")
        ->type_name("X")
        ->check(number_in(1e-30, 1e30))
        ->needs(diff);
    command->callback([command, options] { compare(*command, *options); });
}

}  // namespace stokes
