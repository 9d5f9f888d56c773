#include "bench/judge/junit.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sipplab::bench {
namespace {

/// Control characters, which XML 1.0 cannot hold at all, become question marks.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t';
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else if (c == '"') {
      result += "&quot;";
    } else if (c == '\n') {
      result += "&#10;";
    } else {
      result += control ? '?' : c;
    }
  }
  return result;
}

}  // namespace

std::string junit_xml(const std::string& suite, const std::vector<JunitCase>& cases) {
  const auto failed = std::count_if(cases.begin(), cases.end(),
                                    [](const JunitCase& test) { return test.failure.has_value(); });
  const auto skipped = std::count_if(cases.begin(), cases.end(),
                                     [](const JunitCase& test) { return test.skipped.has_value(); });
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  xml += fmt::format("<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\">\n", escaped(suite),
                     cases.size(), failed, skipped);
  for (const JunitCase& test : cases) {
    xml += fmt::format("  <testcase classname=\"{}\" name=\"{}\">", escaped(suite), escaped(test.name));
    if (test.failure) xml += fmt::format("<failure message=\"{}\"/>", escaped(*test.failure));
    if (test.skipped) xml += fmt::format("<skipped message=\"{}\"/>", escaped(*test.skipped));
    if (!test.output.empty()) xml += fmt::format("<system-out>{}</system-out>", escaped(test.output));
    xml += "</testcase>\n";
  }
  return xml + "</testsuite>\n";
}

}  // namespace sipplab::bench
