// JUnit's XML, as CI servers read it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sipplab::bench {

struct JunitCase {
  std::string name;
  std::optional<std::string> failure;  ///< why it failed
  std::optional<std::string> skipped;  ///< why it says nothing
  std::string output;                  ///< details
};

std::string junit_xml(const std::string& suite, const std::vector<JunitCase>& cases);

}  // namespace sipplab::bench
