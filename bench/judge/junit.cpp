#include "bench/judge/junit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "planner/io/text.hpp"

namespace sipplab::bench {

std::string junit_xml(const std::string& suite, const std::vector<JunitCase>& cases) {
  const auto failed = std::count_if(cases.begin(), cases.end(),
                                    [](const JunitCase& test) { return test.failure.has_value(); });
  const auto skipped = std::count_if(cases.begin(), cases.end(),
                                     [](const JunitCase& test) { return test.skipped.has_value(); });
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  xml += fmt::format("<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\">\n",
                     xml_escaped(suite), cases.size(), failed, skipped);
  for (const JunitCase& test : cases) {
    xml +=
        fmt::format("  <testcase classname=\"{}\" name=\"{}\">", xml_escaped(suite), xml_escaped(test.name));
    if (test.failure) xml += fmt::format("<failure message=\"{}\"/>", xml_escaped(*test.failure));
    if (test.skipped) xml += fmt::format("<skipped message=\"{}\"/>", xml_escaped(*test.skipped));
    if (!test.output.empty()) xml += fmt::format("<system-out>{}</system-out>", xml_escaped(test.output));
    xml += "</testcase>\n";
  }
  return xml + "</testsuite>\n";
}

}  // namespace sipplab::bench
