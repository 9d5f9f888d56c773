// The name and the time that a run begins with. Headers of the standard library alone, so that programs
// without a database can include it.
#pragma once

#include <chrono>
#include <cstdio>
#include <ctime>
#include <random>
#include <string>

namespace sipplab::db {

/// A random UUID (version 4), 36 characters in lower case.
inline std::string new_uuid() {
  std::random_device random;
  std::string uuid = "xxxxxxxx-xxxx-4xxx-yxxx-xxxxxxxxxxxx";
  for (char& c : uuid) {
    if (c == 'x') c = "0123456789abcdef"[random() % 16];
    if (c == 'y') c = "89ab"[random() % 4];  // the variant of RFC 4122
  }
  return uuid;
}

/// "2026-01-31T12:00:00.123Z": sorts as text in order of time.
inline std::string utc_now() {
  const auto now = std::chrono::system_clock::now();
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  const auto ms =
      std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
  std::tm utc = {};
  gmtime_r(&seconds, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
  char fraction[16];
  std::snprintf(fraction, sizeof fraction, ".%03dZ", static_cast<int>(ms));
  return std::string(text) + fraction;
}

}  // namespace sipplab::db
