#include "host/core/memory_limit.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

#include "host/core/atomic_file.hpp"
#include "host/core/console.hpp"
#include "host/core/foreign_call.hpp"

namespace stokes {
namespace {

constexpr std::uint64_t no_limit = UINT64_MAX, little = std::uint64_t{512} << 20;

struct Limit {
    std::uint64_t bytes = no_limit;
    const char* flag = "";  // of ulimit
};

Limit smallest_limit() {
    Limit smallest;
    const auto look_at = [&](auto resource, const char* flag) {
        rlimit limit{};
        if (::getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur < smallest.bytes)
            smallest = {limit.rlim_cur, flag};
    };
    look_at(RLIMIT_AS, "-v");
    look_at(RLIMIT_DATA, "-d");
    return smallest;
}

// The most address space that this process has had [bytes]; 0 where the system does not say. Allocates nothing.
std::uint64_t peak_bytes() {
    char text[2048];
    const int file = ::open("/proc/self/status", O_RDONLY | O_CLOEXEC);
    if (file < 0) return 0;
    const ssize_t size = ::read(file, text, sizeof text - 1);
    ::close(file);
    text[std::max<ssize_t>(size, 0)] = '\0';
    const char* peak = std::strstr(text, "VmPeak:");
    return peak == nullptr ? 0 : std::strtoull(peak + std::strlen("VmPeak:"), nullptr, 10) << 10;
}

// Where there is a limit no larger than this. Into a buffer, for where nothing can be allocated.
template <std::size_t size>
const char* limit_text(char (&buffer)[size], std::uint64_t largest) {
    const Limit limit = smallest_limit();
    buffer[0] = '\0';
    if (limit.bytes != no_limit && limit.bytes < largest)
        std::snprintf(buffer, size, "ulimit %s allows %llu MiB", limit.flag,
                      static_cast<unsigned long long>(limit.bytes >> 20));
    return buffer;
}

bool watched = false;
thread_local bool on_main_thread = false;

bool in_foreign_code() { return ForeignCall::on_this_thread() || !on_main_thread; }

[[noreturn]] void end_in_foreign_code() {
    end_for_lack_of_memory(ForeignCall::on_any_thread() ? "the OpenCL driver" : "building the scene");
}

void allocation_failed() {
    if (in_foreign_code()) end_in_foreign_code();
    throw std::bad_alloc();
}

void exception_was_not_caught() {
    try {
        std::rethrow_exception(std::current_exception());
    } catch (const std::bad_alloc&) {
        end_in_foreign_code();
    } catch (...) {
    }
    std::abort();
}

// A driver that does not look at what malloc() gave it.
extern "C" void program_died(int signal) {
    char text[128];
    if (in_foreign_code() && *limit_text(text, peak_bytes() + little) != '\0') end_in_foreign_code();
    std::signal(signal, SIG_DFL);  // what did it is done again, and ends the program
}

// The child of a trial gets less, since the same memory does not always suffice.
void take_memory(std::uint64_t bytes) {
    const auto take = [&](auto resource) {
        rlimit limit{};
        if (::getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
        limit.rlim_cur -= std::min<rlim_t>(bytes, limit.rlim_cur);
        ::setrlimit(resource, &limit);
    };
    take(RLIMIT_AS);
    take(RLIMIT_DATA);
}

constexpr int failed = 1, found_nothing = 2;  // exit codes of the trial

// Says nothing: the parent does.
[[noreturn]] void start_and_exit(bool (*start)()) {
    take_memory(std::uint64_t{64} << 20);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int nothing = ::open("/dev/null", O_WRONLY);
    ::dup2(nothing, STDERR_FILENO);
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS}) std::signal(signal, SIG_DFL);
    try {
        ::_exit(start() ? 0 : found_nothing);
    } catch (...) {
    }
    ::_exit(failed);
}

}  // namespace

bool memory_is_short() { return !memory_limit_text().empty(); }

std::string memory_limit_text() {
    char text[128];
    return limit_text(text, peak_bytes() + little);
}

void end_for_lack_of_memory(const char* doing) {
    char limit[128], line[512];
    limit_text(limit, no_limit);
    std::snprintf(line, sizeof line, "stokes: %s: out of memory%s%s\n", doing, *limit == '\0' ? "" : "; ", limit);
    tell(line);
    remove_temporaries();
    ::_exit(1);
}

void watch_memory() {
    on_main_thread = true;
    std::set_new_handler(allocation_failed);
    std::set_terminate(exception_was_not_caught);
    watched = true;
    renew_memory_watch();
}

void renew_memory_watch() {
    if (!watched) return;
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS}) std::signal(signal, program_died);
}

void check_memory_for_driver(bool (*start)()) {
    constexpr std::uint64_t least = std::uint64_t{128} << 20, ample = std::uint64_t{4} << 30;
    const std::uint64_t limit = smallest_limit().bytes;
    if (limit < least) end_for_lack_of_memory("the OpenCL driver");
    if (limit >= ample) return;
    const pid_t child = ::fork();
    if (child == 0) start_and_exit(start);
    int status = 0;
    const ForeignCall foreign;
    if (child < 0 || ::waitpid(child, &status, 0) != child || status == 0) return;
    if (WIFSIGNALED(status) || WEXITSTATUS(status) == failed) end_for_lack_of_memory("the OpenCL driver");
    if (memory_is_short()) end_for_lack_of_memory("no OpenCL device was found");
}

}  // namespace stokes
