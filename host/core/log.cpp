#include "host/core/log.hpp"

#include <mutex>
#include <set>

#include "host/core/console.hpp"

namespace stokes {

void warn(const std::string& text) {
    static std::mutex mutex;
    static std::set<std::string> said;
    const std::lock_guard<std::mutex> lock(mutex);
    if (said.insert(text).second) tell("stokes: warning: " + text + "\n");
}

}  // namespace stokes
