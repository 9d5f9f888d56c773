#include "bench/sweep/shard.hpp"

namespace sipplab::bench {
namespace {

/// More digits than any number of machines.
constexpr std::size_t kMostDigits = 6;

/// 0 for what is no number.
std::size_t parse_count(const std::string& digits) {
  const bool whole = !digits.empty() && digits.size() <= kMostDigits &&
                     digits.find_first_not_of("0123456789") == std::string::npos;
  return whole ? std::stoul(digits) : 0;
}

}  // namespace

std::optional<Shard> parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return std::nullopt;
  const std::size_t index = parse_count(text.substr(0, slash));
  const std::size_t count = parse_count(text.substr(slash + 1));
  if (index < 1 || index > count) return std::nullopt;
  return Shard{index - 1, count};
}

}  // namespace sipplab::bench
