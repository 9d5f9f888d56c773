// Numbers and tokens in text, the same under every locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sipplab {

/// Without blanks, tabs and line breaks at both ends.
std::string_view trimmed(std::string_view text);

/// A decimal integer that is the whole token, surrounding blanks aside.
std::optional<std::int64_t> parse_integer(std::string_view token);

/// A finite decimal number that is the whole token, surrounding blanks aside.
std::optional<double> parse_real(std::string_view token);

/// The shortest text that parse_real reads back as the same value. REQUIRES: finite.
std::string format_real(double value);
/// The same, at the end of a text that grows.
void append_real(std::string& out, double value);

/// The token as a message shows it: in quotes, on one line, not longer than a
/// person wants to read.
std::string in_quotes(std::string_view token);

/// For text between tags and in attributes of XML, SVG and HTML. Control characters, which XML does not have,
/// become blanks; what is no UTF-8 is shown as a message shows it.
std::string xml_escaped(std::string_view text);

/// Some editors begin a text with it; readers pass over it.
inline constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
/// What follows a byte order mark, if there is one.
std::string_view without_byte_order_mark(std::string_view text);

bool is_valid_utf8(std::string_view text);

/// Byte offsets to lines counted from 1.
class LineTable {
 public:
  explicit LineTable(std::string_view text);
  int line(std::size_t offset) const;

 private:
  std::vector<std::size_t> line_breaks_;
};

/// Takes a text apart line by line; a line break may be "\n" or "\r\n".
class LineScanner {
 public:
  explicit LineScanner(std::string_view text) : rest_(text) {}

  /// The next line without its break, or nothing at the end of the text.
  std::optional<std::string_view> next();
  /// Number of the line that next() returned last, counted from 1.
  int line() const { return line_; }

 private:
  std::string_view rest_;
  int line_ = 0;
};

}  // namespace sipplab
