// The table of settings.
#pragma once

#include "host/scene/settings/setting.hpp"

namespace stokes {

// One row a setting; it comes after those that its default depends on.
const std::vector<Setting>& settings();

}  // namespace stokes
