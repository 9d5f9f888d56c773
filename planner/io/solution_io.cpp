// The table of the formats of solutions, and telling them apart: see solution_io.hpp.
#include "sipplab/solution_io.hpp"

#include <algorithm>

#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"
#include "sipplab/error.hpp"

namespace sipplab {

// Each is defined in the file of its format.
SolutionFormat csv_format();
SolutionFormat eecbs_format();
SolutionFormat json_format();
SolutionFormat lacam_format();
SolutionFormat path_format();
SolutionFormat plain_format();
SolutionFormat tracker_format();
SolutionFormat xml_format();
SolutionFormat xy_path_format();
SolutionFormat yaml_format();

namespace {

/// Characters that decide the format; none begins with more blanks than that.
constexpr std::size_t kHeadLength = 4096;

/// A format that is taken by this name alone, and read as `format` is.
SolutionFormat by_name(std::string_view name, std::string_view words, const SolutionFormat& format) {
  return {name, words, nullptr, format.parse};
}

const SolutionFormat* find_format(std::string_view name) {
  const std::span<const SolutionFormat> formats = solution_formats();
  const auto found = std::find_if(formats.begin(), formats.end(),
                                  [&](const SolutionFormat& format) { return format.name == name; });
  return found == formats.end() ? nullptr : &*found;
}

const SolutionFormat* guess_format(std::string_view text) {
  const std::string_view head = trimmed(text.substr(0, kHeadLength));
  const std::span<const SolutionFormat> formats = solution_formats();
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const SolutionFormat& format) {
    return format.begins_so != nullptr && format.begins_so(head);
  });
  return found == formats.end() ? nullptr : &*found;
}

}  // namespace

std::span<const SolutionFormat> solution_formats() {
  static const SolutionFormat formats[] = {
      xml_format(),
      json_format(),
      path_format(),
      plain_format(),
      lacam_format(),
      tracker_format(),
      csv_format(),
      yaml_format(),
      by_name("aa-sipp", "the published AA-SIPP(m)'s log", xml_format()),
      by_name("ccbs", "Continuous-CBS' log", xml_format()),
      eecbs_format(),
      by_name("mapf-lns2", "paths, rows first: MAPF-LNS, MAPF-LNS2", eecbs_format()),
      xy_path_format(),
  };
  return formats;
}

std::string_view solution_format_of_file(std::string_view path) {
  const SolutionFormat* const format = find_format(path.substr(path.find_last_of('.') + 1));
  return format != nullptr && format->write != nullptr ? format->name : "xml";
}

Expected<std::string, std::string> write_solution(std::string_view format, const Instance& instance,
                                                  const SolutionDocument& document) {
  const SolutionFormat* const found = find_format(format);
  if (found == nullptr || found->write == nullptr) {
    return Unexpected{"no format " + in_quotes(format) + " is written"};
  }
  return found->write(instance, document);
}

Input<SolutionDocument> parse_solution(std::string_view text, const std::string& file_name,
                                       const Instance& instance, std::string_view format) {
  const SolutionFormat* const found = format.empty() ? guess_format(text) : find_format(format);
  if (found != nullptr) return found->parse(text, file_name, instance);
  return Unexpected{InputError{file_name, 1, text.empty() ? "empty file" : "not a solution",
                               "XML with <log>, a JSON object, CSV that begins with 'agent,id,t0', lines "
                               "such as '0: (3,4,0) (5,4,2)', or the plan of a program in discrete time"}};
}

Input<SolutionDocument> load_solution(const std::string& path, const Instance& instance,
                                      std::string_view format) {
  const Input<std::string> text = read_text(path);
  if (!text) return Unexpected{text.error()};
  return parse_solution(*text, path, instance, format);
}

}  // namespace sipplab
