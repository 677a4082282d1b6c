#include "host/core/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>

#include "host/core/csv_dialect.hpp"
#include "host/core/csv_headings.hpp"
#include "host/core/error.hpp"
#include "host/core/text_encoding.hpp"
#include "host/core/text_input.hpp"

namespace stokes {
namespace {

using Cells = std::vector<CsvCell>;

struct Line {
    std::int64_t number;
    std::string text;
};

// What stands before the first row.
struct Preamble {
    std::vector<Line> lines, comments;
};

bool starts_with(const std::string& text, std::string_view what) { return text.compare(0, what.size(), what) == 0; }

// A spreadsheet may have put a comment into quotes.
bool is_comment(const std::string& text) {
    return std::any_of(text.begin(), text.end(), [](char c) { return c != ' ' && c != '\t'; }) &&
           (starts_with(text, "#") || starts_with(text, "%") || starts_with(text, "!") || starts_with(text, "//") ||
            starts_with(text, "\"#"));
}

bool has_letters(const std::string& text) {
    return std::any_of(text.begin(), text.end(),
                       [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c < 0; });
}

std::string without_mark(std::string comment) {
    if (starts_with(comment, "\"")) comment.erase(0, 1);
    const char mark = comment.empty() ? '#' : comment[0];
    comment.erase(0, std::min(comment.find_first_not_of(mark), comment.size()));
    comment.erase(0, std::min(comment.find_first_not_of(" \t"), comment.size()));
    return comment;
}

bool is_empty(const std::string& text) { return text.find_first_not_of(" \t,;|\"") == std::string::npos; }

// Begin and end of the spectrum in files of spectrometers: ">>>>>Begin Spectral Data<<<<<".
bool is_mark(const std::string& text) { return starts_with(text, ">>>"); }

class TableReader {
  public:
    explicit TableReader(const std::string& file) { table_.file = file; }

    CsvTable read(const std::string& text) {
        TextScanner scanner(text);
        Preamble before;
        bool ended = false;
        while (!scanner.at_end() && !ended) {
            Line line{scanner.line(), std::string(scanner.take_line())};
            line.text.erase(0, line.text.find_first_not_of(' '));
            if (before.lines.empty() && before.comments.empty()) refuse_other_formats(line);
            if (is_empty(line.text)) continue;
            if (is_comment(line.text)) {
                if (table_.lines.empty() && has_letters(line.text)) before.comments.push_back(line);
            } else if (table_.lines.empty() && !start_table(line, before)) {
                before.lines.push_back(line);
            } else if (!table_.lines.empty() && is_mark(line.text)) {
                ended = true;
            } else {
                add_row(line);
            }
        }
        if (table_.lines.empty()) fail(scanner.line(), "expected a line of column names and rows of numbers");
        refuse_thousands();
        return std::move(table_);
    }

  private:
    [[noreturn]] void fail(std::int64_t line, const std::string& what) const {
        throw InputError(fmt::format("{}:{}: {}", table_.file, line, what));
    }

    void refuse_other_formats(const Line& line) const {
        if (starts_with(line.text, "{") || starts_with(line.text, "<"))
            fail(line.number, "expected a table, got JSON, XML or HTML");
        if (starts_with(line.text, "##TITLE=")) fail(line.number, "expected a table, got JCAMP-DX; export it as CSV");
    }

    // Whether the line is the first row; if so, the table has its columns.
    bool start_table(const Line& line, const Preamble& before) {
        const auto separator = separator_of_row(line.text);
        if (!separator) {
            if (starts_with_number(line.text))
                fail(line.number, fmt::format("expected a wavelength and at least one more number, got \"{}\"",
                                              printable(line.text)));
            return false;
        }
        separator_ = *separator;
        const Cells first = csv_cells(line.text, separator_);
        if (!before.lines.empty()) refuse_mixed_separators(line, first, before.lines.back());
        std::optional<Cells> names;
        if (!before.lines.empty()) names = names_in(before.lines, line, first);
        if (!names && !before.comments.empty()) names = names_in_comment(before.comments, first.size());
        if (names && names->size() > 2 && names->back().text.empty() && first.back().text.empty()) names->pop_back();
        table_.named = names.has_value();
        const std::size_t columns =
            names ? names->size() : first.size() - (first.size() > 2 && first.back().blank ? 1 : 0);
        for (std::size_t i = 0; i < columns; ++i)
            table_.columns.push_back(names ? (*names)[i].text : fmt::format("{}", i + 1));
        table_.values.resize(columns);
        keep_headings(before);
        const auto other = std::find_if(table_.columns.begin() + 1, table_.columns.end(), names_wavelengths);
        has_other_wavelengths_ = other != table_.columns.end();
        table_.wavelengths_first = !has_other_wavelengths_ || names_wavelengths(table_.columns[0]);
        return true;
    }

