#include "host/core/csv_spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/csv_headings.hpp"
#include "host/core/error.hpp"
#include "host/core/text_input.hpp"

namespace stokes {

namespace {

constexpr double deleted_channel = -1e30;  // -1.23e34 in the USGS spectral library
constexpr double first_edge_nm = first_lambda_nm - 0.5, last_edge_nm = last_lambda_nm + 0.5;
// Tables that begin below this may be in micrometres even where they reach 300.
constexpr double lowest_wavelength_nm = 10.0;

struct Sample {
    double lambda_nm, value;
    std::size_t row;
};

class ColumnReader {
  public:
    ColumnReader(const CsvTable& table, const std::string& name, const SampleRules& rules)
        : table_(table),
          rules_(rules),
          column_(csv_column(table, name)),
          axis_(axis_of(table, column_, rules.unit.has_value())),
          name_(table.columns[column_].empty() ? name : table.columns[column_]) {}

    ColumnSpectrum read(Outside outside) {
        find_rows();
        const WavelengthUnit unit = read_unit();
        std::vector<Sample> samples = samples_in(unit);
        keep_values(samples);
        treat_negative(samples);
        result_.spectrum.outside = outside;
        result_.density_doubt = doubt_of_density(unit, rules_.per);
        for (const Sample& sample : samples) {
            result_.spectrum.lambda_nm.push_back(sample.lambda_nm);
            const double factor = rules_.per == Per::unit ? units_per_nm(unit, sample.lambda_nm) : 1.0;
            result_.spectrum.value.push_back(sample.value * factor);
        }
        return std::move(result_);
    }

  private:
    [[noreturn]] void fail(std::size_t row, const std::string& what) const {
        throw InputError(fmt::format("{}:{}: {}: {}", table_.file, table_.lines[row], printable(name_), what));
    }

    // Those with a wavelength: of several curves, the shorter ones have blank cells at their ends.
    void find_rows() {
        const std::vector<double>& x = table_.values[axis_.column];
        for (std::size_t row = 0; row < x.size(); ++row) {
            if (std::isnan(x[row])) {
                if (!std::isnan(table_.values[column_][row]) || table_.texts.count({axis_.column, row}) != 0)
                    fail(row, fmt::format("expected a wavelength in column {}", axis_.column + 1));
                continue;
            }
            if (!(x[row] > 0.0)) fail(row, fmt::format("expected a positive wavelength, got {}", x[row]));
            rows_.push_back(row);
            const std::size_t n = rows_.size();
            if (n < 2) continue;
            const double before = x[rows_[n - 2]];
            if (x[row] == before || (x[row] > before) != (x[rows_[1]] > x[rows_[0]]))
                fail(row,
                     fmt::format("expected wavelengths in column {} that increase, or decrease, throughout, got {} "
                                 "after {}",
                                 axis_.column + 1, x[row], before));
        }
        if (rows_.empty())
            throw InputError(
                fmt::format("{}: {}: no wavelength in column {}", table_.file, printable(name_), axis_.column + 1));
    }

    WavelengthUnit read_unit() {
        const auto said = rules_.unit ? rules_.unit : axis_.unit;
        if (rules_.unit && axis_.unit && *rules_.unit != *axis_.unit)
            result_.remarks.push_back(fmt::format("{}: read in {}, while its column names say {}", table_.file,
                                                  word_of(*rules_.unit), word_of(*axis_.unit)));
        std::vector<double> x;
        for (const std::size_t row : rows_) x.push_back(table_.values[axis_.column][row]);
        const auto [low, high] = std::minmax_element(x.begin(), x.end());
        if (const std::string fault = fault_of_range(said, *low, *high); !fault.empty())
            throw InputError(fmt::format("{}: {}", table_.file, fault));
        return said.value_or(WavelengthUnit::nm);
    }

    // By increasing wavelength, from the last one at or below first_edge_nm to the first at or above last_edge_nm.
    std::vector<Sample> samples_in(WavelengthUnit unit) const {
        std::vector<Sample> all;
        for (const std::size_t row : rows_)
            all.push_back({wavelength_nm(unit, table_.values[axis_.column][row]), table_.values[column_][row], row});
        if (all.front().lambda_nm > all.back().lambda_nm) std::reverse(all.begin(), all.end());
        const auto below = [](double edge, const Sample& sample) { return edge < sample.lambda_nm; };
        const auto above = [](const Sample& sample, double edge) { return sample.lambda_nm < edge; };
        auto begin = std::upper_bound(all.begin(), all.end(), first_edge_nm, below);
        auto end = std::lower_bound(all.begin(), all.end(), last_edge_nm, above);
        if (begin != all.begin()) --begin;
        if (end != all.end()) ++end;
        return {begin, end};
    }

