#include "host/commands/number_in.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stokes {

CLI::Validator number_in(double low, double high) {
    const std::string range = fmt::format("{} to {}", low, high);
    const auto check = [=](const std::string& text) {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return std::string();
        return fmt::format("expected a number, {}, got \"{}\"", range, text);
    };
    return CLI::Validator(check, range);
}

CLI::Validator one_of_words(const std::vector<std::string>& words) {
    const auto check = [words](const std::string& text) {
        if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
        return fmt::format("expected {}, got \"{}\"", fmt::join(words, ", "), text);
    };
    return CLI::Validator(check, fmt::format("{}", fmt::join(words, ", ")));
}

CLI::Validator output_name() {
    return CLI::Validator(
        [](const std::string& text) {
            return std::string(text.empty() ? "expected the name of a file, got \"\"" : "");
        },
        "");
}

}  // namespace stokes