    void keep_headings(const Preamble& before) {
        table_.headings.resize(table_.columns.size());
        const auto keep = [&](const std::string& text, bool has_names) {
            for (const char separator : csv_separators) {
                Cells cells = csv_cells(text, separator);
                while (cells.size() > table_.columns.size() && cells.back().text.empty()) cells.pop_back();
                if (separator == ' ' || cells.size() != table_.columns.size() || cells[0].number) continue;
                for (std::size_t i = 0; i < cells.size(); ++i) table_.headings[i].push_back(cells[i].text);
                return;
            }
            if (!has_names && !is_mark(text)) table_.notes.push_back(text);
        };
        for (auto line = before.lines.rbegin(); line != before.lines.rend(); ++line)
            keep(line->text, table_.named && line == before.lines.rbegin());
        for (auto line = before.comments.rbegin(); line != before.comments.rend(); ++line)
            keep(without_mark(line->text), table_.named && before.lines.empty() && line == before.comments.rbegin());
        for (std::size_t i = 0; table_.named && i < table_.columns.size(); ++i)
            table_.headings[i].push_back(table_.columns[i]);
    }

    void refuse_mixed_separators(const Line& row, const Cells& first, const Line& above) const {
        const auto has_comma = [](const CsvCell& cell) { return cell.decimal_comma; };
        if (separator_ != ' ' || above.text.find(',') == std::string::npos) return;
        if (std::any_of(first.begin(), first.end(), has_comma))
            fail(row.number,
                 fmt::format("expected cells between commas or between blanks, got \"{}\"", printable(row.text)));
    }

    // The cells of a line that may be names, by the rows' separator or, failing that, by another.
    std::optional<Cells> split_into(const std::string& text, std::size_t count) const {
        std::optional<Cells> best;
        const auto try_one = [&](char separator) {
            Cells cells = csv_cells(text, separator);
            while (cells.size() > count && cells.back().text.empty()) cells.pop_back();
            if (!best && cells.size() == count && !cells[0].number) best = std::move(cells);
        };
        try_one(separator_);
        if (csv_cells(text, separator_).size() > 1 && separator_ != ' ') return best;
        for (const char separator : csv_separators) try_one(separator);
        return best;
    }

    std::optional<Cells> names_in(const std::vector<Line>& lines, const Line& row, const Cells& first) {
        const Line& last = lines.back();
        if (is_mark(last.text)) return std::nullopt;
        std::size_t count = first.size();
        auto names = split_into(last.text, count);
        if (!names && first.back().blank) names = split_into(last.text, --count);
        if (!names) {
            const std::size_t cells = csv_cells(last.text, separator_).size();
            if (cells > 1 && separator_ != ' ') fail_count(row.number, cells, first.size());
            return std::nullopt;
        }
        if (std::isdigit(static_cast<unsigned char>((*names)[0].text[0])) && !starts_with((*names)[0].text, "1/"))
            fail(last.number, fmt::format("expected column names or numbers, got \"{}\"", printable(last.text)));
        const auto unit = unit_in((*names)[0].text);
        if (!unit || lines.size() < 2 || (*names)[0].text.find_first_of(" _") != std::string::npos) return names;
        auto above = split_into(lines[lines.size() - 2].text, count);
        const auto is_value = [](const CsvCell& cell) {
            return cell.number || (!cell.text.empty() && cell.text.back() == ':');
        };
        if (!above || std::any_of(above->begin(), above->end(), is_value)) return names;
        return above;
    }

    std::optional<Cells> names_in_comment(const std::vector<Line>& comments, std::size_t count) const {
        std::string text = comments.back().text;
        text.erase(0, text.find_first_not_of("#%!/\" \t"));
        return split_into(text, count);
    }

    [[noreturn]] void fail_count(std::int64_t line, std::size_t expected, std::size_t got) const {
        std::string cause;
        if (separator_ == ',' && got > expected)
            cause = "; if its commas are decimal ones, separate cells by ; or tabs";
        if (separator_ == ' ') cause = "; blanks separate its cells";
        fail(line, fmt::format("expected {} fields, got {}{}", expected, got, cause));
    }