    bool has_no_data(const Sample& sample) const {
        if (table_.texts.count({column_, sample.row}) != 0) return false;
        return std::isnan(sample.value) || sample.value <= deleted_channel;
    }

    void keep_values(std::vector<Sample>& samples) const {
        while (!samples.empty() && has_no_data(samples.back())) samples.pop_back();
        const auto first =
            std::find_if(samples.begin(), samples.end(), [&](const Sample& s) { return !has_no_data(s); });
        samples.erase(samples.begin(), first);
        for (const Sample& sample : samples) {
            if (const auto text = table_.texts.find({column_, sample.row}); text != table_.texts.end())
                fail(sample.row, fmt::format("expected a finite number, got \"{}\"", printable(text->second)));
            if (has_no_data(sample))
                fail(sample.row, fmt::format("no value at {:.6g} nm, but on both sides of it; remove the row to have a "
                                             "straight line there",
                                             sample.lambda_nm));
        }
        if (samples.empty() || samples.front().lambda_nm > last_edge_nm || samples.back().lambda_nm < first_edge_nm)
            throw InputError(fmt::format("{}: {}: no value from {} to {} nm", table_.file, printable(name_),
                                         first_lambda_nm, last_lambda_nm));
    }

    void treat_negative(std::vector<Sample>& samples) {
        double largest = 0.0, lowest = 0.0;
        for (const Sample& sample : samples) {
            largest = std::max(largest, sample.value);
            lowest = std::min(lowest, sample.value);
        }
        std::size_t count = 0;
        for (Sample& sample : samples) {
            if (!(sample.value < 0.0)) continue;
            const bool zero =
                rules_.negative ? *rules_.negative == Negative::zero : sample.value >= -dark_noise_share * largest;
            if (!zero)
                fail(sample.row, fmt::format("expected no negative value, got {}{}", sample.value,
                                             rules_.negative ? ""
                                                             : "; \"negative\": \"zero\" (--negative zero) takes "
                                                               "all of them for zero"));
            sample.value = 0.0;
            ++count;
        }
        if (count > 0 && !rules_.negative)
            result_.remarks.push_back(fmt::format("{}: {}: {} value{} below zero, down to {}, taken for zero",
                                                  table_.file, printable(name_), count, count == 1 ? "" : "s", lowest));
    }

    const CsvTable& table_;
    const SampleRules& rules_;
    std::size_t column_;
    CsvAxis axis_;
    std::vector<std::size_t> rows_;  // with a wavelength
    std::string name_;
    ColumnSpectrum result_;
};

}  // namespace

std::string fault_of_range(std::optional<WavelengthUnit> unit, double low, double high) {
    const WavelengthUnit taken = unit.value_or(WavelengthUnit::nm);
    const auto [first, last] = std::minmax({wavelength_nm(taken, low), wavelength_nm(taken, high)});
    const bool reaches = first <= last_edge_nm && last >= first_edge_nm;
    if (reaches && (unit || first >= lowest_wavelength_nm)) return "";
    const std::string others = units_that_fit(taken, low, high);
    return fmt::format(
        "expected wavelengths from {} to {} nm, got {:g} to {:g} {}{}", first_lambda_nm, last_lambda_nm, low, high,
        word_of(taken),
        others.empty() ? "" : fmt::format("; if they are in {}, say \"unit\" (--wavelength-unit)", others));
}

std::string doubt_of_density(std::optional<WavelengthUnit> unit, const std::optional<Per>& per) {
    if (!unit || !is_reciprocal(*unit) || per) return "";
    return fmt::format(
        "values over {} are taken for values per nm as they stand; \"per\": \"unit\" (--per unit) takes them for "
        "values "
        "per {}, \"per\": \"nm\" keeps them without a warning",
        word_of(*unit), word_of(*unit));
}

std::string doubt_of_probability(const Spectrum& spectrum) {
    constexpr double low = 0.1;
    const double largest = spectrum.maximum();
    if (spectrum.value.size() < 2 || largest >= low) return "";
    return fmt::format(
        "the largest value is {:.3g}; an excitation is the share of the light that is taken up, and relative tables "
        "are "
        "brought to 1 at their peak",
        largest);
}

ColumnSpectrum read_column(const CsvTable& table, const std::string& column, Outside outside,
                           const SampleRules& rules) {
    return ColumnReader(table, column, rules).read(outside);
}

Spectrum csv_spectrum(const CsvTable& table, const std::string& column, Outside outside) {
    return read_column(table, column, outside, {WavelengthUnit::nm, Per::nm, Negative::refuse}).spectrum;
}

}  // namespace stokes
