// One fuzz target as programs: the fuzzer, and the one that replays, judges and reduces.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "db/findings.hpp"

namespace sipplab::bench {

/// Takes one line for people.
using Teller = std::function<void(const std::string&)>;

/// Empty if the file cannot be read: what a killed program left.
std::string bytes_or_none(const std::filesystem::path& path);

enum class TargetVerdict {
  kHolds,
  kBreaks,
  kNotJudged,  ///< the program is not there, or did not answer
};

struct InputVerdict {
  TargetVerdict verdict = TargetVerdict::kNotJudged;
  std::string kind, claim, frames, message;  ///< of what breaks
  std::string report = {};                   ///< what the program printed when it broke, lines of it
  double cpu_time_s = 0;                     ///< that judging took

  std::string signature() const { return kind + " | " + claim + " | " + frames; }
};

/// Below a folder such as build/fuzz/fuzz.
class TargetProgram {
 public:
  /// `scratch`: a folder for files that nobody needs afterwards.
  TargetProgram(std::filesystem::path programs, std::string target, std::filesystem::path scratch);

  std::filesystem::path fuzzer() const { return programs_ / target_; }
  std::filesystem::path replayer() const { return programs_ / ("replay_" + target_); }

  InputVerdict judge(const std::string& input) const;
  /// The smallest input that breaks the same and was found within some seconds, or before the user wanted to
  /// end; the input itself if there is none. `tell` hears of it meanwhile.
  std::string reduce(const std::string& input, double limit_s, const Teller& tell) const;

 private:
  std::filesystem::path programs_;
  std::string target_;
  std::filesystem::path scratch_;
};

/// The finding of an input that breaks, not yet made smaller.
db::Finding finding_of(const std::string& target, const InputVerdict& verdict, const std::string& input);

/// The same with a smaller input, as TargetProgram::reduce finds one.
db::Finding reduced(const TargetProgram& program, const db::Finding& finding, double limit_s,
                    const Teller& tell);

/// The picture of a finding that is a planning case, with its plan where planning it ends
/// well; nothing for other inputs. Drawn in a child: the case is one that breaks things.
std::optional<std::string> draw_finding(const db::Finding& finding);

}  // namespace sipplab::bench
