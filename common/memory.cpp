// SPDX-License-Identifier: Apache-2.0
#include "tetwright/resources.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

/// Reads a limit from a file of a control group; no limit for "max", or if the file cannot be read.
double limit_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string text;
  if (!(in >> text)) return no_limit;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == 0 && value > 0 ? value : no_limit;
}

/// Minimum of the limits in the files called `name` in the folder of `group` under `mount` and in all its
/// ancestors. In a container `group` may be the name on the host; only the mount itself then has the file.
double smallest_limit(const std::filesystem::path& mount, std::filesystem::path group, const char* name) {
  double smallest = limit_in(mount / name);
  for (group = group.relative_path(); !group.empty(); group = group.parent_path())
    smallest = std::min(smallest, limit_in(mount / group / name));
  return smallest;
}

/// Whether the comma-separated list contains the controller.
bool lists_controller(const std::string& list, const std::string& controller) {
  return ("," + list + ",").find("," + controller + ",") != std::string::npos;
}

/// Limit of the process's control groups. Each line of /proc/self/cgroup reads "number:controllers:path";
/// version 2 has the number 0 and no controllers.
double control_group_limit(const std::filesystem::path& root) {
  const std::filesystem::path mount = root / "sys/fs/cgroup";
  std::ifstream in(root / "proc/self/cgroup");
  double smallest = no_limit;
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::filesystem::path group = line.substr(second + 1);
    if (controllers.empty())
      smallest = std::min(smallest, smallest_limit(mount, group, "memory.max"));
    else if (lists_controller(controllers, "memory"))
      smallest = std::min(smallest, smallest_limit(mount / "memory", group, "memory.limit_in_bytes"));
  }
  return smallest;
}

double process_limit(int resource) {
  rlimit limit;
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return no_limit;
  return static_cast<double>(limit.rlim_cur);
}

thread_local double thread_memory_limit = no_limit, thread_held_memory = 0;

}  // namespace

double available_memory(const std::filesystem::path& root) {
  const double machine =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const double all = std::min({machine, control_group_limit(root), process_limit(RLIMIT_AS),
                               process_limit(RLIMIT_DATA), thread_memory_limit});
  return std::max(0.0, all - thread_held_memory);
}

void HeldMemory::add(double bytes) {
  bytes_ += bytes;
  thread_held_memory += bytes;
}

MemoryLimit::MemoryLimit(double bytes) : before_(thread_memory_limit) {
  if (bytes > 0) thread_memory_limit = std::min(before_, bytes);
}

MemoryLimit::~MemoryLimit() { thread_memory_limit = before_; }

void require_memory(double bytes, const std::string& what, const std::string& remedy) {
  constexpr double gigabyte = 1 << 30;
  const double available = available_memory();
  if (bytes <= available) return;
  throw OutputError(what + " would take about " + short_number(bytes / gigabyte) + " GB of memory, but " +
                    short_number(available / gigabyte) + " GB are available" +
                    (thread_held_memory > 0 ? " beside the " + short_number(thread_held_memory / gigabyte) +
                                                  " GB that images and masks take"
                                            : "") +
                    "; " + remedy);
}

}  // namespace tetwright
