#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace isolux::detail {

/// The lines of a NRRD header, taken apart but not yet understood.
struct NrrdText {
  std::map<std::string, std::string> fields;      ///< by lower-case name, synonyms merged
  std::map<std::string, std::string> key_values;  ///< unescaped
  std::uint64_t end = 0;                          ///< offset of the first byte behind the header
};

/// Reads a header up to its blank line or the file's end. \throw IoError; InvalidInput naming the file and the line for
/// a line that is no field, an unknown field or one given twice
[[nodiscard]] NrrdText read_nrrd_text(const std::string& path);

/// Words separated by blanks; a vector such as "(1, 0,0)" is one word.
[[nodiscard]] std::vector<std::string> nrrd_words(std::string_view text);

/// Whether a `data file` field names several files: a pattern with numbers, or LIST.
[[nodiscard]] bool names_several_files(std::string_view field);

/// Whether a `data file` field with this name is read back as it: in one line, without blanks around it.
[[nodiscard]] bool can_be_data_file(std::string_view name);

/// A key/value pair's value with newlines and backslashes escaped.
[[nodiscard]] std::string escape_nrrd_value(std::string_view value);

}  // namespace isolux::detail
