#include "planner/io/csv_text.hpp"

namespace sipplab {

void append_csv_field(std::string& out, std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

CsvRecord next_csv_record(std::string_view& rest, int& line, std::size_t most_fields) {
  CsvRecord record;
  record.line = line;
  record.fields.emplace_back();
  bool in_quotes_now = false;
  std::size_t at = 0;
  for (; at < rest.size(); ++at) {
    const char c = rest[at];
    if (c == '\n') ++line;
    if (in_quotes_now) {
      if (c != '"') {
        record.fields.back() += c;
      } else if (at + 1 < rest.size() && rest[at + 1] == '"') {
        record.fields.back() += rest[++at];
      } else {
        in_quotes_now = false;
      }
    } else if (c == '"') {
      in_quotes_now = true;
    } else if (c == ',') {
      if (record.fields.size() <= most_fields) record.fields.emplace_back();
    } else if (c == '\n') {
      ++at;
      break;
    } else if (c != '\r') {
      record.fields.back() += c;
    }
  }
  record.complete = !in_quotes_now;
  rest.remove_prefix(at);
  return record;
}

}  // namespace sipplab
