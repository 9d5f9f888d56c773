#include "fuzz/support/reading.hpp"

#include <algorithm>

/// Of the sanitizers, if they are linked.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                                         void (*on_free)(const volatile void*))
    __attribute__((weak));

namespace sipplab::fuzz {
namespace {

/// Bytes handed out since the measurement began, freed or not: reading a text in a loop that
/// grows with its square shows as well.
thread_local std::size_t allocated_bytes = 0;

void on_malloc(const volatile void*, std::size_t size) { allocated_bytes += size; }
void on_free(const volatile void*) {}

bool install_hooks() {
  return __sanitizer_install_malloc_and_free_hooks != nullptr &&
         __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free) != 0;
}

bool is_one_line(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x20; });
}

}  // namespace

void check_refusal(const InputError& error, std::string_view text) {
  require(Claim::kRefusalIsOneLine, is_one_line(error.message()) && !error.what.empty(),
          "a refusal that is not one line");
  const auto lines = std::count(text.begin(), text.end(), '\n') + 1;
  require(Claim::kRefusalIsOneLine, error.line >= 0 && error.line <= lines + 1,
          "a refusal that names a line which the text does not have");
}

void check_refusal_of_text(const InputError& error, std::string_view text) {
  require(Claim::kRefusalIsOneLine, error.line >= 1, "a refusal of a text that names no line");
  check_refusal(error, text);
}

void check_warning(const std::string& warning) {
  require(Claim::kRefusalIsOneLine, is_one_line(warning), "a warning that is not one line");
}

MemoryCheck::MemoryCheck(std::size_t text_bytes) : due_(kBytesAtLeast + kBytesPerByte * text_bytes) {
  static const bool installed = install_hooks();
  static_cast<void>(installed);
  allocated_bytes = 0;
}

MemoryCheck::~MemoryCheck() {
  require(Claim::kMemoryInProportion, allocated_bytes <= due_, "more memory than a text of this size is due");
}

}  // namespace sipplab::fuzz
