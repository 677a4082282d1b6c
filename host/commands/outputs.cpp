#include "host/commands/outputs.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <system_error>

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"

namespace stokes {

namespace {

namespace fs = std::filesystem;

bool same_file(const std::string& a, const std::string& b) {
    std::error_code error_a, error_b;
    const fs::path place_a = fs::weakly_canonical(fs::absolute(a), error_a);
    const fs::path place_b = fs::weakly_canonical(fs::absolute(b), error_b);
    return a == b || (!error_a && !error_b && place_a == place_b);
}

}  // namespace

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

void write_outputs(const std::vector<Output>& outputs, bool quiet) {
    std::exception_ptr first;
    for (const Output& output : outputs) {
        if (output.file.empty()) continue;
        try {
            output.write();
            if (!quiet) fmt::print("{}\n", output.file);
        } catch (const std::exception& error) {
            if (first)
                fmt::print(stderr, "stokes: {}\n", error.what());
            else
                first = std::current_exception();
        }
    }
    if (first) std::rethrow_exception(first);
}

}  // namespace stokes
