// What every target that reads texts checks: the refusal, and the memory that it took.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "fuzz/support/claims.hpp"
#include "sipplab/error.hpp"

namespace sipplab::fuzz {

/// A refusal is one printable line that names the file and a line of the text (or the one
/// after the last, for what is missing at the end), or no line: 0.
void check_refusal(const InputError& error, std::string_view text);

/// The same if there is a text: the error names a line of it.
void check_refusal_of_text(const InputError& error, std::string_view text);

/// The same for a warning: one printable line.
void check_warning(const std::string& warning);

/// Measures what is allocated while it lives, if a sanitizer can tell; at its end that
/// has to be in proportion to the text.
class MemoryCheck {
 public:
  /// Bytes. For each byte of text a reader may keep it, its place in a table, and the number
  /// that it stands for, several times over; a list of one-line elements takes most.
  static constexpr std::size_t kBytesPerByte = 512;
  /// Whatever the text: pages of the XML reader, messages.
  static constexpr std::size_t kBytesAtLeast = std::size_t{512} << 10;

  explicit MemoryCheck(std::size_t text_bytes);
  ~MemoryCheck();
  MemoryCheck(const MemoryCheck&) = delete;
  MemoryCheck& operator=(const MemoryCheck&) = delete;

 private:
  std::size_t due_;
};

/// Reads and counts: `read` gives an Input. The value, or nothing after a checked refusal.
template <class Read>
auto read_checked(std::string_view text, const Read& read) {
  auto input = [&] {
    const MemoryCheck memory(text.size());
    return read();
  }();
  count(input ? Event::kAccepted : Event::kRefused);
  if (!input) check_refusal_of_text(input.error(), text);
  return input;
}

}  // namespace sipplab::fuzz
