// A history of many commits, made in a moment.
#pragma once

#include <string>
#include <vector>

#include "db/tests/support.hpp"

namespace sipplab::db::test {

struct Version {
  int number = 1;     ///< of the commit; its ancestors are those with smaller numbers
  double factor = 1;  ///< of times and flowtimes
  int solved = 8;     ///< of the instances
  bool dirty = false;
  std::string host = "host";
  int instances = 10;
  std::string planner = "sipplab";
  double time_limit_s = 300;
};

/// Hashes that sort the other way round than the numbers.
std::string hash_of(int number);

/// Records one run of one case; returns its UUID.
std::string record_version(const std::filesystem::path& file, const Version& version,
                           std::int64_t robots = 64);

}  // namespace sipplab::db::test
