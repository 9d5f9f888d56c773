#include "fuzz/replay/mutation_loop.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>

#include "fuzz/support/target.hpp"
#include "planner/core/random.hpp"

/// Of the sanitizers, if they are linked: called before they end the process.
extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));

namespace sipplab::fuzz {
namespace {

/// Inputs that are mutated further; beyond that, one of them makes room.
constexpr std::size_t kPool = 256;

/// The input on trial, for the report of what broke.
std::string on_trial;
std::string kept_in;
Random mutations(0);

void tell_input() {
  constexpr char kSays[] = "\nthe input:\n";
  const auto put = [](int file, const char* bytes, std::size_t size) {
    while (size > 0) {
      const ssize_t written = write(file, bytes, size);
      if (written <= 0) return;
      bytes += written;
      size -= static_cast<std::size_t>(written);
    }
  };
  put(STDERR_FILENO, kSays, sizeof kSays - 1);
  put(STDERR_FILENO, on_trial.data(), on_trial.size());
  if (kept_in.empty()) return;
  const int file = open(kept_in.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return;
  put(file, on_trial.data(), on_trial.size());
  close(file);
}

void tell_input_and_die(int signal) {
  tell_input();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::string mutated(const std::string& input, const std::string& other, Random& random) {
  std::string bytes = input;
  bytes.resize(kMaxInputBytes);
  auto* data = reinterpret_cast<std::uint8_t*>(bytes.data());
  const auto seed = static_cast<unsigned>(random.next());
  std::size_t size = 0;
  if (LLVMFuzzerCustomCrossOver != nullptr && random.below(8) == 0) {
    size = LLVMFuzzerCustomCrossOver(reinterpret_cast<const std::uint8_t*>(input.data()), input.size(),
                                     reinterpret_cast<const std::uint8_t*>(other.data()), other.size(), data,
                                     kMaxInputBytes, seed);
  } else if (LLVMFuzzerCustomMutator != nullptr) {
    size = LLVMFuzzerCustomMutator(data, input.size(), kMaxInputBytes, seed);
  } else {
    size = LLVMFuzzerMutate(data, input.size(), kMaxInputBytes);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace

void run_mutations(const std::vector<std::string>& seeds, std::size_t count, std::uint64_t seed,
                   const std::string& keep_in) {
  kept_in = keep_in;
  if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(tell_input);
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL}) std::signal(signal, tell_input_and_die);
  Random random(seed);
  mutations = Random(seed + 1);
  std::vector<std::string> pool = seeds;
  if (pool.empty()) pool.emplace_back();
  for (std::size_t i = 0; i < count; ++i) {
    const auto pick = [&]() -> const std::string& { return pool[random.below(pool.size())]; };
    const std::string& first = pick();
    on_trial = mutated(first.substr(0, kMaxInputBytes), pick(), random);
    // On the heap and without slack, so that a read beyond its end is seen.
    const std::vector<std::uint8_t> bytes(on_trial.begin(), on_trial.end());
    if (LLVMFuzzerTestOneInput(bytes.data(), bytes.size()) != 0) continue;
    if (pool.size() < kPool) {
      pool.push_back(on_trial);
    } else {
      pool[random.below(pool.size())] = on_trial;
    }
  }
}

}  // namespace sipplab::fuzz

/// Here in libFuzzer's place: one to four small changes, some with words of other formats.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size) {
  using sipplab::fuzz::mutations;
  static constexpr const char* kWords[] = {"<root>", "</root>", "map",  "-1",  "99999999999", "nan", "1e999",
                                           "\n",     "\"",      "&lt;", "0.5", "height 8192", "{\"", "]]"};
  std::string text(reinterpret_cast<const char*>(data), size);
  for (std::uint64_t changes = 1 + mutations.below(4); changes > 0; --changes) {
    const std::size_t at = mutations.below(text.size() + 1);
    const std::size_t length = std::min<std::size_t>(mutations.below(16) + 1, text.size() - at);
    switch (mutations.below(6)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, text.substr(at, length));
        break;
      case 2:
        text.insert(at, kWords[mutations.below(std::size(kWords))]);
        break;
      case 3:
        text.insert(mutations.below(text.size() + 1), text.substr(at, length));
        break;
      case 4:
        if (at < text.size()) text[at] = static_cast<char>(mutations.below(256));
        break;
      default:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << mutations.below(8)));
        break;
    }
  }
  text.resize(std::min(text.size(), max_size));
  std::memcpy(data, text.data(), text.size());
  return text.size();
}
