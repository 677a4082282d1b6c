// A key that a scene gives and that has an effect in some transports only.
#pragma once

#include <string>
#include <vector>

#include "host/scene/settings/render_settings.hpp"

namespace stokes {

struct LimitedKey {
    std::string name;
    std::vector<Transport> transports;  // in which it has one
};

}  // namespace stokes