    void add_row(const Line& line) {
        Cells cells = csv_cells(line.text, separator_);
        const std::size_t columns = table_.columns.size();
        if (cells.size() == columns + 1 && cells.back().text.empty()) cells.pop_back();
        if (cells.size() != columns) fail_count(line.number, columns, cells.size());
        for (const CsvCell& cell : cells) look_at_commas(cell, line.number);
        if (!cells[0].number && !(has_other_wavelengths_ && cells[0].blank)) {
            fail(line.number,
                 fmt::format("{}: expected a finite number, got \"{}\"", table_.columns[0], printable(cells[0].text)));
        }
        const std::size_t row = table_.lines.size();
        for (std::size_t i = 0; i < columns; ++i) {
            table_.values[i].push_back(cells[i].number.value_or(std::numeric_limits<double>::quiet_NaN()));
            if (!cells[i].number && !cells[i].blank) table_.texts[{i, row}] = cells[i].text;
        }
        if (!has_other_wavelengths_) check_wavelength(line.number);
        table_.lines.push_back(line.number);
    }

    void check_wavelength(std::int64_t line) const {
        const std::vector<double>& x = table_.values[0];
        const std::size_t n = x.size();
        const std::string& name = table_.columns[0];
        if (!(x.back() > 0.0)) fail(line, fmt::format("{}: expected a positive wavelength, got {}", name, x.back()));
        if (n < 2) return;
        if (x[n - 1] == x[n - 2]) fail(line, fmt::format("{}: {} given twice", name, x.back()));
        if (n > 2 && (x[n - 1] > x[n - 2]) != (x[1] > x[0]))
            fail(line, fmt::format("{}: expected wavelengths that {} as those before, got {} after {}", name,
                                   x[1] > x[0] ? "increase" : "decrease", x[n - 1], x[n - 2]));
    }

    void look_at_commas(const CsvCell& cell, std::int64_t line) {
        if (!cell.number) return;
        if (cell.decimal_comma) {
            if (!may_have_thousands(cell.text)) decimal_comma_ = true;
            if (comma_.empty()) comma_ = cell.text;
        }
        if (cell.decimal_point) point_ = cell.text;
        if (!comma_.empty() && !point_.empty())
            fail(line, fmt::format("expected either decimal points or decimal commas, got \"{}\" and \"{}\"",
                                   printable(comma_), printable(point_)));
    }

    void refuse_thousands() const {
        if (comma_.empty() || decimal_comma_ || separator_ == ';') return;
        fail(table_.lines.front(),
             fmt::format("expected numbers without commas, got \"{}\": a decimal comma or one between thousands",
                         printable(comma_)));
    }

    CsvTable table_;
    char separator_ = ',';
    bool has_other_wavelengths_ = false;  // beside the first column's
    bool decimal_comma_ = false;
    std::string comma_, point_;  // a number with each
};

std::string names_of(const CsvTable& table) {
    constexpr std::size_t most = 20;
    std::string names;
    for (std::size_t i = table.wavelengths_first ? 1 : 0; i < table.columns.size(); ++i) {
        if (i > most) return names + ", ...";
        const std::string name = table.columns[i].empty() ? fmt::format("{}", i + 1) : printable(table.columns[i]);
        names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

}  // namespace

CsvTable parse_csv(std::string_view text, const std::string& file) {
    return TableReader(file).read(with_plain_blanks(plain_text(std::string(text), file)));
}

CsvTable read_csv(const std::string& path) { return parse_csv(read_file(path), path); }

std::size_t csv_column(const CsvTable& table, const std::string& name) {
    const std::size_t first = table.wavelengths_first ? 1 : 0;
    const auto only_one = [&](const auto& has_name) {
        std::optional<std::size_t> found;
        for (std::size_t i = first; i < table.columns.size() && !name.empty(); ++i) {
            if (!has_name(i)) continue;
            if (found)
                throw InputError(fmt::format("{}: several columns are named \"{}\"; take one by its number, from 2 on",
                                             table.file, printable(name)));
            found = i;
        }
        return found;
    };
    if (const auto found = only_one([&](std::size_t i) { return table.columns[i] == name; })) return *found;
    const auto number = parse_integer(name);
    if (number && *number >= 2 && *number <= static_cast<std::int64_t>(table.columns.size()))
        return static_cast<std::size_t>(*number) - 1;
    if (const auto found = only_one([&](std::size_t i) {
            const std::vector<std::string>& above = table.headings[i];
            return std::find(above.begin(), above.end(), name) != above.end();
        }))
        return *found;
    throw InputError(fmt::format("{}: no column \"{}\"; {}expected one of: {}", table.file, printable(name),
                                 table.named ? "" : "the file has no line of column names, so they go by number; ",
                                 names_of(table)));
}

}  // namespace stokes
