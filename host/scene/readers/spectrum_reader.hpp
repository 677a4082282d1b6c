// Spectra of a scene file: named ones, numbers, and objects written in place.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/core/csv_table.hpp"
#include "host/core/spectrum.hpp"
#include "host/scene/readers/input_files.hpp"
#include "host/scene/settings/object.hpp"

namespace stokes {

class SpectrumReader {
  public:
    explicit SpectrumReader(std::filesystem::path folder) : tables_(std::move(folder)) {}

    const std::filesystem::path& folder() const { return tables_.folder(); }

    // Takes in the scene's "spectra". Throws InputError.
    void define(const JsonCursor& spectra);

    // A name from "spectra", a number, or an object. Values are >= 0; one above maximum is an error. outside
    // holds where the scene does not say; a constant is the same everywhere, an illuminant zero outside its
    // table.
    Spectrum read(const JsonCursor& where, Outside outside, double maximum);
    // The same of an object's key, whose declaration has the maximum.
    Spectrum read(const ObjectReader& object, const char* key, Outside outside);

    // Names that were defined and that nothing has read since.
    std::vector<std::string> unused() const;

  private:
    struct Definition {
        Spectrum spectrum;
        std::optional<Outside> outside;
    };

    Definition read_object(const JsonCursor& where);
    Definition read_file_column(const ObjectReader& where);

    InputFiles<CsvTable, read_csv> tables_;
    std::map<std::string, Definition> named_;
    std::set<std::string> used_;  // of these names
};

}  // namespace stokes
