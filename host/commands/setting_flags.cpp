#include "host/commands/setting_flags.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "host/core/error.hpp"
#include "host/scene/settings/settings.hpp"

namespace stokes {

namespace {

JsonValue number(double value) {
    JsonValue result;
    result.type = JsonValue::Type::number;
    result.number = value;
    return result;
}

// A number where the text is one, as a scene file would have it.
JsonValue value_of(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (!text.empty() && *end == '\0' && text.find_first_not_of("+-.0123456789eE") == std::string::npos)
        return number(value);
    JsonValue result;
    result.type = JsonValue::Type::string;
    result.text = text;
    return result;
}

void add_yes_no(CLI::App& command, FlagValues& flags, const Setting& setting) {
    const std::string yes = setting.flag(), no = setting.flags.substr(setting.flags.find('!') + 1);
    const auto take = [&flags, key = setting.key, yes, no](std::int64_t count) {
        JsonValue value;
        value.type = JsonValue::Type::boolean;
        value.boolean = count > 0;
        flags[key] = {count > 0 ? yes : no, value};
    };
    command.add_flag_function(setting.flags, take, setting.sentence());
}

}  // namespace

void add_setting_flags(CLI::App& command, FlagValues& flags, const std::vector<std::string>& keys) {
    for (const Setting& setting : settings()) {
        if (!keys.empty() && std::find(keys.begin(), keys.end(), setting.key) == keys.end()) continue;
        if (std::holds_alternative<YesNo>(setting.domain)) {
            add_yes_no(command, flags, setting);
            continue;
        }
        const auto take = [&flags, key = setting.key, flag = setting.flag()](const std::string& text) {
            flags[key] = {flag, value_of(text)};
        };
        command.add_option_function<std::string>(setting.flags, take, setting.sentence())
            ->type_name(text_of(setting.domain));
    }
}

void add_size_flag(CLI::App& command, FlagValues& flags) {
    const auto take = [&flags](const std::string& text) {
        char rest = 0;
        int width = 0, height = 0;
        if (std::sscanf(text.c_str(), "%5dx%5d%c", &width, &height, &rest) != 2)
            throw InputError("--size: expected WIDTHxHEIGHT in pixels, got \"" + text + "\"");
        flags["width"] = {"--size", number(width)};
        flags["height"] = {"--size", number(height)};
    };
    command.add_option_function<std::string>("--size", take, "Width and height of the picture in pixels")
        ->type_name("WxH");
}

}  // namespace stokes
