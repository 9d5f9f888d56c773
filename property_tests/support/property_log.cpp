// The log of property runs; see property_log.hpp.
#include "property_tests/support/property_log.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

namespace sipplab {

namespace {

using Json = nlohmann::ordered_json;

template <class T>
void put(Json& json, const char* name, const T& value) {
  json[name] = value;
}
void put(Json& json, const char* name, const db::MaybeEmpty<const std::string>& value) {
  json[name] = value.text;
}
void put(Json& json, const char* name, const std::optional<std::int64_t>& value) {
  if (value) json[name] = *value;
}

}  // namespace

std::string to_json_line(const db::PropertyRun& run) {
  Json json;
  const auto visit = [&json](const char* name, const auto& value) { put(json, name, value); };
  db::PropertyRun::origin_columns(run, visit);
  db::PropertyRun::columns(run, visit);
  json["classes"] = run.classes;
  // What a property prints may be any bytes.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<std::string> append_to_log(const std::string& path, const db::PropertyRun& run) {
  return append_to_log(path, to_json_line(run));
}

std::optional<std::string> append_to_log(const std::string& path, const std::string& line) {
  const auto failed = [&path] { return path + ": cannot append to the log: " + std::strerror(errno); };
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file < 0) return failed();
  // One write: lines of programs that run at once do not mix.
  errno = ENOSPC;  // what a short write means
  const bool written = ::write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  std::optional<std::string> error;
  if (!written) error = failed();
  ::close(file);
  return error;
}

}  // namespace sipplab
