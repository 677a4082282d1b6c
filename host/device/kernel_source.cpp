#include <set>
#include <sstream>

#include "host/core/embedded.hpp"
#include "host/core/text_input.hpp"
#include "host/device/kernel.hpp"

namespace stokes {

namespace {

void expand(const std::string& name, const std::string& text, const std::string& directory,
            std::set<std::string>& known, std::string& out) {
    std::istringstream lines(text);
    std::string line;
    const std::string folder = name.substr(0, name.rfind('/') + 1);  // of the including file; "" at the top
    out += "#line 1 \"kernels/" + name + "\"\n";
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::size_t hash = line.find_first_not_of(" \t");
        if (hash != std::string::npos && line.compare(hash, 10, "#include \"") == 0) {
            const std::size_t first = hash + 10;
            const std::string written = line.substr(first, line.find('"', first) - first);
            const std::string included = written.find('/') == std::string::npos ? folder + written : written;
            if (known.insert(included).second) {
                expand(included, read_kernel_file(included, directory), directory, known, out);
                out += "#line " + std::to_string(number + 1) + " \"kernels/" + name + "\"\n";
            } else {
                out += '\n';
            }
        } else {
            out += line;
            out += '\n';
        }
    }
}

}  // namespace

std::string read_kernel_file(const std::string& file, const std::string& directory) {
    if (directory.empty()) {
        const auto found = embedded_files().find("kernels/" + file);
        if (found == embedded_files().end()) throw RunError("kernel file kernels/" + file + " is not in this program");
        return found->second;
    }
    return read_file(directory + "/" + file);
}

std::string expand_kernel_source(const std::string& name, const std::string& text, const std::string& directory) {
    std::set<std::string> known{name};
    std::string out;
    expand(name, text, directory, known, out);
    return out;
}

}  // namespace stokes
