#include "host/scene/settings/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "host/scene/settings/settings.hpp"

namespace stokes {
namespace {

using Json = nlohmann::ordered_json;

std::string as_text(const Json& value) {
    if (value.is_boolean()) return value ? "yes" : "no";
    if (value.is_string()) return value;
    return value.is_number_float() ? fmt::format("{:.6g}", value.get<double>()) : value.dump();
}

Json default_for(const Setting& setting, Transport transport, Sampling sampling) {
    RenderSettings given;
    given.transport = transport;
    given.sampling = sampling;
    return setting.fallback(resolved(given));
}

// "importance, for transport paper uniform": what most transports have, then those that have another.
std::string default_text(const Setting& setting, Sampling sampling) {
    std::map<std::string, int> count;
    for (const Transport t : setting.traits.transports) ++count[as_text(default_for(setting, t, sampling))];
    const Transport last = setting.traits.transports.back();
    std::string usual = as_text(default_for(setting, last, sampling));
    for (const auto& [text, n] : count)
        if (n > count[usual]) usual = text;
    std::string result = usual;
    for (const Transport t : setting.traits.transports) {
        const std::string own = as_text(default_for(setting, t, sampling));
        if (own != usual) result += fmt::format(", for transport {} {}", word_of(t), own);
    }
    return result;
}

std::string transport_list(const std::vector<Transport>& transports, const char* quote) {
    std::string result;
    for (const Transport t : transports)
        result += fmt::format("{}{}{}{}", result.empty() ? "" : " or ", quote, word_of(t), quote);
    return result;
}

}  // namespace

std::string Setting::flag() const { return flags.substr(0, flags.find(',')); }

Json Setting::constant_default() const {
    const Json first = default_for(*this, traits.transports.front(), Sampling::best);
    for (const Transport t : traits.transports)
        for (const Sampling s : {Sampling::plain, Sampling::best})
            if (default_for(*this, t, s) != first) return {};
    return first;
}

std::string Setting::sentence() const {
    std::string text = help;
    if (traits.transports.size() < all_transports.size())
        text += fmt::format("; only transport {}", transport_list(traits.transports, ""));
    if (!traits.otherwise.empty()) return text + "; default: " + traits.otherwise;
    if (const Json constant = constant_default(); !constant.is_null()) return text + "; default: " + as_text(constant);
    const std::string best = default_text(*this, Sampling::best), plain = default_text(*this, Sampling::plain);
    return text + "; default: " + best + (plain == best ? "" : "; with plain sampling " + plain);
}

std::string Setting::complaint(const ResolvedSettings& settings) const {
    const auto& have = traits.transports;
    if (std::find(have.begin(), have.end(), settings.transport) == have.end())
        return fmt::format("expected transport {}, got \"{}\"", transport_list(have, "\""),
                           word_of(settings.transport));
    return traits.needs_tables && !settings.tables ? "expected power tables, got none" : "";
}

}  // namespace stokes
