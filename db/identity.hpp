// Names that are made where a run begins: its UUID, the time, the process.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "db/run_names.hpp"

namespace sipplab::db {

/// Names this process so that no other has the same name, even after a restart of the
/// machine: "BOOT-ID PID START-TIME". Just "PID" if the system does not tell.
std::string this_process();

/// Whether the process of that name is still there. False if that cannot be told.
bool is_alive(std::string_view process);

/// Processes that ran or waited to run, over the last minute; none if the system does not tell.
std::optional<double> machine_load();

}  // namespace sipplab::db
