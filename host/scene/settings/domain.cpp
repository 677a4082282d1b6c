#include "host/scene/settings/domain.hpp"

#include <fmt/format.h>

namespace stokes {
namespace {

struct Text {
    std::string operator()(const NumberRange& range) const { return "number " + range.text(); }
    std::string operator()(const IntegerRange& range) const {
        return fmt::format("integer in [{}, {}]", range.low, range.high);
    }
    std::string operator()(const OneWord& one) const { return fmt::format("{}", fmt::join(one.words, "|")); }
    std::string operator()(const YesNo&) const { return "yes or no"; }
    std::string operator()(const NumberOrAuto& number) const { return (*this)(number.range) + " or auto"; }
};

}  // namespace

std::string text_of(const Domain& domain) { return std::visit(Text(), domain); }

}  // namespace stokes
