// A main for fuzz targets without libFuzzer: replays files, mutates them, judges one, and
// makes one smaller.
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "fuzz/replay/judge.hpp"
#include "fuzz/replay/mutation_loop.hpp"
#include "fuzz/support/target.hpp"
#include "planner/core/number.hpp"
#include "property_tests/support/text_reducer.hpp"

namespace {

namespace fs = std::filesystem;
using namespace sipplab;

constexpr int kNegative = 1;
constexpr int kBadUsage = 2;

/// Questions of one reduction. A child takes a few milliseconds; a case of eight robots
/// is down to its core after some hundreds.
constexpr std::size_t kReductionTries = 5000;

constexpr const char* kUsage =
    "usage: %s FILE...                                  run the target on files and folders\n"
    "       %s --mutate N [--seed S] [--keep F] FILE... ... and on N mutations of them, the same for\n"
    "                                                   the same seed; an input that breaks goes to F\n"
    "       %s --judge FILE                             what does it break? exit code 1 where anything\n"
    "       %s --reduce FILE OUT                        the smallest input that breaks the same; OUT is\n"
    "                                                   the smallest so far at any time\n";

struct Arguments {
  std::size_t mutations = 0;
  std::uint64_t seed = 1;
  std::string keep_in;
  bool judge = false;
  bool reduce = false;
  std::vector<std::string> paths;
};

template <class Number>
bool read_number(const char* text, Number& number) {
  const std::optional<Number> value = parse_number<Number>(text);
  if (value) number = *value;
  return value.has_value();
}

std::optional<Arguments> parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--judge") {
      arguments.judge = true;
    } else if (word == "--reduce") {
      arguments.reduce = true;
    } else if (word == "--mutate" && has_value) {
      if (!read_number(argv[++i], arguments.mutations)) return std::nullopt;
    } else if (word == "--seed" && has_value) {
      if (!read_number(argv[++i], arguments.seed)) return std::nullopt;
    } else if (word == "--keep" && has_value) {
      arguments.keep_in = argv[++i];
    } else if (word.rfind("--", 0) == 0) {
      return std::nullopt;
    } else {
      arguments.paths.push_back(word);
    }
  }
  const std::size_t wanted = arguments.judge ? 1 : arguments.reduce ? 2 : 0;
  if (arguments.judge && arguments.reduce) return std::nullopt;
  if (wanted > 0 && arguments.paths.size() != wanted) return std::nullopt;
  return arguments;
}

std::vector<fs::path> files_below(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return {path};
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator entry(path, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->is_regular_file(error)) files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string read_or_exit(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream || fs::is_directory(file)) {
    std::fprintf(stderr, "%s: cannot be read\n", file.c_str());
    std::exit(kBadUsage);
  }
  return bytes;
}

int replay(const Arguments& arguments) {
  std::vector<std::string> inputs;
  for (const std::string& path : arguments.paths) {
    for (const fs::path& file : files_below(path)) {
      const std::string input = read_or_exit(file);
      // Named first: after a crash the last line tells which input it was.
      std::printf("%s\n", file.c_str());
      std::fflush(stdout);
      const std::vector<std::uint8_t> bytes(input.begin(), input.end());
      LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
      inputs.push_back(input);
    }
  }
  std::printf("%zu inputs replayed\n", inputs.size());
  if (arguments.mutations > 0) {
    fuzz::run_mutations(inputs, arguments.mutations, arguments.seed, arguments.keep_in);
    std::printf("%zu mutations, seed %llu\n", arguments.mutations,
                static_cast<unsigned long long>(arguments.seed));
  }
  return inputs.empty() && arguments.mutations == 0 ? kNegative : 0;
}

int judge(const std::string& path) {
  const fuzz::Judgement judgement = fuzz::judge(read_or_exit(path));
  if (!judgement.broken) {
    std::printf("holds\n");
    return 0;
  }
  // One value a line, for programs that read it; below them what a person reads.
  std::printf("%s\n%s\n%s\n%s\n%s", judgement.kind.c_str(), judgement.claim.c_str(), judgement.frames.c_str(),
              judgement.message.c_str(), judgement.report.c_str());
  return kNegative;
}

/// Writes the text whole or not at all.
bool keep(const std::string& text, const fs::path& path) {
  const fs::path beside = path.string() + ".part";
  std::ofstream out(beside, std::ios::binary);
  out << text;
  std::error_code error;
  if (out.flush()) fs::rename(beside, path, error);
  return out && !error;
}

int reduce(const Arguments& arguments) {
  const std::string input = read_or_exit(arguments.paths[0]);
  const fuzz::Judgement first = fuzz::judge(input);
  if (!first.broken) {
    std::fprintf(stderr, "%s: breaks nothing, expected an input that does\n", arguments.paths[0].c_str());
    return kBadUsage;
  }
  // Kept as soon as it is found: whoever ends this program for its time has the smallest so far.
  bool is_kept = keep(input, arguments.paths[1]);
  const auto still_breaks = [&](const std::string& text) {
    if (!is_kept || fuzz::judge(text).signature() != first.signature()) return false;
    is_kept = keep(text, arguments.paths[1]);
    return true;
  };
  const Reduction reduction = reduce_text(input, still_breaks, kReductionTries);
  if (!is_kept) {
    std::fprintf(stderr, "%s: cannot be written\n", arguments.paths[1].c_str());
    return kBadUsage;
  }
  std::printf("%zu bytes of %zu, %zu steps, %zu tries\n", reduction.text.size(), input.size(),
              reduction.steps, reduction.tries);
  return 0;
}

/// Sanitizers read their options when a program begins. A reduction asks thousands of
/// times: names of functions, which take a second each, are left out then.
void begin_again_with_sanitizer_options(char** argv, bool symbols) {
  constexpr const char* kAgain = "SIPPLAB_FUZZ_BEGAN_AGAIN";
  if (getenv(kAgain) != nullptr) return;
  setenv(kAgain, "1", 1);
  const std::string options =
      std::string("handle_abort=0:detect_leaks=1:malloc_context_size=20:symbolize=") + (symbols ? "1" : "0");
  setenv("ASAN_OPTIONS", options.c_str(), 1);
  setenv("UBSAN_OPTIONS", "print_stacktrace=1", 1);
  execv("/proc/self/exe", argv);
}

}  // namespace

int main(int argc, char** argv) {
  const std::optional<Arguments> arguments = parse(argc, argv);
  if (!arguments) {
    std::fprintf(stderr, kUsage, argv[0], argv[0], argv[0], argv[0]);
    return kBadUsage;
  }
  if (!arguments->judge && !arguments->reduce) return replay(*arguments);
  begin_again_with_sanitizer_options(argv, arguments->judge);
  return arguments->judge ? judge(arguments->paths[0]) : reduce(*arguments);
}
