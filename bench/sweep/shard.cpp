#include "bench/sweep/shard.hpp"

#include <cstdint>
#include <string_view>

#include "planner/core/number.hpp"

namespace sipplab::bench {
std::optional<Shard> parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return std::nullopt;
  const auto index = parse_number<std::uint32_t>(std::string_view(text).substr(0, slash));
  const auto count = parse_number<std::uint32_t>(std::string_view(text).substr(slash + 1));
  if (!index || !count || *index < 1 || *index > *count) return std::nullopt;
  return Shard{*index - 1, *count};
}

}  // namespace sipplab::bench
