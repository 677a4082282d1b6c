#include "host/commands/number_in.hpp"

#include <fmt/core.h>

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

}  // namespace stokes
