#include <algorithm>
#include <map>

#include "host/device/kernel.hpp"

namespace stokes {

namespace {

constexpr const char* word_characters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";

std::string without_comments(const std::string& text) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        if (text.compare(at, 2, "//") == 0)
            at = std::min(text.find('\n', at), text.size());
        else if (text.compare(at, 2, "/*") == 0)
            at = std::min(text.find("*/", at), text.size() - 2) + 2;
        else
            result += text[at++];
    }
    return result;
}

// Texts of the macros whose names end in _ARGUMENTS, with their lines joined.
std::map<std::string, std::string> argument_macros(const std::string& source) {
    std::map<std::string, std::string> macros;
    const std::string define = "#define ";
    for (std::size_t at = source.find(define); at != std::string::npos; at = source.find(define, at + 1)) {
        const std::size_t start = at + define.size(), end = source.find_first_not_of(word_characters, start);
        const std::string name = source.substr(start, end - start);
        if (name.size() < 10 || name.compare(name.size() - 10, 10, "_ARGUMENTS") != 0) continue;
        std::string text;
        for (std::size_t i = end; i < source.size() && source[i] != '\n'; ++i) {
            if (source.compare(i, 2, "\\\n") == 0)
                ++i;
            else
                text += source[i];
        }
        macros[name] = text;
    }
    return macros;
}

std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t at = 0; (at = text.find_first_of(word_characters, at)) != std::string::npos;) {
        const std::size_t end = std::min(text.find_first_not_of(word_characters, at), text.size());
        words.push_back(text.substr(at, end - at));
        at = end;
    }
    return words;
}

bool is_qualifier(const std::string& word) {
    for (const char* qualifier : {"__global", "__constant", "__private", "const", "restrict"})
        if (word == qualifier) return true;
    return false;
}

void add_arguments(const std::string& text, const std::map<std::string, std::string>& macros,
                   std::vector<KernelArgument>& arguments) {
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = std::min(text.find(',', start), text.size());
        const std::string piece = text.substr(start, end - start);
        start = end + 1;
        std::vector<std::string> words = words_of(piece);
        if (words.empty()) continue;
        const auto macro = macros.find(words.front());
        if (words.size() == 1 && macro != macros.end()) {
            add_arguments(macro->second, macros, arguments);
            continue;
        }
        words.erase(std::remove_if(words.begin(), words.end(), is_qualifier), words.end());
        if (words.size() < 2) throw RunError("a kernel's argument without a type or a name: " + piece);
        arguments.push_back(
            {words.back(), words[words.size() - 2], piece.find('*') != std::string::npos, name_hash(words.back())});
    }
}

const std::string kernel_start = "__kernel void ";

}  // namespace

std::vector<std::string> kernel_names(const std::string& source) {
    const std::string text = without_comments(source);
    std::vector<std::string> names;
    for (std::size_t at = text.find(kernel_start); at != std::string::npos; at = text.find(kernel_start, at + 1)) {
        const std::size_t start = at + kernel_start.size();
        names.push_back(text.substr(start, text.find('(', start) - start));
    }
    return names;
}

std::vector<KernelArgument> kernel_arguments(const std::string& source, const std::string& kernel) {
    const std::string text = without_comments(source);
    const std::size_t at = text.find(kernel_start + kernel + "(");
    if (at == std::string::npos) throw RunError("no kernel " + kernel + " in the program's text");
    const std::size_t open = text.find('(', at);
    std::vector<KernelArgument> arguments;
    add_arguments(text.substr(open + 1, text.find(')', open) - open - 1), argument_macros(text), arguments);
    return arguments;
}

}  // namespace stokes
