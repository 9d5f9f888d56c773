#include "bench/campaigns/counts.hpp"

#include <fstream>

namespace sipplab::fuzz {

std::vector<Count> read_counts(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<Count> counts;
  CountRow row;
  while (file.read(reinterpret_cast<char*>(&row), sizeof row)) {
    row.kind.back() = row.name.back() = '\0';
    if (row.count > 0) counts.push_back({row.kind.data(), row.name.data(), row.count});
  }
  return counts;
}

}  // namespace sipplab::fuzz
