// Numbers and tokens in text: see text.hpp.
#include "planner/io/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "planner/core/number.hpp"
#include "sipplab/error.hpp"

namespace sipplab {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::optional<std::int64_t> parse_integer(std::string_view token) {
  return parse_number<std::int64_t>(trimmed(token));
}

std::optional<double> parse_real(std::string_view token) {
  const std::optional<double> value = parse_number<double>(trimmed(token));
  if (!value || !std::isfinite(*value)) return std::nullopt;
  return value;
}

void append_real(std::string& out, double value) {
  PLANNER_ASSERT(std::isfinite(value));
  std::array<char, 32> buffer{};  // the longest double takes 24 characters
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  out.append(buffer.data(), result.ptr);
}

std::string format_real(double value) {
  std::string out;
  append_real(out, value);
  return out;
}

std::string in_quotes(std::string_view token) {
  constexpr std::size_t kShown = 40;  // characters; enough to recognise a value in its file
  std::string shown(token.substr(0, kShown));
  if (token.size() > kShown) {
    // The cut may have gone through a character of up to four bytes.
    for (std::size_t cut = 0; cut < 4 && cut < kShown; ++cut) {
      if (is_valid_utf8(token.substr(0, kShown - cut))) {
        shown.resize(kShown - cut);
        break;
      }
    }
  }
  if (!is_valid_utf8(shown)) {
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; }, '?');
  }
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; },
      '?');
  return "'" + shown + (token.size() > kShown ? "...'" : "'");
}

std::string xml_escaped(std::string_view text) {
  if (!is_valid_utf8(text)) return xml_escaped(in_quotes(text));
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else if (c == '>') {
      escaped += "&gt;";
    } else if (c == '"') {
      escaped += "&quot;";
    } else {
      escaped += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? ' ' : c;
    }
  }
  return escaped;
}

std::string_view without_byte_order_mark(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return text;
}

bool is_valid_utf8(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const auto lead = static_cast<unsigned char>(text[at]);
    std::size_t more = 0;
    std::uint32_t code = lead;
    if (lead >= 0xf0 && lead < 0xf8) {
      more = 3;
      code = lead & 0x07u;
    } else if (lead >= 0xe0 && lead < 0xf0) {
      more = 2;
      code = lead & 0x0fu;
    } else if (lead >= 0xc0 && lead < 0xe0) {
      more = 1;
      code = lead & 0x1fu;
    } else if (lead >= 0x80) {
      return false;
    }
    if (at + more >= text.size()) return false;
    for (std::size_t i = 1; i <= more; ++i) {
      const auto byte = static_cast<unsigned char>(text[at + i]);
      if ((byte & 0xc0u) != 0x80u) return false;
      code = (code << 6) | (byte & 0x3fu);
    }
    constexpr std::array<std::uint32_t, 4> kLeastCode = {0, 0x80, 0x800, 0x10000};  // shortest form only
    if (code < kLeastCode[more] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return false;
    at += more + 1;
  }
  return true;
}

LineTable::LineTable(std::string_view text) {
  for (std::size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1)) {
    line_breaks_.push_back(at);
  }
}

int LineTable::line(std::size_t offset) const {
  const auto after = std::lower_bound(line_breaks_.begin(), line_breaks_.end(), offset);
  return static_cast<int>(after - line_breaks_.begin()) + 1;
}

std::optional<std::string_view> LineScanner::next() {
  if (rest_.empty()) return std::nullopt;
  ++line_;
  const std::size_t end = rest_.find('\n');
  std::string_view line = rest_.substr(0, end);
  rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

}  // namespace sipplab
