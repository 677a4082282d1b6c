#include "host/core/json_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>

#include "host/core/error.hpp"
#include "host/core/text_input.hpp"

namespace stokes {
namespace {

constexpr std::size_t max_depth = 32;

struct LineCount {
    int line = 1;             // of the next character
    bool line_ended = false;  // the last character taken was a line end
};

// Hands characters to the parser and counts the lines that went by.
class CountingIterator {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingIterator(const char* at, LineCount* count) : at_(at), count_(count) {}
    reference operator*() const { return *at_; }
    CountingIterator& operator++() {
        count_->line_ended = *at_ == '\n';
        if (count_->line_ended) ++count_->line;
        ++at_;
        return *this;
    }
    bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
    bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

  private:
    const char* at_;
    LineCount* count_;
};

class TreeBuilder {
  public:
    TreeBuilder(std::string_view text, const std::string& file, const LineCount& count)
        : text_(text), file_(file), count_(count) {}

    bool null() { return add(make(JsonValue::Type::null)); }
    bool boolean(bool value) {
        JsonValue result = make(JsonValue::Type::boolean);
        result.boolean = value;
        return add(std::move(result));
    }
    bool number_integer(std::int64_t value) { return number(static_cast<double>(value)); }
    bool number_unsigned(std::uint64_t value) { return number(static_cast<double>(value)); }
    bool number_float(double value, const std::string&) { return number(value); }
    bool string(std::string& value) {
        JsonValue result = make(JsonValue::Type::string);
        result.text = std::move(value);
        return add(std::move(result));
    }
    bool binary(std::vector<std::uint8_t>&) { return false; }
    bool start_object(std::size_t) { return open(JsonValue::Type::object); }
    bool start_array(std::size_t) { return open(JsonValue::Type::array); }
    bool key(std::string& name) {
        open_.back().keys.push_back({std::move(name), count_.line});
        return true;
    }
    bool end_object() {
        reject_duplicate_keys(open_.back());
        return close();
    }
    bool end_array() { return close(); }
    bool parse_error(std::size_t position, const std::string& last_token, const nlohmann::json::exception& error);

    JsonValue take_root() { return std::move(root_); }

  private:
    JsonValue make(JsonValue::Type type) const {
        JsonValue result;
        result.type = type;
        result.line = count_.line;
        return result;
    }
    bool number(double value) {
        JsonValue result = make(JsonValue::Type::number);
        result.number = value;
        // The parser sees that a number is complete by the character after it.
        if (count_.line_ended) --result.line;
        return add(std::move(result));
    }
    bool open(JsonValue::Type type) {
        if (open_.size() >= max_depth) fail(count_.line, "values nested deeper than 32");
        open_.push_back(make(type));
        return true;
    }
    bool close() {
        JsonValue done = std::move(open_.back());
        open_.pop_back();
        return add(std::move(done));
    }
    bool add(JsonValue&& value) {
        if (open_.empty()) {
            root_ = std::move(value);
        } else {
            open_.back().items.push_back(std::move(value));
        }
        return true;
    }
    void reject_duplicate_keys(const JsonValue& object) const;
    [[noreturn]] void fail(int line, const std::string& what) const {
        throw InputError(file_ + ":" + std::to_string(line) + ": " + what);
    }

    std::string_view text_;
    const std::string& file_;
    const LineCount& count_;
    std::vector<JsonValue> open_;
    JsonValue root_;
};

void TreeBuilder::reject_duplicate_keys(const JsonValue& object) const {
    std::vector<const JsonKey*> sorted;
    for (const JsonKey& key : object.keys) sorted.push_back(&key);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const JsonKey* a, const JsonKey* b) { return a->name < b->name; });
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end(),
                                          [](const JsonKey* a, const JsonKey* b) { return a->name == b->name; });
    if (twice == sorted.end()) return;
    fail((*std::next(twice))->line,
         "key \"" + printable((*twice)->name) + "\" given twice, first in line " + std::to_string((*twice)->line));
}

bool TreeBuilder::parse_error(std::size_t position, const std::string& last_token,
                              const nlohmann::json::exception& error) {
    const std::size_t before = std::min(position == 0 ? 0 : position - 1, text_.size());
    const auto lines = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(before), '\n');
    if (error.id == 406) fail(static_cast<int>(lines), "number out of range: " + printable(last_token));
    std::string what = error.what();
    const std::size_t begin = what.find("syntax error");
    if (begin != std::string::npos) what.erase(0, begin);
    what.resize(std::min(what.size(), what.find("; last read")));
    fail(static_cast<int>(lines), "JSON " + what + ", at \"" + printable(last_token) + "\"");
}

}  // namespace

JsonValue parse_json(std::string_view text, const std::string& file) {
    LineCount count;
    TreeBuilder builder(text, file, count);
    const CountingIterator first(text.data(), &count);
    const CountingIterator last(text.data() + text.size(), &count);
    nlohmann::json::sax_parse(first, last, &builder);
    return builder.take_root();
}

}  // namespace stokes
