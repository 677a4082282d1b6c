#include "host/commands/outputs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

#include "host/core/atomic_file.hpp"
#include "host/core/console.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/text_input.hpp"

namespace stokes {

namespace {

namespace fs = std::filesystem;

bool same_file(const std::string& a, const std::string& b) {
    std::error_code error_a, error_b;
    const fs::path place_a = fs::weakly_canonical(fs::absolute(a), error_a);
    const fs::path place_b = fs::weakly_canonical(fs::absolute(b), error_b);
    return a == b || (!error_a && !error_b && place_a == place_b);
}

// Endings of formats that people keep pictures, spectra, scenes and meshes in.
constexpr const char* known_endings[] = {
    ".avif", ".bmp",  ".csv",  ".dpx", ".exr",  ".gif", ".gltf", ".gz",   ".hdr",  ".heic", ".html", ".ico",
    ".jp2",  ".jpeg", ".jpg",  ".jxl", ".log",  ".obj", ".pbm",  ".pdf",  ".pfm",  ".pgm",  ".ply",  ".png",
    ".pnm",  ".ppm",  ".psd",  ".raw", ".spd",  ".stl", ".svg",  ".tga",  ".tif",  ".tiff", ".tsv",  ".txt",
    ".webp", ".xls",  ".xlsx", ".xml", ".yaml", ".yml", ".zip",  ".json", ".jsonl"};

std::string format_of(const std::string& ending) {
    if (ending == ".exr") return "an OpenEXR picture";
    if (ending == ".png") return "a PNG picture";
    if (ending == ".csv") return "a table, CSV";
    return ending == ".json" ? "JSON" : "JSON that is compressed by gzip";
}

bool ends_with(const std::string& text, const std::string& end) {
    return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

}  // namespace

void check_endings(const std::vector<OutputName>& outputs) {
    for (const OutputName& output : outputs) {
        if (output.file == "-")
            throw InputError(fmt::format("{}: expected the name of a file, got \"-\"", output.flag));
        const std::string name = lower(fs::path(output.file).filename().string());
        const std::string ending = fs::path(name).extension().string();
        if (ending.size() < 2 || ends_with(name, output.ending)) continue;
        const std::string text = fmt::format("{}: {} writes {}; expected a name that ends in {}", output.file,
                                             output.flag, format_of(output.ending), output.ending);
        if (std::find(std::begin(known_endings), std::end(known_endings), ending) != std::end(known_endings))
            throw InputError(text);
        warn(text);
    }
}

void check_keeps_inputs(const std::vector<std::string>& outputs) {
    for (const std::string& file : files_read()) check_keeps(outputs, file, "a file that is read");
}

void check_keeps(const std::vector<std::string>& outputs, const std::string& input, const std::string& what) {
    if (input.empty()) return;
    for (const std::string& file : outputs)
        if (!file.empty() && same_file(file, input)) throw InputError(file + ": this output would replace " + what);
}

void check_outputs(const std::vector<std::string>& outputs, const std::string& scene) {
    check_keeps(outputs, scene, "the scene");
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const std::string& file = outputs[i];
        if (file.empty()) continue;
        for (std::size_t j = 0; j < i; ++j)
            if (!outputs[j].empty() && same_file(file, outputs[j]))
                throw InputError(file + ": expected another file for each output");
        try {
            check_can_be_written(file);
        } catch (const RunError& error) {
            throw InputError(error.what());
        }
    }
}

bool Attempts::take(const std::function<void()>& step) {
    try {
        step();
        return true;
    } catch (const std::exception& error) {
        if (first_)
            tell(fmt::format("stokes: {}\n", error.what()));
        else
            first_ = std::current_exception();
        return false;
    }
}

void Attempts::finish() const {
    if (first_) std::rethrow_exception(first_);
}

void write_outputs(const std::vector<Output>& outputs, bool quiet) {
    Attempts attempts;
    std::string written;
    for (const Output& output : outputs)
        if (!output.file.empty() && attempts.take(output.write)) written += output.file + "\n";
    if (!quiet) note(written);
    attempts.finish();
}

}  // namespace stokes
