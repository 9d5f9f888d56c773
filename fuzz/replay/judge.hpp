// One input in a process of its own: did it break anything, and what was it that broke?
#pragma once

#include <string>

namespace sipplab::fuzz {

/// What an input broke. The signature is the same for the same bug: kind, claim and frames
/// hold no addresses, numbers or line numbers.
struct Judgement {
  bool broken = false;
  std::string kind;         ///< claim, invariant, sanitizer, crash, timeout, memory, leak
  std::string claim;        ///< name of the claim, condition of the invariant, type of the error
  std::string frames;       ///< innermost functions of the project, " < " between; may be empty
  std::string message;      ///< the line that says what happened, as it was printed
  std::string report = {};  ///< the first lines that the dead process printed; not part of what is compared

  std::string signature() const { return kind + " | " + claim + " | " + frames; }
};

/// As libFuzzer is told: an input that takes longer, or more memory, is a finding.
inline constexpr int kTimeoutS = 10;
inline constexpr long kMemoryLimitKib = 1024L * 1024;

/// Runs the target on the input in a child of this process.
Judgement judge(const std::string& input);

/// What a dead process printed, in the terms of a judgement; `how` is said where it
/// printed nothing that is known. Exposed for tests.
Judgement read_report(const std::string& report, const std::string& how);

}  // namespace sipplab::fuzz
