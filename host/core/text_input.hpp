// Reading whole files and taking text apart: what the readers of JSON, CSV, PLY and OBJ have in common.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace stokes {

// The bytes of a regular file. Throws InputError "PATH: cannot read: REASON", also when they do not fit into
// memory.
std::string read_file(const std::string& path);

// The paths that read_file() was asked for so far: what an output must not replace.
std::set<std::string> files_read();

// A whole token as a number, in the C locale whatever the environment says; "nan" and "inf" parse, so callers
// check std::isfinite. None: not a number, or something follows it.
std::optional<double> parse_double(std::string_view token);
std::optional<std::int64_t> parse_integer(std::string_view token);

// Text from a file, made fit for a one-line message: control characters and bytes that are no UTF-8 replaced, cut after
// 40 characters.
std::string printable(std::string_view text);

// The candidate that was probably meant by name (a slip of a letter or two, another case, a missing unit), or
// "".
template <typename Names>
std::string closest_name(std::string_view name, const Names& candidates);
// Number of single-character edits from a to b, letter case ignored.
std::size_t edit_distance(std::string_view a, std::string_view b);

// Walks a text line by line and token by token (tokens are separated by blanks), counting lines.
class TextScanner {
  public:
    explicit TextScanner(std::string_view text) : rest_(text) {}
    // Next token of the current line; empty at its end.
    std::string_view token();
    // Next token wherever it is, skipping line ends; empty at the end of the text.
    std::string_view token_across_lines();
    // Remaining part of the current line without its line end; the scanner moves to the next line.
    std::string_view take_line();
    bool at_end() const { return rest_.empty(); }
    std::int64_t line() const { return line_; }
    std::string_view rest() const { return rest_; }

  private:
    std::string_view rest_;
    std::int64_t line_ = 1;
};

template <typename Names>
std::string closest_name(std::string_view name, const Names& candidates) {
    std::string best;
    std::size_t best_distance = name.size() / 3 < 2 ? 2 : name.size() / 3;
    for (const std::string& candidate : candidates) {
        const bool starts_alike = name.size() >= 3 && candidate.compare(0, name.size(), name) == 0;
        const std::size_t distance = starts_alike ? 1 : edit_distance(name, candidate);
        if (distance > best_distance || distance >= candidate.size()) continue;
        if (!best.empty() && distance == best_distance) continue;
        best = candidate;
        best_distance = distance;
    }
    return best;
}

}  // namespace stokes
