// Names that are made where a run begins: its UUID, the time, the process.
#pragma once

#include <string>
#include <string_view>

namespace sipplab::db {

/// A random UUID (version 4), 36 characters in lower case.
std::string new_uuid();

/// "2026-01-31T12:00:00.123Z": sorts as text in order of time.
std::string utc_now();

/// Names this process so that no other has the same name, even after a restart of the
/// machine: "BOOT-ID PID START-TIME". Just "PID" if the system does not tell.
std::string this_process();

/// Whether the process of that name is still there. False if that cannot be told.
bool is_alive(std::string_view process);

}  // namespace sipplab::db
