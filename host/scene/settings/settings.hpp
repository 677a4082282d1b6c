// The table of settings.
#pragma once

#include "host/scene/settings/setting.hpp"

namespace stokes {

// One row a setting; it comes after those that its default, or whether it means something, depends on: transport,
// sampling and tables stand before the others. resolved() goes through them in this order.
const std::vector<Setting>& settings();

}  // namespace stokes
