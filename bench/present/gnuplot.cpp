// Running gnuplot, and what becomes of its pictures.
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>

#include "bench/present/chart.hpp"
#include "bench/program.hpp"
#include "bench/temporary_folder.hpp"
#include "planner/core/try.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::bench {
namespace {

constexpr const char* kNoGnuplot =
    "sipplab: no program gnuplot here, expected it for pictures: apt-get install gnuplot-nox";
constexpr std::string_view kPlace = "<!--picture ";
constexpr std::string_view kPlaceEnd = "-->";

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
}

/// Groups that hold nothing: gnuplot begins one for each colour, even for that of the picture before.
void erase_empty_groups(std::string& text) {
  constexpr std::string_view kEnd = ">\n</g>\n";
  for (std::size_t at = 0; (at = text.find(kEnd, at)) != std::string::npos;) {
    const std::size_t begin = text.rfind('\n', at) + 1;
    if (text.compare(begin, 3, "<g ") == 0) {
      text.erase(begin, at + kEnd.size() - begin);
      at = begin;
    } else {
      ++at;
    }
  }
}

/// What gnuplot's SVG says of itself gives way to what the chart says; within a page its names are its own
/// and its text has the page's colour.
std::string own_svg(std::string text, const Chart& chart, bool within_page, std::size_t number) {
  for (std::size_t at = 0; (at = text.find("<title>", at)) != std::string::npos;) {
    const std::size_t end = text.find("</title>", at);
    const bool first = text.compare(at, 14, "<title>Gnuplot") == 0;
    const std::string title = first ? "<title>" + xml_escaped(chart.title) + "</title>" : "";
    text.replace(at, end + 8 - at, title);
    at += title.size();
  }
  const std::size_t described = text.find("<desc>");
  if (described != std::string::npos) text.erase(described, text.find("</desc>") + 7 - described);
  // Hints need no program in the picture.
  replace_all(text, "<g onmousemove=\"gnuplot_svg.showHypertext(evt,'", "<g><title>");
  replace_all(text, "')\" onmouseout=\"gnuplot_svg.hideHypertext()\">", "</title>");
  erase_empty_groups(text);
  if (!within_page) return text;
  text.erase(0, text.find("<svg"));
  const std::string own = fmt::format("c{}_", number);
  for (const std::string_view name : {"gpDot", "gpPt"}) {
    for (const char* before : {"'", "#"}) {
      replace_all(text, std::string(before) + std::string(name), before + own + std::string(name));
    }
  }
  replace_all(text, "\"gnuplot_", "\"" + own);
  replace_all(text, "fill=\"black\"", "fill=\"currentColor\"");
  replace_all(text, "rgb( 68,  68,  68)", "currentColor");
  return text;
}

}  // namespace

std::string picture_place(std::size_t chart) { return fmt::format("{}{}{}", kPlace, chart, kPlaceEnd); }

Expected<std::string, std::string> with_pictures(std::string page, const std::vector<Chart>& charts) {
  const auto pictures = SIPPLAB_TRY(pictures_of(charts, PictureFormat::kInlineSvg));
  // In one pass: some hundred pictures are megabytes.
  std::string text;
  std::size_t done = 0;
  for (std::size_t at = 0; (at = page.find(kPlace, done)) != std::string::npos;) {
    std::size_t chart = 0;
    const char* const number = page.data() + at + kPlace.size();
    const char* const end = std::from_chars(number, page.data() + page.size(), chart).ptr;
    text.append(page, done, at - done) += pictures.at(chart);
    done = static_cast<std::size_t>(end - page.data()) + kPlaceEnd.size();
  }
  return text.append(page, done);
}

std::optional<std::string> find_gnuplot_error() {
  const ProgramRun run = run_program({"/bin/sh", "-c", "command -v gnuplot"}, {});
  return run.exit_code == 0 ? std::nullopt : std::optional<std::string>(kNoGnuplot);
}

Expected<std::vector<std::string>, std::string> pictures_of(const std::vector<Chart>& charts,
                                                            PictureFormat format) {
  std::vector<std::string> pictures;
  if (charts.empty()) return pictures;
  if (auto error = find_gnuplot_error()) return Unexpected{std::move(*error)};
  auto folder = TemporaryFolder::make();
  if (!folder) return Unexpected{std::move(folder.error())};
  // One process for all, which takes its time to start: what one picture sets is forgotten before the next.
  std::string script;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    script += gnuplot_script(charts[i], format, (folder->path() / std::to_string(i)).string());
    script += "\nunset output\nreset session\n";
  }
  const std::string script_file = (folder->path() / "script").string();
  if (const auto error = write_file(script_file, script)) return Unexpected{error->message()};
  const std::filesystem::path log = folder->path() / "log";
  // Files and language of its user would change the pictures.
  const ProgramRun run = run_program({"/bin/sh", "-c", "exec gnuplot -d \"$1\"", "sh", script_file},
                                     {.environment = {"LC_ALL=C.UTF-8"}, .log = log, .all_to_log = true});
  if (run.exit_code != 0) {
    constexpr std::size_t kLastWords = 200;
    const auto said = read_text(log.string());
    const std::string words = said ? *said : "";
    return Unexpected{"sipplab: gnuplot failed: " +
                      words.substr(words.size() - std::min(words.size(), kLastWords))};
  }
  for (std::size_t i = 0; i < charts.size(); ++i) {
    auto picture = read_file((folder->path() / std::to_string(i)).string());
    if (!picture) return Unexpected{picture.error().message()};
    pictures.push_back(format == PictureFormat::kPdf
                           ? std::move(*picture)
                           : own_svg(std::move(*picture), charts[i], format == PictureFormat::kInlineSvg, i));
  }
  return pictures;
}

}  // namespace sipplab::bench
