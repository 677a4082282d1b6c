#include "host/core/log.hpp"

#include <cstdio>
#include <mutex>
#include <set>

namespace stokes {

void warn(const std::string& text) {
    static std::mutex mutex;
    static std::set<std::string> said;
    const std::lock_guard<std::mutex> lock(mutex);
    if (said.insert(text).second) std::fprintf(stderr, "stokes: warning: %s\n", text.c_str());
}

}  // namespace stokes
