// CSV (RFC 4180): records out of a text, and fields into one.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace sipplab {

struct CsvRecord {
  std::vector<std::string> fields;
  int line = 0;
  bool complete = true;  ///< false if a quote stays open
};

/// Cuts the next record off `rest`; quoted fields may hold line breaks. `line` is that of the text's next
/// character. Of a record with more than `most_fields` fields there are only so many and one: it is wrong,
/// however many there are.
CsvRecord next_csv_record(std::string_view& rest, int& line, std::size_t most_fields);

/// In quotes if it needs them.
void append_csv_field(std::string& out, std::string_view text);

}  // namespace sipplab
