// What all table files share: JSON of the format "photon-power-table", and the words for what is wrong with
// it.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/subsurface/power_table.hpp"

namespace stokes {

using Json = nlohmann::json;

constexpr const char* power_table_format = "photon-power-table";
constexpr int power_table_version = 1;
constexpr std::size_t most_table_values = std::size_t{1} << 28;

// A JSON object of an open file. Every function throws InputError "PATH: KEY: expected ..." where the object
// is not as asked for.
class JsonFields {
  public:
    // prefix: of the object's keys in complaints, such as "medium.".
    JsonFields(const Json& object, const std::string& path, const std::string& prefix);

    [[noreturn]] void fail(const std::string& key, const std::string& expected) const;
    const Json& at(const std::string& key, const std::string& expected) const;
    std::string text(const std::string& key) const;
    // "expected" is compared as it stands in the file.
    void expect(const std::string& key, const Json& expected) const;
    double number(const std::string& key, double low) const;
    // count numbers, finite, none negative; any count of at least one where it is 0.
    std::vector<double> numbers(const std::string& key, std::size_t count) const;

  private:
    const Json& object_;
    std::string path_, prefix_;
};

// Content of a file. Throws InputError when it cannot be read.
std::string read_text(const std::string& path);

// Throws InputError with path and line for a syntax error.
Json parse_json(const std::string& content, const std::string& path);

// One entry of "axes"; key names it in complaints.
TableAxis read_axis(const Json& json, const std::string& path, const std::string& key, const std::string& name,
                    const std::string& unit);

// "[1,2.5]", with every bit of the numbers.
std::string number_array(const std::vector<double>& values);
void append_numbers(std::string& text, const double* values, std::size_t count);

}  // namespace stokes
