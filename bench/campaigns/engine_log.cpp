#include "bench/campaigns/engine_log.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

namespace sipplab::bench {
namespace {

constexpr std::int64_t kBytesPerMb = std::int64_t{1} << 20;
constexpr double kNsPerS = 1e9;

/// The number right after `key`, blanks between aside.
std::optional<std::int64_t> number_after(std::string_view line, std::string_view key) {
  const std::size_t at = line.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  std::string_view rest = line.substr(at + key.size());
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error != std::errc()) return std::nullopt;
  return number;
}

/// "236/8671b", "236/86Kb", "236/8Mb": bytes.
std::int64_t corpus_bytes(std::string_view line) {
  const std::size_t corpus = line.find("corp: ");
  const std::size_t slash = line.find('/', corpus);
  if (corpus == std::string_view::npos || slash == std::string_view::npos) return 0;
  const std::string_view rest = line.substr(slash);
  const std::int64_t amount = number_after(rest, "/").value_or(0);
  const std::size_t unit = rest.find_first_not_of("/0123456789");
  if (unit == std::string_view::npos) return amount;
  return rest[unit] == 'K' ? amount << 10 : rest[unit] == 'M' ? amount << 20 : amount;
}

class LogReader {
 public:
  void read(std::string_view line) {
    if (const auto slowest = number_after(line, "slowest_unit_time_sec:")) log_.slowest_input_s = *slowest;
    if (const auto memory = number_after(line, "peak_rss_mb:")) {
      log_.peak_memory_bytes = std::max(log_.peak_memory_bytes, *memory * kBytesPerMb);
    }
    if (line.substr(0, 1) == "#") read_status(line);
  }

  EngineLog take() {
    if (!log_.snapshots.empty() && log_.snapshots.back().executions < log_.last.executions) {
      log_.snapshots.push_back(log_.last);
    }
    return std::move(log_);
  }

 private:
  void read_status(std::string_view line) {
    const auto executions = number_after(line, "#");
    const auto edges = number_after(line, "cov: ");
    const auto features = number_after(line, "ft: ");
    if (!executions || !edges || !features) return;
    db::FuzzSnapshot now;
    now.executions = *executions;
    now.edges = *edges;
    now.features = *features;
    now.corpus_files = number_after(line, "corp: ").value_or(0);
    now.memory_bytes = number_after(line, "rss: ").value_or(0) * kBytesPerMb;
    now.elapsed_ns = elapsed_ns(line, now.executions);
    log_.corpus_bytes = std::max(log_.corpus_bytes, corpus_bytes(line));
    log_.peak_memory_bytes = std::max(log_.peak_memory_bytes, now.memory_bytes);
    log_.last = now;
    const std::int64_t before = log_.snapshots.empty() ? 0 : log_.snapshots.back().executions;
    if (log_.snapshots.empty() || now.executions > before + before / 4) log_.snapshots.push_back(now);
  }

  /// Said in fork mode; elsewhere it follows from executions and their rate, once there is one.
  static std::int64_t elapsed_ns(std::string_view line, std::int64_t executions) {
    if (const auto seconds = number_after(line, " time: ")) {
      return static_cast<std::int64_t>(static_cast<double>(*seconds) * kNsPerS);
    }
    const std::int64_t rate = number_after(line, "exec/s: ").value_or(0);
    if (rate == 0) return 0;
    return static_cast<std::int64_t>(static_cast<double>(executions) / static_cast<double>(rate) * kNsPerS);
  }

  EngineLog log_;
};

}  // namespace

EngineLog parse_engine_log(std::string_view text) {
  LogReader reader;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    reader.read(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return reader.take();
}

}  // namespace sipplab::bench
