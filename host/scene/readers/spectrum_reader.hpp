// Spectra of a scene file: named ones, numbers, and objects written in place.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/core/csv_spectrum.hpp"
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
    // holds where the scene does not say, and "per" is an error; a constant is the same everywhere, an illuminant zero
    // outside its table. Samples are means over whole nanometres (Spectrum::at_whole_nanometres); illuminants are as
    // CIE has them.
    Spectrum read(const JsonCursor& where, Outside outside, double maximum);
    // The same of an object's key, whose declaration has the maximum.
    Spectrum read(const ObjectReader& object, const char* key, Outside outside);
    // The same of a coefficient per mm, times a factor; warns where its file says that it is per cm and nothing scales
    // it.
    Spectrum read_per_mm(const ObjectReader& object, const char* key, double factor);
    // The same of a density over wavelength, zero outside its table: one over photon energy is warned of, unless the
    // scene says what it is per.
    Spectrum read_density(const ObjectReader& object, const char* key);
    // The same times what brings its largest sample from 300 to 830 nm to 1: of a relative spectrum.
    Spectrum read_relative(const ObjectReader& object, const char* key);

    // Names that were defined and that nothing has read since.
    std::vector<std::string> unused() const;

  private:
    struct Definition {
        Spectrum spectrum;
        std::optional<Outside> outside;
        bool by_nanometre = false;               // samples are those of whole nanometres already
        std::optional<std::string> column = {};  // of a file
        double scale = 1.0;                      // of its values
        std::string range_fault = {};            // fault_of_range(), of pairs
        std::string density_doubt = {};          // doubt_of_density()
        std::string percent = {}, per_cm = {};   // what a file says so by, of its column
        bool has_per = false;                    // the scene says what values are per
    };

    Definition density_at(const ObjectReader& object, const char* key);
    Definition definition_at(const JsonCursor& where, double maximum);
    Spectrum read(const JsonCursor& where, Definition definition, Outside outside, double maximum) const;
    Spectrum spectrum_of(const JsonCursor& where, Definition definition, Outside outside, double maximum) const;

    Definition read_object(const JsonCursor& where);
    static Definition read_pairs(const JsonCursor& pairs, const SampleRules& rules);
    Definition read_file_column(const ObjectReader& where);

    InputFiles<CsvTable, read_csv> tables_;
    std::map<std::string, Definition> named_;
    std::set<std::string> used_;  // of these names
};

}  // namespace stokes
