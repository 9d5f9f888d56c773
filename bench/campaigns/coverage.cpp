#include "bench/campaigns/coverage.hpp"

#include <nlohmann/json.hpp>

namespace sipplab::bench {
namespace {

constexpr std::string_view kFolder = "/planner/";

}  // namespace

Expected<std::vector<db::FileCoverage>, std::string> parse_coverage(std::string_view text,
                                                                    const std::string& name) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  const auto expected = [&name] {
    return Unexpected{name +
                      ": not a summary of coverage, expected the JSON of llvm-cov export -summary-only"};
  };
  std::vector<db::FileCoverage> files;
  if (!json.is_object() || !json.contains("data") || !json["data"].is_array()) return expected();
  try {
    for (const nlohmann::json& data : json["data"]) {
      if (!data.is_object() || !data.contains("files") || !data["files"].is_array()) return expected();
      for (const nlohmann::json& file : data["files"]) {
        const std::string path = file.value("filename", "");
        const std::size_t folder = path.rfind(kFolder);
        if (folder == std::string::npos) continue;
        const nlohmann::json lines =
            file.value("summary", nlohmann::json::object()).value("lines", nlohmann::json::object());
        files.push_back({path.substr(folder + 1), lines.value("count", std::int64_t{0}),
                         lines.value("covered", std::int64_t{0})});
      }
    }
  } catch (const nlohmann::json::type_error&) {
    return expected();
  }
  if (files.empty()) return Unexpected{name + ": no file of planner/ in it, expected their coverage"};
  return files;
}

}  // namespace sipplab::bench
